"""The report of a stretch of time, made by a process of its own."""

import time

from starlette.testclient import TestClient

REPORT = "/api/v1/twins/east/report"
#: how long it is waited for [s]
PATIENCE = 300.0


def test_a_report_is_made_once_and_kept(client: TestClient) -> None:
    answer = client.get(REPORT)
    assert answer.status_code == 202
    location = answer.json()["location"]
    assert answer.headers["Location"] == location
    end = time.monotonic() + PATIENCE
    while (answer := client.get(location)).status_code == 202:
        assert answer.json()["location"] == location
        assert time.monotonic() < end
        time.sleep(0.2)
    assert answer.status_code == 200, answer.text
    assert answer.headers["content-type"].startswith("text/html")
    # What it holds reaches nothing of the service.
    assert answer.headers["Content-Security-Policy"].startswith("sandbox")
    assert "support" in answer.text
    assert client.get(location).content == answer.content


def test_a_stretch_without_enough_rows_is_told(client: TestClient) -> None:
    short = {"from": "2026-11-23T01:00:00Z", "to": "2026-11-23T01:20:00Z"}
    end = time.monotonic() + PATIENCE
    while (answer := client.get(REPORT, params=short)).status_code == 202:
        assert time.monotonic() < end
        time.sleep(0.2)
    assert answer.status_code == 422
    assert "rows" in answer.json()["detail"]
    none = {"from": "2001-01-01T00:00:00Z", "to": "2001-01-02T00:00:00Z"}
    assert client.get(REPORT, params=none).status_code == 422
