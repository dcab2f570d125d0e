"""Modes of a record by name: in every window the most probable pairing with what is expected."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import polars as pl

from rga.arrays import FloatArray, IntArray
from rga.model.schema import Model
from rga.numerics.robust_spread import robust_spread
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.expected import Expected
from rga.simulation.modal.mixed_shapes import parts_of_others, unlike_mixed
from rga.simulation.modal.pairing import close_modes, paired
from rga.simulation.modal.wrong_points import unlike_but_for_points

#: cost of a pair beyond which an entry is none of the expected modes: four standard deviations in
#: frequency, say, or a MAC below 0.6
MOST_COST = 8.0
#: number of an entry that is none of the expected modes, and of one that may be either of two
NONE, OPEN = -1, -2
#: share of the windows in which a mode is hardly ever found; by how much frequencies of one thing
#: differ, and by how much the mode may have moved [ln]
HARDLY, STEADY, MOVED = 0.1, 0.03, np.log(2.0)


@dataclass(frozen=True)
class NamedModes:
    """Modes of a record, named.

    Attributes:
        time: of the windows [s], float[windows].
        mode: number of the expected mode of each entry, int[entries]; `NONE` of them, or `OPEN`
            which of close ones it is.
        readings: of the modal sensors of the model, float[windows, sensors]; NaN where a mode was
            not found.
        mac: of the entries with their modes, float[entries]; NaN without shape.
        doubtful: windows of which another pairing is nearly as probable, int.
        in_doubt: names of the modes that are others in such pairings.
        cost: of all pairs and of entries without one, as a negative logarithm of a probability.
    """

    time: FloatArray
    mode: IntArray
    readings: FloatArray
    mac: FloatArray
    doubtful: IntArray
    in_doubt: tuple[str, ...]
    cost: float


@dataclass(frozen=True)
class Stray:
    """What swings and is none of the modes expected, while some of these are hardly ever found.

    Attributes:
        lacking: those that it may be.
        frequency: at which it swings [Hz].
        share: of the windows in which it does.
    """

    lacking: tuple[str, ...]
    frequency: float
    share: float


def stray_of(
    named: NamedModes, record: ModalRecord, expected: Mapping[str, Expected]
) -> Stray | None:
    """What is found most often of all that may be a mode that is lacking, moved far away."""
    found = {
        name: len(np.unique(record.windows[named.mode == number]))
        for number, name in enumerate(expected)
    }
    lacking = [name for name in expected if found[name] < HARDLY * len(named.time)]
    log_f = np.log(record.frequency)
    near = np.log([expected[name].near for name in lacking])
    free = (named.mode == NONE) & (np.abs(log_f[:, None] - near) < MOVED).any(axis=1)
    if not free.any():
        return None
    order = np.sort(log_f[free])
    first, behind = (np.searchsorted(order, order + side) for side in (-STEADY, STEADY))
    middle = order[np.argmax(behind - first)]
    own = free & (np.abs(log_f - middle) <= STEADY)
    share = len(np.unique(record.windows[own])) / len(named.time)
    may_be = np.array(lacking)[np.abs(near - middle) < MOVED]
    return Stray(tuple(may_be.tolist()), float(np.exp(middle)), share)


def summary(
    named: NamedModes, record: ModalRecord, expected: Mapping[str, Expected]
) -> pl.DataFrame:
    """One line an expected mode: how often it was found, where, and how it scatters.

    Columns: mode, near [Hz], found [share of the windows], f (median) [Hz], scatter [% of f, of one
    window beside the next], MAC (median).
    """
    lines = []
    for number, (name, look) in enumerate(expected.items()):
        own = named.mode == number
        frequency = record.frequency[own]
        middle = float(np.median(frequency)) if own.any() else None
        alike = named.mac[own & np.isfinite(named.mac)]
        steps = np.diff(frequency[np.argsort(record.time[own])])
        lines.append(
            {
                "mode": name,
                "near": look.near,
                "found": own.sum() / len(named.time),
                "f": middle,
                "scatter": (
                    100 * robust_spread(steps) / 2**0.5 / middle
                    if middle is not None and len(steps)
                    else None
                ),
                "MAC": float(np.median(alike)) if len(alike) else None,
            }
        )
    return pl.DataFrame(lines, infer_schema_length=None)


def named_modes(
    record: ModalRecord,
    model: Model,
    expected: Mapping[str, Expected],
    changed: Mapping[int, Mapping[str, Expected]] | None = None,
) -> NamedModes:
    """Name the modes of a record by their shapes, and by frequency where they have none.

    Args:
        record: of this model.
        model: with modal sensors.
        expected: modes of the model, as a `ModalSimulator` has them.
        changed: what the same modes look like in windows in which the structure is known to be
            another.
    """
    names = list(expected)
    changed = {} if changed is None else changed
    known = {name: number for number, name in enumerate(model.points)}
    shapes = np.full((len(record), len(model.points)), np.nan)
    shapes[:, [known[name] for name in record.points]] = record.shapes
    mode = np.full(len(record), NONE, dtype=np.int64)
    alike = np.full(len(record), np.nan)
    windows = record.windows
    doubtful, cost = [], 0.0
    differing = np.zeros(len(names), dtype=bool)
    given = list(expected.values())
    parts_of_given = _parts(given, len(model.points))
    for window in range(windows.max(initial=-1) + 1):
        entries = np.flatnonzero(windows == window)
        looks, parts = given, parts_of_given
        if window in changed:
            looks = [changed[window].get(name, look) for name, look in expected.items()]
            parts = _parts(looks, len(model.points))
        unlike = np.array(
            [
                [unlike_mixed(look.shape, one[look.at], own) for one in shapes[entries]]
                for look, own in zip(looks, parts, strict=True)
            ]
        )
        pairing = paired(looks, record.frequency[entries], shapes[entries], MOST_COST, unlike)
        cost += pairing.cost
        near = np.log([look.near for look in looks])
        open_names = [_left_open(pairing.computed, other, near) for other, _ in pairing.others]
        if None in open_names:
            doubtful.append(window)
        for (other, _), modes in zip(pairing.others, open_names, strict=True):
            if modes is None:
                differing |= other != pairing.computed
        left = np.setdiff1d(np.arange(len(entries)), pairing.computed)
        lost = np.flatnonzero(pairing.computed < 0)
        if len(left) and len(lost):
            # Of what has no pair a few points may be wrong.
            own, several = [looks[number] for number in lost], shapes[entries[left]]
            unlike = np.array(
                [
                    [unlike_but_for_points(look, one[look.at], parts[number]) for one in several]
                    for number, look in zip(lost.tolist(), own, strict=True)
                ]
            )
            found = paired(own, record.frequency[entries[left]], several, MOST_COST, unlike)
            cost += found.cost - len(lost) * MOST_COST
            some = found.computed >= 0
            pairing.computed[lost[some]] = left[found.computed[some]]
        either = set().union(*(modes or () for modes in open_names))
        for number, chosen in enumerate(pairing.computed):
            if chosen >= 0:
                # Without a shape close modes are one to whoever measured.
                blind = np.isnan(pairing.mac[number, chosen])
                mode[entries[chosen]] = number if blind or number not in either else OPEN
                alike[entries[chosen]] = pairing.mac[number, chosen]
    readings = np.full((windows.max(initial=-1) + 1, len(model.modal_sensors)), np.nan)
    for at, sensor in enumerate(model.modal_sensors.values()):
        of_mode = np.flatnonzero(mode == names.index(sensor.mode))
        if sensor.point is None:
            readings[windows[of_mode], at] = record.frequency[of_mode]
            continue
        point = known[sensor.point]
        for entry in of_mode:
            look = changed.get(int(windows[entry]), {}).get(sensor.mode, expected[sensor.mode])
            readings[windows[entry], at] = shapes[entry, point] * _scale(look, shapes[entry])
    times = np.array([record.time[windows == one][0] for one in range(len(readings))])
    windows_in_doubt = np.array(doubtful, dtype=np.int64)
    in_doubt = tuple(np.array(names)[differing].tolist())
    return NamedModes(times, mode, readings, alike, windows_in_doubt, in_doubt, cost)


def _left_open(best: IntArray, other: IntArray, near: FloatArray) -> set[int] | None:
    """Modes of which the names stay open, where two pairings differ by close modes alone.

    Those that trade places are named in the order of their frequencies. Where one of them was found
    alone, which one it is stays open.

    Returns:
        Numbers of these modes; None where the pairings differ by more.
    """
    left_open: set[int] = set()
    for close in close_modes(np.flatnonzero(best != other), near):
        if set(best[close]) != set(other[close]):
            return None
        if (best[close] < 0).any():
            left_open |= set(close.tolist())
    return left_open


def _parts(looks: Sequence[Expected], points: int) -> list[FloatArray]:
    """What of the other modes expected may be in each, float[k, points of it]."""
    every = np.zeros((len(looks), points))
    for number, look in enumerate(looks):
        length = float(np.linalg.norm(look.shape))
        every[number, look.at] = look.shape / max(length, 1e-300)
    log_f = np.log([look.near for look in looks])
    return [parts_of_others(log_f, every[:, look.at], number) for number, look in enumerate(looks)]


def _scale(look: Expected, shape: FloatArray) -> float:
    """Modal scale factor: by it a shape comes nearest to what is expected (least squares)."""
    seen = np.isfinite(shape[look.at])
    own = shape[look.at][seen]
    length = float(own @ own)
    return float(look.shape[seen] @ own) / length if length > 0 else np.nan
