"""The unloaded lead-in of a record, found from the data."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray
from rga.errors import InputError

BLOCKS = 200
#: blocks at the beginning that are taken as quiet, and over which a level is taken
QUIET_BLOCKS = 10
#: shift of a channel's level within the lead-in that is tolerated, as a share of its activity
CREEP = 0.01
#: activity of a channel under load over its activity at rest, below which it says nothing
CONTRAST = 10.0


def find_lead_in(time: FloatArray, readings: FloatArray, where: str) -> tuple[float, float]:
    """The longest leading stretch in which the structure is at rest.

    The load arrives where the median over channels of the moving rms, each standardised by its
    channel's largest, leaves its level at the beginning; a channel that spikes has no say in a
    median. Channels that were quiet until then are trusted, and the stretch ends earlier where the
    level of one of them creeps by more than 1 % of what the load moves it.

    Args:
        time: float[n] [s].
        readings: float[n, channels], NaN where missing.
        where: the file, for an error.

    Returns:
        First and last time of the lead-in [s].

    Raises:
        InputError: the record does not begin at rest.
    """
    edges = np.linspace(0, len(time), min(BLOCKS, len(time) // 4) + 1).astype(int)
    if len(edges) <= 2 * QUIET_BLOCKS:
        raise _no_lead_in(where, f"{len(time)} rows are too few to find it")
    level, rms = _blocks(readings, edges)
    # The split lies within the rise of the load: the margin keeps the rise out.
    end = _arrival(rms) - QUIET_BLOCKS
    if end < QUIET_BLOCKS:
        raise _no_lead_in(where, "the channels do not begin quieter than they go on")
    activity = np.nanmax(rms, axis=0)
    trusted = activity > CONTRAST * np.nanmax(rms[:end], axis=0)
    windows = np.lib.stride_tricks.sliding_window_view(level[: end + QUIET_BLOCKS], QUIET_BLOCKS, 0)
    shift = np.abs(np.median(windows, axis=-1) - np.median(level[:QUIET_BLOCKS], axis=0))
    creeping = (shift > CREEP * activity)[:, trusted].any(axis=1)
    if creeping.any():
        end = max(int(np.argmax(creeping)), QUIET_BLOCKS)
    return float(time[0]), float(time[edges[end] - 1])


def _blocks(readings: FloatArray, edges: NDArray[np.int_]) -> tuple[FloatArray, FloatArray]:
    """Level (median) and rms about the level at rest of every block, float[blocks, channels]."""
    blocks = [readings[first:last] for first, last in pairwise(edges)]
    with np.errstate(all="ignore"):
        level = np.array([np.nanmedian(block, axis=0) for block in blocks])
        rest = np.nanmedian(level[:QUIET_BLOCKS], axis=0)
        rms = np.array([np.sqrt(np.nanmean((block - rest) ** 2, axis=0)) for block in blocks])
    return level, rms


def _arrival(rms: FloatArray) -> int:
    """First block under load: where the logarithm of the overall activity changes its level."""
    with np.errstate(all="ignore"):
        overall = np.nanmedian(rms / np.nanmax(rms, axis=0), axis=1)
    loudest = int(np.nanargmax(overall))
    begin = np.log(np.maximum(overall[: loudest + 1], 1e-9))
    if loudest < QUIET_BLOCKS or begin[-1] - np.median(begin[:QUIET_BLOCKS]) < np.log(CONTRAST):
        return 0
    costs = [
        begin[:split].var() * split + begin[split:].var() * (len(begin) - split)
        for split in range(1, len(begin))
    ]
    return int(np.argmin(costs)) + 1


def _no_lead_in(where: str, why: str) -> InputError:
    return InputError(
        f"no unloaded lead-in was found, {why}", where, "give zero = [from, to] [s] in import.toml"
    )
