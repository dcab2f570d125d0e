"""Every verification case that stands beside the repository."""

from pathlib import Path

import pytest

from rga.simulation.verification import verify_case

FOLDER = Path(__file__).resolve().parents[4] / "shared" / "verification"
CASES = sorted(FOLDER.glob("*.json"))


@pytest.mark.skipif(not CASES, reason="no verification cases beside the repository")
@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_case_is_met(path: Path) -> None:
    result = verify_case(path)
    assert result.count > 0
    assert result.passed, result.first_failure
