"""The page of the HTTP API says what the service answers to."""

import runpy

from documentation import ROOT


def test_the_page_is_up_to_date() -> None:
    tool = runpy.run_path(str(ROOT / "tools" / "http_api.py"))
    written = tool["PAGE"].read_text("utf-8")
    assert tool["page"](written) == written, "run python tools/http_api.py"
    assert "## `POST /api/v1/twins/{twin}/packets`" in written
