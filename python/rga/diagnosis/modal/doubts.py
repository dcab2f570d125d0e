"""In words: why measured modes decide less than they seem to."""

from collections.abc import Mapping, Sequence

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.likelihood import WEATHER, ModalLikelihood, bent_lines
from rga.diagnosis.modal.points.changes import point_changes
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.readings import (
    LEAST_SCATTER,
    REPEATS,
    UNKNOWN_SCATTER,
    ModalReadings,
    context_courses,
    scaled_contexts,
)
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.model import Model
from rga.model.effect import Effect
from rga.numerics.noise_with_memory import MOST_MEMORY
from rga.quantities import counted, duration, short
from rga.records.modal.record import ModalRecord

#: modes without which nothing is said to be right
FEW_MODES = 3
#: share of windows in which something else stands for a mode, that is no chance
UNLIKE = 0.25
#: standard deviations from which on a drift is no chance
SURE = 5.0
#: length of a window beyond which hardly any is meant [s]
LONG_WINDOW = 86_400.0
#: time without a window that is more likely a wrong date [s]
LONG_GAP = 3 * 365.0 * 86_400.0
#: windows by which a structure may be behind its weather
LAGS = 12
#: change of a frequency that no weather makes
BEYOND_WEATHER = 0.1


def thin(readings: ModalReadings, causes: bool) -> list[str]:
    """In words: why so few modes, or modes without shapes, decide nothing."""
    words = []
    if len(readings.modes) < FEW_MODES:
        was = "was" if len(readings.modes) == 1 else "were"
        words.append(
            f"of the modes expected {' and '.join(readings.modes)} alone {was} found, and "
            f"{FEW_MODES} are needed to decide"
        )
    blind = [
        name for name, look in zip(readings.modes, readings.looks, strict=True) if not len(look.at)
    ]
    if causes and blind:
        words.append(
            f"modes {', '.join(blind)} are known by their frequencies alone: which computed modes "
            "they are is a guess, and the causes hang on it"
        )
    return words


def doubts_of_windows(likelihood: ModalLikelihood, causes: Mapping[str, Effect]) -> list[str]:
    """In words: why what was found in windows may not be what it is taken for.

    Args:
        likelihood: of the modes.
        causes: of them.
    """
    return [*doubtful_windows(likelihood.readings), *changing_points(likelihood, causes)]


def doubtful_windows(readings: ModalReadings) -> list[str]:
    """In words: that the names of modes are in doubt in many windows."""
    if not readings.doubtful:
        return []
    words = (
        f"in {readings.doubtful} of {len(readings.time)} windows another pairing of the modes "
        f"found is nearly as probable ({', '.join(readings.in_doubt)})"
    )
    return [words]


def unlike_modes(readings: ModalReadings) -> list[str]:
    """In words: that something else swings where modes are expected, or far from there."""
    told = []
    several = [name for name, share in readings.unlike.items() if share > UNLIKE]
    if several:
        told.append(
            f"where {counted(len(several), 'mode')} ({', '.join(several)}) should be, something "
            f"swings in another shape, in up to {max(readings.unlike.values()):.0%} of the "
            "windows: look for points that are exchanged, turned or named wrongly, or give the "
            "shapes that were measured"
        )
    stray = readings.stray
    if stray is not None and stray.share > UNLIKE:
        one = len(stray.lacking) == 1
        told.append(
            f"{counted(len(stray.lacking), 'mode')} ({', '.join(stray.lacking)}) "
            f"{'is' if one else 'are'} hardly ever found, and what swings at "
            f"{short(stray.frequency)} Hz in {stray.share:.0%} of the windows is none of the modes "
            f"expected: it may be {'that mode' if one else 'one of them'}, moved far. Give a "
            "larger `within`, or add what swings there to the modes of the model"
        )
    return told


def changing_points(likelihood: ModalLikelihood, causes: Mapping[str, Effect]) -> list[str]:
    """In words: that sensors at points read otherwise from some window on."""
    readings, trials = likelihood.readings, likelihood.trials
    points = list(trials.model.points)
    # What is said of a sensor as a whole would hide that it changes.
    of_structure = {name: one for name, one in causes.items() if not one.points_named()}
    found = point_changes(
        readings.shapes_at(points),
        readings.record.windows,
        readings.entries,
        trials.at_points_by_window(of_structure),
    )
    told = [
        f"{points[one.point]} from {readings.label(readings.time[one.window])} on "
        f"({round(one.times, 2) + 0.0:g} times as much)"
        for one in found
    ]
    if not told:
        return []
    words = (
        "sensors read otherwise within the record, where a cause at a point holds for all windows "
        f"(look at those before and behind by themselves): {', '.join(told)}"
    )
    return [words]


def drifting(likelihood: ModalLikelihood, after: Prediction) -> list[str]:
    """In words: frequencies that go on changing, which causes and contexts leave unexplained."""
    readings = likelihood.readings
    time = readings.time - readings.time.mean()
    courses = context_courses(readings.contexts, len(time))
    columns = np.column_stack([np.ones(len(time)), courses.T, time / max(np.ptp(time), 1e-300)])
    found, sizes = [], []
    for mode, name in enumerate(readings.modes):
        off = readings.log_f[:, mode] - after.log_f[:, mode]
        seen = np.isfinite(off)
        if seen.sum() < max(REPEATS, 2 * columns.shape[1]):
            continue
        inverse = np.linalg.pinv(columns[seen])
        amounts = inverse @ off[seen]
        left = off[seen] - columns[seen] @ amounts
        # What is left goes with the window before by as much as it shows.
        kept = float(left[1:] @ left[:-1]) / max(float(left @ left), 1e-300)
        kept = min(max(kept, 0.0), MOST_MEMORY)
        spread = float(left.std() * np.linalg.norm(inverse[-1])) * np.sqrt((1 + kept) / (1 - kept))
        if abs(amounts[-1]) > max(likelihood.level, SURE * spread):
            found.append(name)
            sizes.append(float(amounts[-1]))
    if not found:
        return []
    words = (
        f"frequencies of {counted(len(found), 'mode')} ({', '.join(found)}) drift over the record, "
        f"by up to {np.expm1(max(sizes, key=abs)):+.1%}, and nothing explains it"
    )
    return [words]


def weather(readings: ModalReadings, causes: Sequence[Hypothesis], after: Prediction) -> list[str]:
    """In words: why a small change that begins late may be the weather."""
    late = any(one.onset is not None for one in causes)
    if not late or any(True for _ in scaled_contexts(readings.weather)):
        return []
    moved = float(np.abs(np.expm1(np.ptp(after.log_f, axis=0))).max())
    if moved >= BEYOND_WEATHER:
        return []
    unchanging = _unchanging(readings.weather)
    told = f"{' and '.join(unchanging)} never change" + ("s" if len(unchanging) == 1 else "")
    words = (
        f"what begins late moves no frequency by more than {moved:.1%}, and "
        f"{told if unchanging else 'no temperature stands'} beside the frequencies: it may be the "
        "weather"
    )
    return [words]


def _unchanging(contexts: Mapping[str, FloatArray]) -> dict[str, float]:
    """Contexts that are known in several windows and the same in all, each with its value."""
    known = {name: one[np.isfinite(one)] for name, one in contexts.items()}
    return {name: float(one[0]) for name, one in known.items() if len(one) > 1 and np.ptp(one) == 0}


def lagging(
    likelihood: ModalLikelihood, causes: Sequence[Hypothesis], after: Prediction
) -> list[str]:
    """In words: that weather of some windows before explains as much as what begins late."""
    readings = likelihood.readings
    courses = len(bent_lines(readings.weather, len(readings.time)))
    few = len(readings.time) - LAGS < 2 * (1 + courses)
    if not courses or few or all(one.onset is None for one in causes):
        return []
    explained = _left_by_weather(likelihood, after, 0)
    nothing = likelihood.trials.predict({})
    left = {lag: _left_by_weather(likelihood, nothing, lag) for lag in range(1, LAGS + 1)}
    best = min(left, key=lambda lag: left[lag])
    if left[best] > explained:
        return []
    words = (
        f"{', '.join(readings.weather)} of {counted(best, 'window')} before explains as much as "
        "what begins late: a temperature inside the structure, which lags behind the air, tells "
        "whether it is all of it"
    )
    return [words]


def _left_by_weather(likelihood: ModalLikelihood, prediction: Prediction, lag: int) -> float:
    """What the weather of so many windows before leaves of frequencies, squares by the noise."""
    readings = likelihood.readings
    windows = len(readings.time)
    courses = bent_lines(readings.weather, windows).T
    columns = np.column_stack([np.ones(windows - LAGS), courses[LAGS - lag : windows - lag]])
    off, total = likelihood.frequencies_off(prediction)[LAGS:], 0.0
    for mode, scatter in enumerate(readings.scatter):
        seen = np.isfinite(readings.log_f[LAGS:, mode])
        left = off[seen, mode] - columns[seen] @ (np.linalg.pinv(columns[seen]) @ off[seen, mode])
        total += float(left @ left) / scatter**2
    return total


def following_contexts(
    likelihood: ModalLikelihood, after: Prediction, usual: float = WEATHER
) -> list[str]:
    """In words: that frequencies follow contexts by more than is usual, as a share of them."""
    readings = likelihood.readings
    words = []
    for name, column in readings.weather.items():
        courses = bent_lines({name: column}, len(readings.time)).T
        columns = np.column_stack([np.ones(len(courses)), courses])
        sizes = {}
        for mode, off in zip(readings.modes, (readings.log_f - after.log_f).T, strict=True):
            seen = np.isfinite(off)
            if seen.sum() >= 2 * columns.shape[1]:
                amounts = np.linalg.pinv(columns[seen]) @ off[seen]
                sizes[mode] = float(np.ptp(columns[seen] @ amounts))
        most = max(sizes, key=lambda mode: sizes[mode], default="")
        if sizes and sizes[most] > usual:
            words.append(
                f"frequencies follow {name} by up to {sizes[most]:.1%} over its range ({most}): "
                "that is taken for the weather and for no cause; a group that follows it may be "
                "named where the model has a temperature"
            )
    return words


def following_doubts(likelihood: ModalLikelihood, causes: bool, after: Prediction) -> list[str]:
    """In words: that so much follows contexts that a cause, or none, may be what follows them."""
    return following_contexts(likelihood, after, WEATHER if causes else BEYOND_WEATHER)


def other_freezing(likelihood: ModalLikelihood) -> list[str]:
    """In words: why what follows the temperature may be another part of the structure."""
    if not likelihood.explains_weather:
        return []
    words = (
        "bearings and soil that freeze make frequencies follow the temperature too, and were not "
        "tried: look at these beside what is named"
    )
    return [words]


def warnings_of(model: Model, readings: ModalReadings) -> list[str]:
    """In words: what of the record says less than it could."""
    warnings = list(readings.unclear)
    without = [name for name in model.modes if name not in readings.modes]
    if without:
        warnings.append(f"modes that are in no window: {', '.join(without)}")
    by_frequency = [
        name for name, look in zip(readings.modes, readings.looks, strict=True) if not len(look.at)
    ]
    if by_frequency:
        warnings.append(
            f"paired by frequency only, without a shape: {', '.join(by_frequency)}; what trades "
            "places with another mode passes for what moves"
        )
    assumed = [
        name for name, shown in zip(readings.modes, readings.shown, strict=True) if not shown
    ]
    if assumed:
        warnings.append(
            f"how the frequencies of {', '.join(assumed)} scatter is assumed, as f_sd states it or "
            f"else {100 * UNKNOWN_SCATTER:g} %: they were found in too few windows to show it"
        )
    alike = [
        name
        for name, shown, scatter in zip(
            readings.modes, readings.shown, readings.scatter, strict=True
        )
        if shown and scatter <= LEAST_SCATTER
    ]
    if alike:
        warnings.append(
            f"the frequencies of {', '.join(alike)} hardly differ from one window to the next: "
            "rows that repeat, or were rounded, tell nothing of how they scatter"
        )
    if len(readings.time) >= REPEATS:
        warnings += [
            f"{name} is {value:g} in every window: a column that never changes tells nothing of "
            "what frequencies do by it"
            for name, value in _unchanging(readings.weather).items()
        ]
    if readings.uncovered:
        warnings.append(
            f"left out: {counted(readings.uncovered, 'window')} in which a context is not known"
        )
    if readings.unsure:
        warnings.append(
            f"left out: {counted(readings.unsure, 'window')} in which another pairing of the modes "
            f"found is nearly as probable ({', '.join(readings.in_doubt)})"
        )
    if readings.far_out:
        entries = "entry" if readings.far_out == 1 else "entries"
        warnings.append(
            f"left out: {readings.far_out} {entries} with the shape of a mode and a frequency far "
            "off those of that mode in the windows about it"
        )
    if readings.record.left_out:
        warnings.append(f"columns that are not used: {', '.join(readings.record.left_out)}")
    if readings.unnamed:
        warnings.append(f"{readings.unnamed} entries of the record are none of the modes expected")
    return warnings + odd_entries(model, readings.record)


def odd_entries(model: Model, record: ModalRecord) -> list[str]:
    """In words: what a modal record can hardly mean as it is written."""
    warnings = []
    if twice := record.once().repeated:
        entry = "entry stands" if twice == 1 else "entries stand"
        warnings.append(f"{twice} {entry} in the record more than once: each counts once")
    alone = int((np.isfinite(record.shapes).sum(axis=1) == 1).sum())
    if alone:
        entries = "entry has its shape" if alone == 1 else "entries have their shapes"
        warnings.append(f"{alone} {entries} at a single point: by that all modes look alike")
    longest = float(np.nanmax(record.duration, initial=0.0))
    if longest > LONG_WINDOW:
        length, unit = duration(longest)
        warnings.append(
            f"windows last up to {short(length)} {unit}: what changes within one shows as its mean "
            "alone; durations are in seconds"
        )
    times = np.unique(record.time)
    gap = float(np.diff(times).max(initial=0.0))
    if gap > LONG_GAP:
        length, unit = duration(gap)
        behind = record.time_label(float(times[int(np.diff(times).argmax()) + 1]))
        warnings.append(
            f"nothing was measured for {short(length)} {unit} before {behind}: where that is not "
            "so, look at the clock"
        )
    for name, column in record.contexts.items():
        low, high = model.context[name].range
        far = np.isfinite(column) & ((column < low) | (column > high))
        windows = len(np.unique(record.time[far]))
        if windows:
            warnings.append(
                f"{name} lies outside its range {low:g}..{high:g} in {counted(windows, 'window')}: "
                "check its unit and its zero"
            )
    return warnings


def apart_in_time(modes: FloatArray, record: FloatArray) -> list[str]:
    """In words: that windows of modes and the rows of a record have no time in common.

    Args:
        modes: middles of the windows on the scale of onsets [s], float[windows].
        record: its rows [s], float[rows].

    >>> apart_in_time(np.array([5.0]), np.array([0.0, 10.0]))
    []
    """
    gap = max(record.min() - modes.max(), modes.min() - record.max())
    if gap <= 0.0:
        return []
    length, unit = duration(float(gap))
    words = (
        f"modes and record have no time in common, {short(length)} {unit} lie between them: either "
        "what is wrong was there in both, or one of the two clocks is not right"
    )
    return [words]
