"""Effects hidden by seed are found, each beside its null twin in which nothing may be found.

The cases come from physics of their own (rga.benchmark.truth). CI runs a fixed part of the
challenge; `rga benchmark diagnosis` runs as much of it as one likes.
"""

import pytest

from rga.benchmark.challenge import VISIBLE, Outcome, challenge

SEEDS = (1007, 1010, 1016, 1018, 1021, 1028, 1029)


@pytest.fixture(scope="module")
def outcomes() -> list[Outcome]:
    """A hidden effect and its null twin for every seed."""
    return challenge(list(SEEDS), workers=2)


def test_hidden_effects_are_found(outcomes: list[Outcome]) -> None:
    hidden = [one for one in outcomes if one.kind != "null"]
    assert len({one.kind for one in hidden}) >= 6
    missed = [one for one in hidden if one.d_prime >= VISIBLE and not one.found]
    assert not missed


def test_null_twins_name_nothing(outcomes: list[Outcome]) -> None:
    nulls = [one for one in outcomes if one.kind == "null"]
    assert len(nulls) == len(SEEDS)
    assert not [one for one in nulls if one.named]


def test_null_twins_are_the_same_reality(outcomes: list[Outcome]) -> None:
    for hidden, null in zip(outcomes[::2], outcomes[1::2], strict=True):
        assert (hidden.seed, hidden.bridge, hidden.reality) == (
            null.seed,
            null.bridge,
            null.reality,
        )
