"""What pages say agrees with itself: counts, orders, names, then and now."""

import re

import pytest
from starlette.testclient import TestClient

from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.service import Service

from .conftest import START, page


def test_twins_of_one_model_are_told_apart(client: TestClient) -> None:
    cards = page(client, "/").split("<article")[1:]
    assert [re.findall(r'<p class="name">(\w+)</p>', one) for one in cards] == [["east"], ["west"]]
    for twin in ("east", "west"):
        heading = page(client, f"/twins/{twin}").split("<h1>")[1].split("</h1>")[0]
        assert heading.startswith(f'small bridge <span class="name">{twin}</span>')


def test_the_fleet_counts_as_open_what_the_page_of_alarms_does(
    service: Service, client: TestClient
) -> None:
    def told() -> tuple[str, str, int]:
        fleet = page(client, "/")
        heading = fleet.split("<h1>Fleet</h1>")[1].split("</p>")[0]
        (card,) = [one for one in fleet.split("<article")[1:] if 'name">west<' in one]
        counted = card.split("<dt>open alarms</dt>")[1].split("</div>")[0]
        said = [re.sub(r"<[^>]+>", "", one).strip() for one in (heading, counted)]
        shown = page(client, "/twins/west/alarms").split("<details>")[0]
        return said[0], said[1], shown.count('<article class="panel alarm ')

    there = Condition(ConditionKey("west", "gap", "alarm", "twin"), "out of step", START)
    judged = frozenset({"gap"})
    assert told() == ("2 bridges; 1 needs somebody to look; no open alarms.", "0", 0)
    service.alarms.observe("west", Observation((there,), judged))
    service.alarms.observe("west", Observation((), judged))
    # Well again, it is open as long as nobody has seen it.
    assert told() == (
        "2 bridges; 2 need somebody to look; 1 open alarm.",
        "1 (1 to acknowledge)",
        1,
    )
    service.alarms.observe("west", Observation((there,), judged))
    (alarm,) = service.alarms.open()
    service.alarms.acknowledge(alarm.id, "Ada")
    told_then = ("2 bridges; 1 needs somebody to look; 1 open alarm.", "1 (none to acknowledge)", 1)
    assert told() == told_then
    service.alarms.observe("west", Observation((), judged))
    assert told() == ("2 bridges; 1 needs somebody to look; no open alarms.", "0", 0)


@pytest.mark.parametrize("tab", ["", "/sensors"])
def test_sensors_stand_by_the_number_that_is_shown(client: TestClient, tab: str) -> None:
    html = page(client, f"/twins/east{tab}")
    shown = re.findall(r'id="row-\d+".*?<td><span class="level.*?<b>([^<]+)</b>', html)
    gaps = [float(re.sub(r"\s", "", one)) for one in shown]
    assert len(gaps) == 11
    assert gaps == sorted(gaps, reverse=True)
    # By their classes and the order of the model it would be another one.
    assert len(set(gaps)) > 5


def test_contexts_that_are_inferred_have_an_interval(client: TestClient) -> None:
    html = page(client, "/twins/east").split('id="contexts"')[1]
    told = re.findall(r'<th scope="row">[^<]+</th><td class="n">([^<]+)</td>', html)
    assert len(told) == 3
    # The thermometer has noise, so that its temperature is inferred as well.
    assert all("[" in words and "measured" not in words for words in told)


def test_the_past_is_told_from_the_present_and_keeps_its_span(client: TestClient) -> None:
    now = page(client, "/twins/east?span=day")
    assert "This page shows" not in now
    before = page(client, f"/twins/east?at={600 * 70}&span=day")
    heading = before.split("<h1>")[1].split("</h1>")[0]
    assert "in step" in heading
    said = before.split("This page shows")[1].split("</p>")[0]
    assert "2026-11-23 11:40 UTC" in said
    assert "</span> alarm</span>" in said
    for html in (now, before):
        assert '<input type="hidden" name="span" value="day">' in html
        assert re.search(r'span=day" aria-current', html)
    assert 'href="/twins/east?span=day">Back to now' in before
    # Marks and what happened lead to the past over the same span.
    hrefs = re.findall(r'href="(/twins/east[^"]*at=[^"]+)"', now)
    assert hrefs
    assert all("span=day" in one for one in hrefs)


@pytest.mark.parametrize(
    ("path", "words"),
    [
        ("?span=century", "span: there is no &#39;century&#39;: known are day, week"),
        ("?at=soon", "at: &#39;soon&#39; is no time"),
        ("?at=nan", "at: there is no such time"),
        ("?at=inf", "at: there is no such time"),
        ("/queries?kind=zz", "kind: there is no &#39;zz&#39;: known are Q1, Q2"),
        ("/queries?until=soon", "until: &#39;soon&#39; is no time"),
        ("/sensors?name=D1&from=2026-13-01", "from: &#39;2026-13-01&#39; is no time"),
        ("/sensors?name=D1&from=2026-11-24T00:00&to=2026-11-23T00:00", "to: it is not after from"),
    ],
)
def test_what_an_address_cannot_ask_for_is_told_of_as_a_page(
    client: TestClient, path: str, words: str
) -> None:
    html = page(client, f"/twins/east{path}", 422)
    assert "<h1>This cannot be shown</h1>" in html
    assert words in html


@pytest.mark.parametrize(
    "path",
    [
        "?at=&span=month",
        "?at=2026-11-24T00:00",
        "/queries?kind=&until=",
        "/queries?kind=Q5&until=2026-11-24T00:00",
        "/sensors?name=D1&from=&to=",
        "/sensors?name=D1&from=2026-11-23T00:00&to=2026-11-24T00:00",
    ],
)
def test_what_an_address_can_ask_for_is_shown(client: TestClient, path: str) -> None:
    page(client, f"/twins/east{path}")


def test_a_page_that_there_is_not_is_told_of_as_a_page(
    client: TestClient,
) -> None:
    for path in ("/nowhere", "/twins/south", "/twins/east/nowhere", "/twins/east/sensors?name=D9"):
        html = page(client, path, 404)
        assert "<h1>There is no such page</h1>" in html
    assert "This cannot be shown" in page(client, "/twins/No%20Name!", 422)
    # Programs are told in JSON.
    for path, accept in (("/nowhere", "*/*"), ("/api/v1/twins/south", "text/html")):
        answer = client.get(path, headers={"accept": accept})
        assert (answer.status_code, list(answer.json())) == (404, ["detail"])
