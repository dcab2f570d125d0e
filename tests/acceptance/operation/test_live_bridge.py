"""What `make live` shows: something happens, a cause is proposed, a click accepts it."""

import json
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from urllib.request import urlopen

import pytest

from rga_bench.operation.service_process import free_port
from served.made_service import waited_for

EXAMPLE = Path(__file__).parents[3] / "examples/live_bridge.py"
CHROMIUM = shutil.which("chromium")


class Shown:
    """The service of the example, as a browser reaches it."""

    def __init__(self, address: str) -> None:
        self.address = address

    def now(self) -> Any:
        """Where the twin stands; None before it has begun."""
        try:
            with urlopen(f"{self.address}/api/v1/twins/footbridge", timeout=30) as answer:
                return json.load(answer)["now"]
        except OSError:
            return None


@pytest.fixture
def shown(tmp_path: Path) -> Iterator[Shown]:
    port = free_port()
    command = [sys.executable, str(EXAMPLE), "--no-browser", "--port", str(port)]
    command += ["--folder", str(tmp_path / "live"), "--pace", "0.2"]
    process = subprocess.Popen(command)
    yield Shown(f"http://127.0.0.1:{port}")
    process.terminate()
    process.wait()


@pytest.mark.skipif(CHROMIUM is None, reason="chromium is not installed")
def test_a_change_is_found_and_accepted_by_a_click(shown: Shown) -> None:
    from playwright.sync_api import sync_playwright

    waited_for(lambda: (now := shown.now()) and now["undecided"], longest=240.0)
    before = shown.now()
    assert "support settlement of abutment" in before["undecided"]["words"]
    with sync_playwright() as browsers:
        page = browsers.chromium.launch(executable_path=CHROMIUM).new_page()
        page.goto(f"{shown.address}/")
        assert page.get_by_text("park footbridge").count()
        page.goto(f"{shown.address}/twins/footbridge/alarms")
        assert page.get_by_text("out of sync").count()
        while shown.now()["version"] == 1:
            page.goto(f"{shown.address}/twins/footbridge/causes")
            # A later diagnosis may propose something in its place meanwhile.
            if page.get_by_role("button", name="Accept").count():
                page.locator("input[name=why]").first.fill("levelled on site")
                page.get_by_role("button", name="Accept").first.click()
            page.wait_for_timeout(2_000)
        rows = shown.now()["rows"]
        waited_for(lambda: shown.now()["rows"] >= rows + 40)
        page.goto(f"{shown.address}/twins/footbridge/versions")
        assert page.get_by_text("settlement").count()
    assert shown.now()["recent"] < before["recent"] / 2
