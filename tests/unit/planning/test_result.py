"""A plan as it stands in a file."""

import json

import pytest
from pydantic import ValidationError

from rga.planning.result import Plan, PlannedTruck


def plan() -> Plan:
    return Plan(
        sentence="Measure the middle.",
        truck=PlannedTruck(loads=[60.0, 100.0], spacings=[3.5], paths=[["L0", "L4"]]),
        budget={"sensors": 1, "positions": 2},
        seed=3,
        model_sha256="a",
        findings_sha256="b",
    )


def test_it_comes_back_as_it_was() -> None:
    content = json.loads(plan().to_json())
    assert content["rga_plan"] == 1
    assert Plan.model_validate(content) == plan()


def test_what_is_no_number_or_no_key_is_refused() -> None:
    broken = plan().model_copy(update={"cost": float("nan")})
    with pytest.raises(ValueError, match="JSON"):
        broken.to_json()
    with pytest.raises(ValidationError, match="colour"):
        Plan.model_validate({**json.loads(plan().to_json()), "colour": "red"})
