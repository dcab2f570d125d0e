"""Verification cases of our own, in the format of `rga verify`: closed forms and dense solves."""

import copy
import json
from pathlib import Path
from typing import Any

import pytest

from independent.reference_solver import solve_case
from rga.simulation.verification import verify_case, verify_folder

FOLDER = Path(__file__).parents[2] / "verification"
CASES = sorted(FOLDER.glob("*.json"))


def read(path: Path) -> dict[str, Any]:
    case: dict[str, Any] = json.loads(path.read_text(encoding="utf-8"))
    return case


def test_all_cases_are_met() -> None:
    results = verify_folder(FOLDER)
    assert len(results) >= 20
    assert {result.name: result.first_failure for result in results if not result.passed} == {}


def test_most_cases_are_closed_forms() -> None:
    origins = [
        {
            entry["origin"]
            for load_case in read(path)["load_cases"]
            for entry in load_case["expected"]
        }
        for path in CASES
    ]
    assert sum(each == {"closed_form"} for each in origins) >= 12
    assert set().union(*origins) == {"closed_form", "reference"}


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_the_reference_solver_agrees(path: Path) -> None:
    """Two ways to every closed form, neither of them the core's."""
    case = read(path)
    for load_case in case["load_cases"]:
        values = solve_case(case, load_case)
        for value, entry in zip(values, load_case["expected"], strict=True):
            tolerance = entry["atol"] + 1e-14 * abs(entry["value"])
            assert abs(float(value) - entry["value"]) <= tolerance, entry


@pytest.mark.parametrize("path", CASES, ids=lambda path: path.stem)
def test_a_shifted_value_fails(path: Path, tmp_path: Path) -> None:
    case = read(path)
    for number, load_case in enumerate(case["load_cases"]):
        shifted = copy.deepcopy(case)
        entry = shifted["load_cases"][number]["expected"][0]
        entry["value"] += 10 * (entry["atol"] + entry["rtol"] * abs(entry["value"]))
        assert entry["value"] != load_case["expected"][0]["value"]
        (tmp_path / "shifted.json").write_text(json.dumps(shifted), encoding="utf-8")
        result = verify_case(tmp_path / "shifted.json")
        assert not result.passed
        assert load_case["name"] in str(result.first_failure)
