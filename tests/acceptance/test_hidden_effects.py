"""Effects hidden by seed are found, each beside its null twin in which nothing may be found.

The cases come from physics of their own (rga_bench.synthetic). CI runs this fixed part of the
challenge; `rga benchmark diagnosis` runs as much of it as one likes.
"""

from dataclasses import replace

import pytest

from rga_bench.diagnosis.design import Draw
from rga_bench.diagnosis.judge import DrawOutcome, judge
from rga_bench.experiment import Execution
from rga_bench.ledger import outcomes_of

NAMES = ("1-single-4", "1-single-26", "1-single-40", "1-pair-0")


@pytest.fixture(scope="module")
def outcomes() -> dict[str, DrawOutcome]:
    """A draw and its null twin for every name."""
    hidden = [Draw.parse(name) for name in NAMES]
    tasks = [*hidden, *(replace(one, null=True) for one in hidden)]
    done = outcomes_of(judge, tasks, DrawOutcome, Execution(workers=2))
    return {one.id: one for one in done}


@pytest.mark.parametrize("name", NAMES)
def test_what_is_hidden_is_found(outcomes: dict[str, DrawOutcome], name: str) -> None:
    one = outcomes[name]
    assert len(one.hidden) == len(one.draw.kinds)
    for hidden in one.hidden:
        assert hidden["d_prime"] > 10
        assert hidden["found"]
    named = {cause["kind"] for cause in one.named} | {
        rival["kind"] for cause in one.named for rival in cause["rivals"]
    }
    assert set(one.draw.kinds) <= named


@pytest.mark.parametrize("name", NAMES)
def test_its_null_twin_names_nothing(outcomes: dict[str, DrawOutcome], name: str) -> None:
    one = outcomes[f"{name}-null"]
    assert not one.hidden
    assert not one.named
    assert one.model_sha256 == outcomes[name].model_sha256


def test_no_outcome_depends_on_the_workers(outcomes: dict[str, DrawOutcome]) -> None:
    alone, pooled = judge(Draw.parse("1-single-40")), outcomes["1-single-40"]
    assert replace(alone, seconds=0.0) == replace(pooled, seconds=0.0)
