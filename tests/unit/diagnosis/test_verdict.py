"""The verdict, from causes, faults, structure and rivals, and the warnings in words."""

from dataclasses import replace
from typing import Any

import pytest

from known_problem import candidate, found_with
from rga.diagnosis.data.held_out import Gain
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.residuals.lack_of_fit import Misfit
from rga.diagnosis.search.linearised import Problem
from rga.diagnosis.search.stepwise import Found
from rga.diagnosis.verdict import reasons_for_doubt, verdict

SOUND = Gain(1.0, 0.9, (0.05, 0.15))


@pytest.fixture
def nothing(noisy: Problem) -> Found:
    return found_with(noisy, [])


@pytest.fixture
def cause(noisy: Problem) -> Found:
    """A bias, and another that is far behind."""
    one, other = (candidate(noisy, "sensor_bias", sensor=name) for name in ("D1", "D2"))
    return with_rival(found_with(noisy, [one], [other]), 50.0)


def with_rival(found: Found, behind: float) -> Found:
    (ranked,) = found.alternatives
    return replace(found, alternatives=((replace(ranked[0], behind=behind),),))


@pytest.mark.parametrize(
    ("faults", "structure", "said"),
    [
        (False, False, "nothing_wrong"),
        (False, True, "unknown"),
        (True, False, "named"),
        (True, True, "partial"),
    ],
)
def test_without_causes(nothing: Found, faults: bool, structure: bool, said: str) -> None:
    assert verdict(nothing, faults, structure) == said


def test_with_a_cause(cause: Found) -> None:
    assert verdict(cause, False, False) == "named"
    assert verdict(cause, False, True) == "partial"
    assert verdict(with_rival(cause, 0.5), False, False) == "ambiguous"
    assert verdict(with_rival(cause, 0.5), False, True) == "partial"


def reasons(found: Found, **changes: Any) -> list[str]:
    given: dict[str, Any] = {"faults": [], "dropped": [], "off": []}
    given |= {"gained": SOUND, "unseen": None, **changes}
    return reasons_for_doubt(found.problem.data.sensors, found=found, **given)


def test_a_record_that_is_explained_has_no_warning(nothing: Found, cause: Found) -> None:
    assert reasons(nothing) == reasons(cause) == []


def test_a_cause_that_held_out_rows_do_not_confirm_is_said_once(nothing: Found) -> None:
    one = candidate(nothing.problem, "support_settlement", support="east", dof="uz")
    (words,) = reasons(nothing, dropped=[one, one.beginning(600.0)])
    assert "support settlement" in words
    assert "east" in words


def test_many_misfits_are_counted(nothing: Found) -> None:
    off = [Misfit(f"S{k}", (f"S{k}",), 12.0, 5.0) for k in range(8)]
    words = reasons(nothing, off=off)
    assert "channel S0 reads +12 %" in words[0]
    assert words[-1] == f"{9 - len(words)} more channels or groups are off"


def test_a_third_of_the_channels_broken_is_a_doubt(nothing: Found) -> None:
    channels = nothing.problem.data.sensors
    broken = [BrokenChannel(name, "dead", "it is silent", 9) for name in channels[:4]]
    assert f"4 of {len(channels)} channels" in reasons(nothing, faults=broken)[0]
    assert reasons(nothing, faults=broken[:3]) == []


def test_a_gap_that_the_causes_do_not_close_is_a_warning(cause: Found, nothing: Found) -> None:
    worse = Gain(1.0, 1.2, (-0.3, -0.1))
    assert "rows that no step saw" in reasons(cause, gained=worse)[0]
    assert reasons(nothing, gained=worse) == []
    (words,) = reasons(nothing, gained=Gain(9.0, 9.0, (0.0, 0.0)))
    assert "9 times the noise" in words


def test_channels_left_out_that_get_worse_are_a_warning(cause: Found) -> None:
    (words,) = reasons(cause, unseen=(1.0, 3.0))
    assert "channels left out of the fit that speak against the causes" in words
    assert reasons(cause, unseen=(3.0, 1.0)) == []


def test_scatter_beyond_what_is_plausible_is_a_warning(nothing: Found) -> None:
    for number, of in enumerate(("the stiffness of members", "gains of channels")):
        levels = nothing.problem.levels.copy()
        levels[number] = 0.2
        wide = replace(nothing, problem=replace(nothing.problem, levels=levels))
        (words,) = reasons(wide)
        assert words.startswith(f"{of} would have to scatter by 20.0%")


@pytest.mark.parametrize(("rows", "said"), [((40, 41, 44), 1), ((20, 41, 62), 0)])
def test_channels_that_are_off_from_one_moment_on_are_a_warning(
    noisy: Problem, rows: tuple[int, ...], said: int
) -> None:
    names = ("D1", "D2", "D3")
    late = [
        candidate(noisy, "sensor_bias", sensor=name).beginning(float(noisy.data.time[row]), "step")
        for name, row in zip(names, rows, strict=True)
    ]
    found = found_with(noisy, late)
    reasons = reasons_for_doubt(list(names), [], found, [], [], SOUND, None)
    assert sum("same moment" in one for one in reasons) == said
