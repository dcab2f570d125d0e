"""Effects hidden by seed are found, each beside its null twin in which nothing may be found.

The cases come from physics of their own (rga_bench.synthetic). CI runs this fixed part of the
challenge; `rga benchmark diagnosis` runs as much of it as one likes.
"""

from dataclasses import replace
from functools import cache

import pytest

from rga_bench.diagnosis.design import Draw
from rga_bench.diagnosis.judge import DrawOutcome, judge
from rga_bench.experiment import Execution
from rga_bench.ledger import outcomes_of

FEW, MORE = ("1-single-40", "1-pair-0"), ("1-single-4", "1-single-26")
names = pytest.mark.parametrize(
    "name", [*FEW, *(pytest.param(name, marks=pytest.mark.thorough) for name in MORE)]
)


@cache
def outcomes(named: tuple[str, ...]) -> dict[str, DrawOutcome]:
    """A draw and its null twin for every name."""
    hidden = [Draw.parse(name) for name in named]
    tasks = [*hidden, *(replace(one, null=True) for one in hidden)]
    done = outcomes_of(judge, tasks, DrawOutcome, Execution(workers=2))
    return {one.id: one for one in done}


def outcome(name: str) -> DrawOutcome:
    """That of a draw, which is judged with others at once."""
    return outcomes(FEW if name.removesuffix("-null") in FEW else MORE)[name]


@names
def test_what_is_hidden_is_found(name: str) -> None:
    one = outcome(name)
    assert len(one.hidden) == len(one.draw.kinds)
    for hidden in one.hidden:
        assert hidden["d_prime"] > 10
        assert hidden["found"]
    named = {cause["kind"] for cause in one.named} | {
        rival["kind"] for cause in one.named for rival in cause["rivals"]
    }
    assert set(one.draw.kinds) <= named


@names
def test_its_null_twin_names_nothing(name: str) -> None:
    one = outcome(f"{name}-null")
    assert not one.hidden
    assert not one.named
    assert one.model_sha256 == outcome(name).model_sha256


def test_no_outcome_depends_on_the_workers() -> None:
    alone, pooled = judge(Draw.parse("1-single-40")), outcome("1-single-40")
    assert replace(alone, seconds=0.0) == replace(pooled, seconds=0.0)
