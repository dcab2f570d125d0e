"""Shares of late effects: running sums are the sums over the rows of shares written out."""

import numpy as np
import pytest

from rga.diagnosis.search.hypothesis import Profile
from rga.diagnosis.search.late_shares import EveryBeginning, OneBeginning

UNEVEN = np.array([0.0, 1.0, 2.5, 2.75, 6.0, 7.0, 11.0, 12.0])
VALUES = np.random.default_rng(4).normal(1.0, 2.0, (3, len(UNEVEN)))


@pytest.mark.parametrize("profile", ["step", "ramp"])
def test_running_sums_are_those_of_all_shares(profile: Profile) -> None:
    every = EveryBeginning(UNEVEN, UNEVEN[1:-1], profile)
    shares = every.at(UNEVEN)
    assert every.sums(VALUES) == pytest.approx(VALUES @ shares.T, rel=1e-10)
    assert every.squares(VALUES) == pytest.approx(VALUES @ (shares**2).T, rel=1e-10)
    for k, share in enumerate(shares):
        one = OneBeginning(share)
        assert one.sums(VALUES)[:, 0] == pytest.approx(every.sums(VALUES)[:, k])
        assert one.squares(VALUES)[:, 0] == pytest.approx(every.squares(VALUES)[:, k])


def test_a_step_is_whole_at_once_and_a_ramp_in_the_last_row() -> None:
    step = EveryBeginning(UNEVEN, UNEVEN[2:4], "step").at(UNEVEN)
    ramp = EveryBeginning(UNEVEN, UNEVEN[2:4], "ramp").at(UNEVEN)
    assert step.tolist() == [[0, 0, 1, 1, 1, 1, 1, 1], [0, 0, 0, 1, 1, 1, 1, 1]]
    assert ramp[0] == pytest.approx(np.clip((UNEVEN - 2.5) / 9.5, 0, None))
    assert (ramp[:, -1] == 1.0).all()
