"""Pages as a browser gets them, without a browser."""

import re
from collections import namedtuple
from collections.abc import Callable
from datetime import timedelta
from pathlib import Path
from typing import Any

import pytest
from markupsafe import escape
from starlette.testclient import TestClient

from live_streams import sinking
from rga.dashboard.app import app_of
from rga.model import read_model
from rga.operation.configuration import read_configuration
from rga.operation.disk import room as disk_room
from rga.operation.service import Service
from rga.records import Record
from rga.twin.repository.database import FILE_NAME
from served.bridges import HOSTILE, configured, lived, long_bridge, packets_of, played

from .conftest import HERE, START, page

TABS = ("", "/sensors", "/alarms", "/causes", "/versions", "/queries", "/data")
FORM = {"Origin": HERE}


def form_of(html: str, kind: str) -> dict[str, str]:
    """The hidden fields of the form of a kind."""
    forms = [one for one in html.split("<form")[1:] if f'name="kind" value="{kind}"' in one]
    return dict(re.findall(r'type="hidden" name="(\w+)" value="([^"]*)"', forms[0]))


def test_every_page_of_every_twin_opens(client: TestClient) -> None:
    fleet = page(client, "/")
    # The one with an alarm comes before the one that has not begun.
    assert fleet.index("</span> alarm") < fleet.index("no rows yet")
    for twin in ("east", "west"):
        for tab in TABS:
            html = page(client, f"/twins/{twin}{tab}")
            assert "<script>" not in html
            assert "onclick" not in html
    page(client, "/twins/south", 404)
    page(client, "/twins/east/sensors?name=D9", 404)


def test_pages_may_load_from_their_server_alone(client: TestClient) -> None:
    policy = client.get("/").headers["content-security-policy"]
    assert "default-src 'self'" in policy
    assert "script-src" not in policy
    for path in re.findall(r'(?:src|href)="(/static/[^"]+)"', page(client, "/")):
        assert client.get(path).status_code == 200


def test_the_bridge_says_where_it_is_off(client: TestClient) -> None:
    html = page(client, "/twins/east")
    assert re.search(r'id="sensor-2"[^>]*gap4[^>]*><title>D3, displacement at node L3', html)
    assert re.search(r'id="sensor-6"[^>]*gap0[^>]*><title>S U1-U2', html)
    assert 'class="foot marked"' in html


def test_the_bridge_as_it_stood(client: TestClient) -> None:
    """Before the bearing sank all was as noise, and no alarm had come."""
    before = page(client, f"/twins/east?at={600 * 70}")
    assert "As of" in before
    assert "gap4" not in before.split('class="scale"')[0]
    assert 'class="mark alarm"' not in before
    assert 'class="mark alarm"' in page(client, "/twins/east")
    # A mark leads to the bridge as it stood then, with its alarm.
    (mark, *_) = re.findall(r'class="mark alarm"[^>]*href="([^"]+)"', page(client, "/twins/east"))
    assert 'class="mark alarm"' in page(client, mark)
    for odd in ("-5", "1e300", "0"):
        page(client, f"/twins/east?at={odd}")


def test_accepting_makes_a_version_and_the_gap_falls(
    service: Service, client: TestClient, lived_through: tuple[Path, Record]
) -> None:
    html = page(client, "/twins/east/causes")
    assert "What the model leaves out" in html
    fields = form_of(html, "accept") | {"why": "surveyed <b>on site</b>"}
    for _ in range(2):  # a form that is sent twice is carried out once
        answer = client.post(
            "/twins/east/commands", data=fields, headers=FORM, follow_redirects=False
        )
        assert (answer.status_code, answer.headers["location"]) == (303, "/twins/east/causes")
    assert "Asked, and not carried out yet" in page(client, "/twins/east/causes")
    _, record = lived_through
    tail = sinking(service.twins["east"].model, _measured(record), 160).rows(slice(120, 160))
    lived(service.twins["east"], packets_of(tail, START + timedelta(0), stream=None))
    html = page(client, "/twins/east/causes")
    assert "Accepted by" in html
    assert "surveyed &lt;b&gt;on site&lt;/b&gt;" in html
    versions = page(client, "/twins/east/versions")
    assert 'Version 2 <span class="badge good">' in versions
    second, first = versions.split("<h3>Version ")[1:]
    assert "as noise" in second
    assert "as noise" not in first
    assert len(client.get("/api/v1/twins/east/versions").json()) == 2
    # And back again.
    fields = form_of(versions, "rollback") | {"why": "a second look"}
    client.post("/twins/east/commands", data=fields, headers=FORM)
    played(service.twins["east"])
    assert 'Version 1 <span class="badge good">' in page(client, "/twins/east/versions")


def _measured(record: Record) -> Callable[..., Record]:
    from conftest import measured_record

    return measured_record._get_wrapped_function()()  # type: ignore[no-any-return]


def test_a_sensor_is_taken_out_of_use(service: Service, client: TestClient) -> None:
    html = page(client, "/twins/east/sensors?name=D1")
    fields = form_of(html, "exclude") | {"since": "2026-11-23T18:00", "why": "cable cut"}
    assert client.post("/twins/east/commands", data=fields, headers=FORM).status_code == 200
    played(service.twins["east"])
    assert "out of use from 2026-11-23 18:00 UTC on" in page(client, "/twins/east/sensors?name=D1")
    assert "out of use" not in page(client, "/twins/east/sensors?name=D2").split("h-exclude")[0]


@pytest.mark.parametrize(
    "fields",
    [
        {"kind": "drop"},
        {"kind": "rollback", "version": "one", "version_seen": "1"},
        {"kind": "exclude", "sensor": "D1", "since": "soon"},
        {"kind": "rollback", "version": "1", "version_seen": "1", "key": ""},
        {"kind": "rollback", "version": "9", "version_seen": "1"},
        {"kind": "exclude", "sensor": "D77"},
        {"kind": "exclude", "sensor": "D1", "why": "a\0b"},
    ],
)
def test_what_a_form_cannot_ask_for_is_told(client: TestClient, fields: dict[str, str]) -> None:
    sent = {"key": "k", "why": "w", "back": "https://elsewhere/"} | fields
    answer = client.post("/twins/east/commands", data=sent, headers=FORM)
    assert answer.status_code == 409
    assert "This was not done" in answer.text
    assert 'href="/twins/east"' in answer.text


def test_a_form_of_another_page_is_refused(client: TestClient) -> None:
    fields = form_of(page(client, "/twins/east/causes"), "reject")
    answer = client.post(
        "/twins/east/commands", data=fields, headers={"Origin": "https://elsewhere"}
    )
    assert answer.status_code == 403


def test_the_log_is_filtered(client: TestClient) -> None:
    every, updates = (page(client, f"/twins/east/queries{query}") for query in ("", "?kind=Q1"))
    assert "Q5 R5" in every
    assert "proposal" in every
    assert '<b class="kinds">Q5 R5' not in updates
    assert "calibration on 11 channels" in updates
    early = page(client, "/twins/east/queries?until=2026-11-23T08:00")
    assert '<b class="kinds">proposal' not in early
    assert "calibrated on 40 rows" in early


def test_data_tells_of_gaps_refusals_and_of_loss_that_cannot_be_told(
    service: Service, client: TestClient, lived_through: tuple[Path, Record]
) -> None:
    twin = service.twins["west"]
    record = lived_through[1].rows(slice(0, 20))
    twin.receive("http", [("http", one) for one in packets_of(record, START, stream=None)])
    assert "Loss cannot be told" in page(client, "/twins/west/data")
    assert "Loss cannot be told" not in page(client, "/twins/east/data")
    more = packets_of(record, START + timedelta(days=1), "s", left_out=(3, 4, 9))
    twin.receive("http", [("http", one) for one in more])
    hostile = b'{"v":1,"stream":"<script>alert(1)</script>"}\x00\xff'
    twin.receive("http", [("http", hostile)])
    html = page(client, "/twins/west/data")
    assert "3 missing</b>: 3 to 4, 9" in html
    assert "&lt;script&gt;alert(1)&lt;/script&gt;" in html
    assert "<script>alert" not in html


def test_data_tells_what_a_year_takes_and_that_there_is_no_room_for_it(
    service: Service, client: TestClient, monkeypatch: pytest.MonkeyPatch
) -> None:
    twin = service.twins["east"]
    sizes = [len(one.payload) for one in twin.packets.between(0, 2**62, 2**40)[0]]
    # A packet every ten minutes, and 52 596 in a year; 616 bytes a row, and 400 of its step.
    packets, rows = sum(sizes[1:]) / (len(sizes) - 1) * 52_596, 53_437_536
    free = 2 * 53_437_536 + round(packets)
    usage = namedtuple("usage", "total used free")
    for lacking, told in ((-2, False), (2, True)):
        found = usage(10 * free, 9 * free, free - lacking)
        monkeypatch.setattr(disk_room.shutil, "disk_usage", lambda _, found=found: found)
        answer = client.get("/api/v1/twins/east/disk").json()
        assert answer["year"]["rows"] == rows
        assert answer["year"]["packets"] == pytest.approx(packets, rel=1e-9)
        # The other twin has no packets yet.
        assert answer["year_of_all"] == pytest.approx(2 * rows + packets, rel=1e-9)
        assert answer["free_share"] == pytest.approx(0.1, rel=1e-6)
        html = page(client, "/twins/east/data")
        assert f'53.4 MB <span class="soft">for rows</span> + {packets / 1e6:.3g} MB' in html
        assert ("There is no room for a year" in html) == told
        assert ("lasts for 365 days" in html) == told
        assert "packets beside them" in page(client, "/twins/west/data")


def test_a_damaged_repository_is_told_and_the_rest_goes_on(
    folder: Path, service: Service, client: TestClient
) -> None:
    place = folder / "data" / "east" / FILE_NAME
    place.write_bytes(b"no database" * 1000)
    for other in place.parent.glob(f"{FILE_NAME}-*"):
        other.unlink()
    fleet = page(client, "/")
    assert "damaged" in fleet
    assert "no rows yet" in fleet
    assert "This page cannot be drawn" in page(client, "/twins/east", 503)
    assert "packets" in page(client, "/twins/east/data")
    page(client, "/twins/west")


def test_names_are_shown_and_never_followed(
    tmp_path: Path, measured_record: Callable[..., Record]
) -> None:
    bridge = long_bridge(5, '<i>Bridge</i> & "Sons" 橋')
    service = Service(read_configuration(configured(tmp_path, {"odd": bridge})))
    record = measured_record(read_model(bridge, "odd"), rows=52)
    lived(service.twins["odd"], packets_of(record, START))
    with TestClient(app_of(service), base_url=HERE) as client:
        for path in ("/", *(f"/twins/odd{tab}" for tab in TABS)):
            html = page(client, path)
            assert "<i>Bridge" not in html
            assert "&lt;i&gt;Bridge" in html
        sensors = page(client, "/twins/odd/sensors")
        assert "No cause has been proposed" in page(client, "/twins/odd/causes")
        for name in HOSTILE:
            assert (
                str(escape(name)).replace("&quot;", "&#34;").replace("&#x27;", "&#39;") in sensors
            )
            answer = client.get("/twins/odd/sensors", params={"name": name})
            assert answer.status_code == 200
    service.stop()


def test_a_viewer_sees_no_forms_and_cannot_operate(
    service: Service, monkeypatch: pytest.MonkeyPatch
) -> None:
    from argon2 import PasswordHasher

    from rga.dashboard.access import passwords

    quick = PasswordHasher(time_cost=1, memory_cost=8, parallelism=1)
    monkeypatch.setattr(passwords, "_HASHER", quick)
    app = app_of(service)
    for role in ("viewer", "operator"):
        app.state.access.users.add(role, role, "four words of mine")
    shown: dict[str, Any] = {}
    for role in ("operator", "viewer"):
        with TestClient(app, base_url=HERE) as client:
            assert client.get("/", headers={"accept": "text/html"}).url.path == "/login"
            login = {"name": role, "password": "four words of mine", "next": "/"}
            assert client.post("/login", data=login, headers=FORM).url.path == "/"
            shown[role] = page(client, "/twins/east/causes")
            fields = form_of(shown["operator"], "reject") | {"why": "no"}
            answer = client.post("/twins/east/commands", data=fields, headers=FORM)
            assert answer.status_code == (200 if role == "operator" else 403)
    assert "commands" in shown["operator"]
    assert "commands" not in shown["viewer"]
