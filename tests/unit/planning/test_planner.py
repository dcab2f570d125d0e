"""A plan of the small bridge: within its budget, repeatable, and clear about what it cannot do."""

import pytest

from made_findings import cause, findings
from planned_bridge import EAST, GAIN, SOFT
from rga.errors import InputError
from rga.findings import Findings
from rga.model import Model
from rga.model.schema import ExpectedMode
from rga.planning.planner import plan

WEAK = {**SOFT, "factor": {"value": 0.7, "ci90": [0.65, 0.75]}}
HIGH = {**GAIN, "factor": {"value": 1.43, "ci90": [1.35, 1.5]}}


@pytest.fixture(scope="module")
def rivals() -> Findings:
    return findings(cause(WEAK, HIGH))


def test_it_separates_within_its_budget(model: Model, rivals: Findings) -> None:
    found = plan(model, rivals, sensors=1, positions=1, seed=2)
    assert len(found.sensors) <= 1
    assert len(found.tests) <= 1
    (separation,) = found.separations
    assert separation.d_perp <= separation.d_perp_at_best * 1.001
    assert separation.separated == (separation.simulated.clearly >= 0.9) or separation.expected < 1
    assert found.cost == pytest.approx(sum(one.cost for one in [*found.sensors, *found.tests]))
    assert plan(model, rivals, sensors=1, positions=1, seed=2) == found


def test_more_money_never_separates_less(model: Model, rivals: Findings) -> None:
    poor = plan(model, rivals, sensors=0, positions=0).separations[0]
    rich = plan(model, rivals, sensors=2, positions=1).separations[0]
    assert poor.d_perp == 0.0
    assert rich.d_perp >= poor.d_perp
    assert rich.d_perp > 3


def test_nothing_to_separate_needs_nothing(model: Model) -> None:
    found = plan(model, findings())
    assert (found.sensors, found.tests, found.separations) == ([], [], [])
    assert found.cost == 0.0
    assert found.sentence


def test_that_no_frequency_is_planned_is_told(model: Model) -> None:
    swinging = model.model_copy(update={"modes": {"first": ExpectedMode(near=3.0)}})
    advised = cause(WEAK, HIGH, separated_by="against it: a parked truck")
    told = plan(swinging, findings(advised), sensors=1, positions=1).sentence
    assert "natural frequencies and shapes are not" in told
    assert "against it: a parked truck." in told
    assert "frequencies" not in plan(model, findings(advised), sensors=1, positions=1).sentence


def test_findings_of_another_model_are_refused(model: Model) -> None:
    other = {**EAST, "support": "north", "displacement": -0.01}
    with pytest.raises(InputError, match="north"):
        plan(model, findings(cause(other)))
