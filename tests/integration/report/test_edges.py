"""Tables of a report at their edges: a shade tells that there is more, and nothing else shows."""

import shutil
from collections.abc import Iterator
from io import BytesIO
from typing import Any

import numpy as np
import pytest
from jinja2 import Environment, PackageLoader
from matplotlib.image import imread

CHROMIUM = shutil.which("chromium")
playwright = pytest.importorskip("playwright.sync_api")
pytestmark = pytest.mark.skipif(CHROMIUM is None, reason="there is no Chromium here")
#: brightness that the eye does not tell from white
UNSEEN = 0.99


@pytest.fixture(scope="module")
def browser() -> Iterator[Any]:
    with playwright.sync_playwright() as driver:
        found = driver.chromium.launch(executable_path=CHROMIUM, args=["--no-sandbox"])
        yield found
        found.close()


def darkest(browser: Any, width: int, table: int) -> float:
    """Of the last pixels of what scrolls, beside a table of a width [pixels] without lines."""
    environment = Environment(loader=PackageLoader("rga.report"), autoescape=True)
    style = environment.get_template("style.css.j2").render(fonts="serif")
    inside = f'<div style="width: {table}px; height: 200px"></div>' if table else "<p>a</p>" * 9
    page = browser.new_page(viewport={"width": width, "height": 400})
    page.set_content(f'<style>{style}</style><body><div class="scroll">{inside}</div>')
    image = imread(BytesIO(page.screenshot()), format="png")[60:160, width // 2 :, :3]
    page.close()
    return float(np.min(image))


@pytest.mark.parametrize("width", [900, 999, 1009])
def test_a_table_that_fits_has_no_line_at_its_edge(browser: Any, width: int) -> None:
    """The edge lies between two pixels, as the page has margins of fractions of one."""
    assert darkest(browser, width, table=0) > UNSEEN


def test_a_table_that_does_not_fit_has_a_shade(browser: Any) -> None:
    assert darkest(browser, 900, table=2000) < 0.9
