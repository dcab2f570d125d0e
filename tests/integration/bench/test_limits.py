"""The benchmark of how much a diagnosis can be given."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

from rga_bench.ledger import NAME
from rga_bench.limits.experiment import SizeOutcome, _row


def test_a_small_size_is_measured(rga: Callable[..., Any], tmp_path: Path) -> None:
    done = rga("benchmark", "limits", "--quick", "-o", tmp_path / "out")
    assert done.code == 0, done.err
    page = (tmp_path / "out" / "limits.md").read_text("utf-8")
    (row,) = [line for line in page.splitlines() if line.startswith("| 200 ")]
    cells = [cell.strip() for cell in row.strip("|").split("|")]
    assert cells[1:3] == ["12", "105"]
    assert 0 < float(cells[4]) < 600
    assert 0.1 < float(cells[5]) < 4
    assert cells[6] == "nothing_wrong"
    # What is kept is not measured again.
    kept = (tmp_path / "out" / NAME).read_text("utf-8")
    again = rga("benchmark", "limits", "--quick", "-o", tmp_path / "out")
    assert again.code == 0, again.err
    assert (tmp_path / "out" / NAME).read_text("utf-8") == kept
    assert row in (tmp_path / "out" / "limits.md").read_text("utf-8").splitlines()


def test_what_did_not_end_is_told() -> None:
    assert _row(SizeOutcome(1000, 84, 10, "no memory"))[-1] == "not ended: no memory"
