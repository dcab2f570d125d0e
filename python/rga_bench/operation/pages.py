"""What people see of a service: how soon a row is on a page, and what a page costs."""

import re
import shutil
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from statistics import median, quantiles
from urllib.request import urlopen

from rga_bench.operation.row_by_row import TWIN, RowByRow, row_by_row
from rga_bench.operation.viewers import LONGEST, viewers

#: how often the newest readings are asked for, and of how many rows one is sent to all viewers
ASKED, THINNED = 20, 5
#: what a page loads besides
_LOADED = re.compile(r'(?:href|src)="(/static/[^"]+)"')


@dataclass(frozen=True)
class PageCost:
    """What the page of a bridge takes.

    Attributes:
        sensors: on the bridge.
        weight: bytes of the page with all that it loads.
        latest: median time of an answer with the newest readings [s].
        told: time from sending what makes a row final to its message in the stream, which 95 %
            of the rows keep [s].
        drawn: the same, to its being drawn in a browser [s]; None: see `lacking`.
        lacking: why it was not looked at in a browser; "": it was.
        viewers: how many looked at once.
        alone, together: time of the processor for a row with one viewer, and with all [s].
        slowest: time until the pages of all of them show a row, which 95 % of the rows keep [s].
    """

    sensors: int
    weight: int
    latest: float
    told: float
    drawn: float | None
    lacking: str
    viewers: int
    alone: float
    together: float
    slowest: float


def page_cost(sensors: int, panels: int, rows: int, many: int, seed: int) -> PageCost:
    """Serve a bridge, and look at it.

    Args:
        sensors, panels: of the bridge.
        rows: that are sent for each measure.
        many: how many look at once.
        seed: of what is drawn.

    Raises:
        InputError: the service cannot be started, or does not come to an end.
    """
    with (
        tempfile.TemporaryDirectory() as name,
        row_by_row(Path(name), sensors, panels, 4 * rows, seed) as bridge,
    ):
        address = bridge.service.address
        asked = [_time_of(lambda: bridge.service.get(f"{TWIN}/latest")) for _ in range(ASKED)]
        with viewers(address, 1) as one:
            told = _times(bridge, rows, one.wait_told)
            alone, _ = _cost(bridge, rows, one.wait_shown)
        with viewers(address, many) as all_of_them:
            together, slow = _cost(bridge, max(2, rows // THINNED), all_of_them.wait_shown)
        drawn, lacking = _drawn(bridge, rows)
        return PageCost(
            sensors=sensors,
            weight=_weight(address),
            latest=median(asked),
            told=_most(told),
            drawn=drawn,
            lacking=lacking,
            viewers=many,
            alone=alone,
            together=together,
            slowest=_most(slow),
        )


def _times(bridge: RowByRow, rows: int, seen: Callable[[int], None]) -> list[float]:
    """Time of each row until it is seen [s]."""
    return [_time_of(lambda: seen(bridge.send())) for _ in range(rows)]


def _cost(bridge: RowByRow, rows: int, seen: Callable[[int], None]) -> tuple[float, list[float]]:
    """Time of the processor for a row [s], and `_times`."""
    before = bridge.service.usage.processor
    times = _times(bridge, rows, seen)
    return (bridge.service.usage.processor - before) / rows, times


def _drawn(bridge: RowByRow, rows: int) -> tuple[float | None, str]:
    """How soon a row is drawn in a browser; or why that is not known."""
    program = shutil.which("chromium")
    if program is None:
        return None, "there is no Chromium"
    try:
        from playwright.sync_api import sync_playwright
    except ImportError:
        return None, "playwright is not installed"
    with sync_playwright() as driver:
        browser = driver.chromium.launch(executable_path=program, args=["--no-sandbox"])
        page = browser.new_page()
        page.goto(f"{bridge.service.address}/twins/east")
        page.locator("#live", has_text="live").wait_for()

        def shown(final: int) -> None:
            words = f"{final} rows, the newest"
            page.locator("#gap-now", has_text=words).wait_for(timeout=1e3 * LONGEST)

        found = _most(_times(bridge, rows, shown))
        browser.close()
    return found, ""


def _weight(address: str) -> int:
    with urlopen(f"{address}/twins/east", timeout=LONGEST) as answer:
        page = answer.read()
    weight = len(page)
    for path in sorted(set(_LOADED.findall(page.decode()))):
        with urlopen(f"{address}{path}", timeout=LONGEST) as answer:
            weight += len(answer.read())
    return weight


def _time_of(does: Callable[[], object]) -> float:
    begun = time.perf_counter()
    does()
    return time.perf_counter() - begun


def _most(times: list[float]) -> float:
    """What 95 % of them keep."""
    return quantiles(times, n=20, method="inclusive")[-1]
