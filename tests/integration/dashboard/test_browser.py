"""Pages in a browser: nothing fails, nothing leaves the host, and clicks do what they say."""

import shutil
import threading
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from datetime import UTC, datetime, timedelta
from typing import Any

import pytest
import uvicorn

from rga.dashboard.app import app_of
from rga.dashboard.pages.times import age_words
from rga.operation.alarms.condition import Condition, ConditionKey, Observation
from rga.operation.service import Service
from rga.records import Record
from rga_bench.operation.service_process import free_port
from served.bridges import lived, packets_of, played

from .conftest import START

CHROMIUM = shutil.which("chromium")
playwright = pytest.importorskip("playwright.sync_api")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium here")

PATHS = (
    "/",
    "/twins/west",
    *(
        f"/twins/east{tab}"
        for tab in (
            "", "/sensors", "/sensors?name=D1", "/alarms", "/causes", "/versions", "/queries",
            "/data", "?at=40000",
        )
    ),
)  # fmt: skip
#: bytes of a page with all that it loads
MOST_BYTES = 400_000
#: of a phone
PHONE = {"width": 390, "height": 844}
Page = Any
#: which sensor lies at a place, and of which it is the ground for a finger
ELEMENT_AT = "([x, y]) => document.elementFromPoint(x, y).closest('a').id"
REACH_AT = "([x, y]) => document.elementFromPoint(x, y).closest('a.reach')?.dataset.of"


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield found
        found.close()


@pytest.fixture
def address(service: Service) -> Iterator[str]:
    """Of the pages of the service."""
    ending, port = threading.Event(), free_port()
    config = uvicorn.Config(app_of(service, ending.is_set), port=port, log_level="error")
    server = uvicorn.Server(config)
    thread = threading.Thread(target=server.run, daemon=True)
    thread.start()
    while not server.started:
        time.sleep(0.01)
    yield f"http://127.0.0.1:{port}"
    ending.set()
    server.should_exit = True
    thread.join()


@pytest.fixture
def opened(browser: Any, address: str) -> Iterator[Callable[..., Page]]:
    """Opens pages in a browser of its own, which must not fail, or ask another host."""
    faults: list[str] = []
    contexts = []

    def open_in(**options: Any) -> Page:
        context = browser.new_context(base_url=address, **options)
        contexts.append(context)
        page = context.new_page()
        page.on("console", lambda one: faults.append(one.text) if one.type == "error" else None)
        page.on("pageerror", lambda one: faults.append(str(one)))
        page.on(
            "request",
            lambda one: None if one.url.startswith(f"{address}/") else faults.append(one.url),
        )
        return page

    yield open_in
    for context in contexts:
        context.close()
    assert faults == []


@pytest.mark.parametrize(("minutes", "words"), [(22.5, "in 22 min"), (-22.5, "22 min ago")])
def test_an_age_is_the_same_once_the_page_runs(
    opened: Callable[..., Page], minutes: float, words: str
) -> None:
    page = opened()
    page.goto("/twins/east")
    now = datetime.now(UTC)
    told = now + timedelta(minutes=minutes)
    page.evaluate(
        """time => {
            document.querySelector("time.age").dateTime = time;
            document.dispatchEvent(new Event("redrawn"));
        }""",
        told.isoformat(),
    )
    said = page.text_content("time.age").replace("\u00a0", " ")
    assert said == words == age_words(told, now).replace("\u00a0", " ")


def test_pages_fit_a_phone_and_load_little(opened: Callable[..., Page]) -> None:
    page = opened(viewport=PHONE, color_scheme="dark")
    loaded: list[int] = []
    page.on("response", lambda one: loaded.append(_size_of(one)))
    for path in PATHS:
        loaded.clear()
        answer = page.goto(path)
        assert answer.status == 200, path
        assert page.evaluate("document.documentElement.scrollWidth") <= PHONE["width"], path
        assert sum(loaded) < MOST_BYTES, path


def test_the_account_can_be_read_on_a_phone(opened: Callable[..., Page]) -> None:
    page = opened(viewport=PHONE)
    page.goto("/twins/east/data")
    for one in page.locator("table.account tbody").locator("th, td").all():
        box = one.bounding_box()
        # Each stands in one line, within the page.
        assert box["height"] < 30
        assert box["x"] + box["width"] <= PHONE["width"]
    fates = page.locator("table.account tr:last-child td").evaluate_all(
        "all => all.map((one) => getComputedStyle(one, '::before').content)"
    )
    assert fates[-3:] == ['"partly late"', '"refused"', '"unaccounted"']


def test_a_finger_that_misses_a_sensor_finds_it(opened: Callable[..., Page]) -> None:
    page = opened(viewport=PHONE, has_touch=True)
    page.goto("/twins/east")
    box = page.locator("#sensor-3").bounding_box()
    middle = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    assert page.evaluate(ELEMENT_AT, [*middle]) == "sensor-3"
    # Beside the mark, and still within 12 px of its middle, where no other mark is.
    around = [(middle[0] + x, middle[1] + y) for x in (0, 8, -8) for y in (11, -11, 8, -8)]
    beside = [one for one in around if page.evaluate(REACH_AT, [*one]) == "sensor-3"]
    page.touchscreen.tap(*beside[0])
    page.wait_for_url("**/twins/east#row-3")
    assert page.locator(".pointed").inner_text().startswith(page.locator("#row-3 a").inner_text())


def test_fields_stay_in_their_panel_on_a_phone(opened: Callable[..., Page]) -> None:
    page = opened(viewport=PHONE)
    page.goto("/twins/east/queries")
    panel = page.locator("form.controls").bounding_box()
    for one in page.locator("form.controls select, form.controls input").all():
        box = one.bounding_box()
        assert box["x"] + box["width"] <= panel["x"] + panel["width"]


def test_buttons_of_an_alarm_stand_beside_their_fields(
    opened: Callable[..., Page], service: Service
) -> None:
    there = Condition(ConditionKey("east", "gap", "alarm", "twin"), "off", datetime.now(UTC))
    service.alarms.observe("east", Observation((there,), frozenset({"gap"})))
    page = opened(viewport={"width": 1280, "height": 900})
    page.goto("/twins/east/alarms")
    for form in page.locator(".alarm.raised form").all():
        fields = form.locator("input:not([type=hidden]), select, button").all()
        feet = [box["y"] + box["height"] for box in (one.bounding_box() for one in fields)]
        assert max(feet) - min(feet) <= 2


def _size_of(answer: Any) -> int:
    """Bytes of what was loaded; a stream goes on, and is none of the page."""
    kind = answer.headers.get("content-type", "")
    return 0 if kind.startswith("text/event-stream") else len(answer.body())


@pytest.mark.parametrize("scripts", [True, False])
def test_a_cause_is_accepted_by_a_click(
    opened: Callable[..., Page], service: Service, scripts: bool
) -> None:
    page = opened(java_script_enabled=scripts)
    page.goto("/")
    page.get_by_role("link", name="small bridge").first.click()
    page.get_by_role("link", name="Causes").click()
    page.get_by_label("why it is so").fill("surveyed on site")
    page.get_by_role("button", name="Accept").click()
    assert page.get_by_text("Asked, and not carried out yet").is_visible()
    played(service.twins["east"])
    page.get_by_role("link", name="Versions").click()
    assert page.get_by_role("heading", name="Version 2 ● in force").is_visible()
    # And back, with the reason that its form asks for.
    page.get_by_text("Roll back to this version").click()
    page.get_by_label("reason").fill("a second look")
    page.get_by_role("button", name="Put version 1 in force again").click()
    played(service.twins["east"])
    page.reload()
    assert page.get_by_role("heading", name="Version 1 ● in force").is_visible()


def test_pages_are_complete_without_scripts(opened: Callable[..., Page]) -> None:
    page = opened(java_script_enabled=False)
    page.goto("/twins/east")
    assert page.locator("svg .sensor").count() == 11
    assert page.locator("#strip .line").get_attribute("d")
    # Choosing a sensor leads to its row, and from there to its page.
    page.locator("#sensor-0").click()
    assert page.url.endswith("#row-0")
    page.locator("#row-0").get_by_role("link").click()
    assert page.locator(".chart").count() == 3
    page.goto("/twins/east?at=40000")
    assert page.get_by_text("As of 2026-11-23").is_visible()


def test_what_happens_appears_by_itself(
    opened: Callable[..., Page], service: Service, lived_through: tuple[Any, Record]
) -> None:
    page = opened(timezone_id="Asia/Kolkata")
    page.goto("/twins/east")
    page.locator("#live", has_text="live").wait_for()
    before = page.locator("#gap-now").inner_text()
    assert "GMT+5:30" in before
    dot = page.locator("#sensor-0 title").text_content()
    record = lived_through[1]
    later = replace(record, time=record.time + 600.0 * len(record))
    lived(service.twins["east"], packets_of(later.rows(slice(0, 12)), START, stream=None))
    page.locator("#gap-now", has_text="120 rows").wait_for()
    assert page.locator("#sensor-0 title").text_content() != dot
    assert "GMT+5:30" in page.locator("#gap-now").inner_text()


def test_what_is_being_filled_in_stays(opened: Callable[..., Page], service: Service) -> None:
    page = opened()
    page.goto("/twins/east/causes")
    page.locator("#live", has_text="live").wait_for()
    page.get_by_label("why it is not so").fill("I am still writ")
    with page.expect_response(lambda one: one.url.endswith("/causes")):
        page.evaluate("document.dispatchEvent(new Event('visibilitychange'))")
    page.wait_for_timeout(200)
    assert page.get_by_label("why it is not so").input_value() == "I am still writ"


def test_pointing_at_a_sensor_tells_of_it(opened: Callable[..., Page]) -> None:
    page = opened()
    page.goto("/twins/east")
    page.locator("#sensor-1").hover()
    assert page.locator(".pointed").inner_text().startswith("D2, displacement at node L2: measured")
    # The keyboard does the same.
    page.locator("#sensor-2").focus()
    assert page.locator(".pointed").inner_text().startswith("D3,")


def test_an_alarm_is_drawn_as_it_is_raised(opened: Callable[..., Page], service: Service) -> None:
    page = opened()
    page.goto("/twins/east/alarms")
    page.get_by_text("live", exact=True).wait_for()
    words = "the west bearing is out of step"
    assert not page.get_by_text(words).is_visible()
    there = Condition(ConditionKey("east", "gap", "alarm", "twin"), words, datetime.now(UTC))
    service.alarms.observe("east", Observation((there,), frozenset({"gap"})))
    page.get_by_text(words).first.wait_for(timeout=20_000)
