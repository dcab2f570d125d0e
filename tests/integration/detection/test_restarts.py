"""The monitor leaves the same bits however its stream is cut, stored and read back."""

import pickle
from itertools import pairwise

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from rga.detection import SyncMonitor
from unchanged_streams import MISSING, Rows


def stream_of(memory: float, common: float, gaps: bool, dead: bool, seed: int) -> Rows:
    """With a change in the last third, and a sensor more than the rest that may be dead."""
    generator = np.random.default_rng(seed)
    rows = generator.normal(size=(500, 3)) + common * generator.normal(size=(500, 1))
    for row in range(4, len(rows)):
        rows[row] += memory * (0.5 * rows[row - 1] + 0.3 * rows[row - 4])
    rows[430:, 0] += 4.0
    if gaps:
        rows[generator.random(rows.shape) < 0.1] = MISSING
    if dead:
        rows[350:, 2] = MISSING
    return rows


@settings(deadline=None, max_examples=40)
@given(
    memory=st.sampled_from([0.0, 0.6, 1.0]),
    common=st.sampled_from([0.0, 1.5]),
    gaps=st.booleans(),
    dead=st.booleans(),
    seed=st.integers(0, 20),
    cuts=st.sets(st.integers(300, 500), max_size=5),
)
def test_cuts_and_restarts_leave_the_same_bits(
    memory: float, common: float, gaps: bool, dead: bool, seed: int, cuts: set[int]
) -> None:
    rows = stream_of(memory, common, gaps, dead, seed)
    monitors = [SyncMonitor(rows[:300], arl0=200) for _ in range(3)]
    one_by_one, in_parts, stored = monitors
    alarms = np.array([one_by_one.update(row) for row in rows[300:]])
    for start, end in pairwise([300, *sorted(cuts), 500]):
        in_parts = pickle.loads(pickle.dumps(in_parts))
        stored = SyncMonitor.from_bytes(stored.to_bytes())
        for monitor in (in_parts, stored):
            found = monitor.update_many(rows[start:end])
            assert np.array_equal(found, alarms[start - 300 : end - 300])
    assert in_parts.to_bytes() == stored.to_bytes() == one_by_one.to_bytes()
    assert in_parts.alarm == stored.alarm == one_by_one.alarm
    assert stored.warnings == one_by_one.warnings
    assert (stored.rows, stored.arl0) == (200, 200.0)
