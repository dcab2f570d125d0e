"""Modes that were measured: frequencies window by window, their noise, and shapes."""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from rga.arrays import BoolArray, FloatArray, IntArray
from rga.diagnosis.modal.points.recorded import looks_as_recorded, without_dead_points
from rga.diagnosis.modal.standing import weather
from rga.errors import InputError
from rga.model.effect import Effect
from rga.model.schema import Model
from rga.numerics.lone_values import lone_values
from rga.numerics.noise_with_memory import noise_with_memory
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.expected import FEWEST, Expected, mac
from rga.simulation.modal.looks import unclear_looks
from rga.simulation.modal.simulator import ModalSimulator
from rga.simulation.modal.units import check_units
from rga.simulation.modal.windows import NONE, NamedModes, Stray, named_modes, stray_of

#: scatter of a frequency of which nothing is known: one test repeated gives half to two per cent
UNKNOWN_SCATTER = 0.01
#: least scatter that repeats are believed to show: clocks and the resolution of spectra leave more
LEAST_SCATTER = 2e-4
#: windows that show a scatter by themselves
REPEATS = 8
#: share of windows that are left out where another pairing is nearly as probable; more are a doubt
FEW = 0.1
#: rounds in which shapes, of which each may lack points, are scaled onto their mean
ROUNDS = 20
#: share of its frequency by which a mode may always differ from one window to the next
LONE = 0.005


@dataclass(frozen=True)
class ModalWindows:
    """Windows of time in which modes are looked at.

    Attributes:
        modes: names of those that were found, in the order of the model.
        time: of the windows on the scale of onsets [s], float[windows].
        contexts: of the windows, float[windows] each.
        log_f: logarithms of the frequencies [ln Hz], float[windows, modes]; NaN where not found.
        looks: what each mode looks like: median frequency, and the mean of the measured shapes,
            which has length one; without points where no shape was measured.
    """

    modes: tuple[str, ...]
    time: FloatArray
    contexts: dict[str, FloatArray]
    log_f: FloatArray
    looks: tuple[Expected, ...]


@dataclass(frozen=True)
class ModalReadings(ModalWindows):
    """Modes of a record by name.

    Attributes:
        record: out of which they are.
        weather: contexts that may move modes beside what the model says.
        scatter: of one window beside the others, as a share of the frequency, float[modes].
        shown: whether windows enough show it, bool[modes]; else it is what is stated, or usual.
        memory: correlation of the errors of a window and the next, float[modes].
        shape_noise: what 1 - MAC of the mean shape is by noise, float[modes].
        found: share of the windows in which each mode was found, float[modes].
        doubtful: windows of which another pairing is nearly as probable, where they are many.
        unsure: such windows that are left out, where they are few.
        in_doubt: modes that may be others in such windows.
        unnamed: entries of the record that are none of the modes.
        far_out: that are left out, as their frequency is far off that of the mode about then.
        unlike: of expected modes, share of the windows in which they were not found and something
            else swings about where they are expected.
        stray: what may be a mode that was hardly ever found.
        uncovered: windows left out, as a context is not known then.
        unclear: in words: modes of the model that its points do not see, or do not tell apart.
        cost: of the pairs in all windows, as a negative logarithm of a probability.
        entries: number of the mode of each entry of the record, int[entries]; negative: none.
    """

    record: ModalRecord
    weather: dict[str, FloatArray]
    scatter: FloatArray
    shown: BoolArray
    memory: FloatArray
    shape_noise: FloatArray
    found: FloatArray
    doubtful: int
    unsure: int
    in_doubt: tuple[str, ...]
    unnamed: int
    far_out: int
    unlike: dict[str, float]
    stray: Stray | None
    uncovered: int
    unclear: tuple[str, ...]
    cost: float
    entries: IntArray

    @classmethod
    def of(
        cls,
        model: Model,
        record: ModalRecord,
        changed: Mapping[int, Mapping[str, Expected]] | None = None,
        effects: Sequence[Effect] = (),
    ) -> "ModalReadings":
        """The modes that a model expects, out of a record.

        Args:
            model: with modes.
            record: of its structure; what it holds of points that the model says do not work is
                not looked at.
            changed: what modes look like in windows in which the structure is known to be another
                than in the model, by number of the window among those that are covered.
            effects: beside those of the model, of which some may act on what points record.

        Raises:
            InputError: none was found, the model has no modes, or what drives the structure is
                known in no window.
        """
        simulator = ModalSimulator(model)
        acting = (*model.effects.values(), *effects)
        expected = looks_as_recorded(simulator.expected, acting, model)
        every = len(np.unique(record.time))
        record = _covered(without_dead_points(record, model), simulator.needed, model)
        uncovered = every - len(np.unique(record.time))
        named = named_modes(record, model, expected, changed)
        check_units(named, record, expected, model)
        few = len(named.doubtful) <= FEW * len(named.time)
        unsure = np.isin(record.windows, named.doubtful) & few
        mode = np.where(unsure, NONE, named.mode)
        driving = weather(model, record.contexts)
        standing = [column for name, column in record.contexts.items() if name not in driving]
        far_out = _far_out(record, mode, standing)
        mode = np.where(far_out, NONE, mode)
        names = [name for k, name in enumerate(expected) if (mode == k).any()]
        if not names:
            raise InputError(
                "which mode is which is in doubt in every window",
                f"modes {', '.join(expected)} of model {model.name!r}",
                "give the shapes of the modes at points that tell them apart",
            )
        windows = record.windows
        count = len(named.time)
        numbers = [list(expected).index(name) for name in names]
        log_f = np.full((count, len(names)), np.nan)
        stated = np.full(len(names), np.nan)
        looks, shape_noise = [], np.zeros(len(names))
        points = {name: k for k, name in enumerate(model.points)}
        at = np.array([points[name] for name in record.points], dtype=np.int64)
        for column, number in enumerate(numbers):
            own = np.flatnonzero(mode == number)
            log_f[windows[own], column] = np.log(record.frequency[own])
            sd = record.frequency_sd[own] / record.frequency[own]
            if np.isfinite(sd).any():
                stated[column] = float(np.nanmedian(sd))
            given = expected[names[column]]
            middle = float(np.exp(np.nanmedian(log_f[:, column])))
            seen_by_points = own[:0] if given.unseen else own
            shape, seen, noise = mean_shape(record.shapes[seen_by_points], _reference(given, at))
            looks.append(Expected(middle, given.within, at[seen], shape))
            shape_noise[column] = noise
        contexts = {
            name: np.array([column[windows == one][0] for one in range(count)])
            for name, column in record.contexts.items()
        }
        scatter, shown, memory = _noise(log_f, contexts, stated)
        columns = {number: column for column, number in enumerate(numbers)}
        return cls(
            record=record,
            modes=tuple(names),
            time=record.origin + named.time,
            contexts=contexts,
            weather=weather(model, contexts),
            log_f=log_f,
            scatter=scatter,
            shown=shown,
            memory=memory,
            looks=tuple(looks),
            shape_noise=shape_noise,
            found=np.isfinite(log_f).mean(0),
            doubtful=0 if few else len(named.doubtful),
            unsure=len(np.unique(record.windows[unsure])),
            in_doubt=named.in_doubt,
            unnamed=int((named.mode == NONE).sum()),
            far_out=int(far_out.sum()),
            unlike=_unlike_modes(named, record, expected),
            stray=stray_of(named, record, expected),
            uncovered=uncovered,
            unclear=unclear_looks(expected),
            cost=named.cost,
            entries=np.array([columns.get(int(number), -1) for number in mode]),
        )

    def shapes_at(self, points: Sequence[str]) -> FloatArray:
        """Shapes of all entries at points, float[entries, points]; NaN where not measured."""
        own = np.full((len(self.record), len(points)), np.nan)
        own[:, [list(points).index(name) for name in self.record.points]] = self.record.shapes
        return own

    @property
    def names_in_doubt(self) -> bool:
        """Whether modes of some windows may be others, or many were not known by their names."""
        return bool(self.doubtful or self.unsure or self.unnamed > FEW * len(self.time))

    def label(self, moment: float) -> str | float:
        """A time on the scale of onsets [s] as the record writes it."""
        return self.record.time_label(moment - self.record.origin)


def _covered(record: ModalRecord, needed: set[str], model: Model) -> ModalRecord:
    """The windows of which all contexts are known.

    One that drives nothing, and is known in few windows, is not used: what it does to the others is
    free all the same, and would be taken for a cause.
    """
    rare = {
        name: f"{name} (known in fewer than half of the windows)"
        for name, column in record.contexts.items()
        if name not in needed and np.isfinite(column).mean() < 0.5
    }
    if rare:
        contexts = {name: one for name, one in record.contexts.items() if name not in rare}
        left_out = (*record.left_out, *rare.values())
        record = replace(record, contexts=contexts, left_out=left_out)
    known = np.ones(len(record), dtype=bool)
    for name in sorted(record.contexts):
        known &= np.isfinite(record.contexts[name])
        if not known.any():
            raise InputError(
                f"context {name!r} is not known in any window in which the others are",
                f"model {model.name!r}",
                f"give a column {name} beside the frequencies, or a record of the same days",
            )
    return record.entries(known)


def _unlike_modes(
    named: NamedModes, record: ModalRecord, expected: Mapping[str, Expected]
) -> dict[str, float]:
    """Shares of the windows in which modes with shapes were not found, and something is there."""
    windows, shares = record.windows, {}
    for number, (name, look) in enumerate(expected.items()):
        there = np.abs(np.log(record.frequency / look.near)) < look.within
        other = np.setdiff1d(windows[there & (named.mode == NONE)], windows[named.mode == number])
        if len(look.at):
            shares[name] = len(other) / len(named.time)
    return shares


def mean_shape(shapes: FloatArray, reference: FloatArray) -> tuple[FloatArray, IntArray, float]:
    """The mean of measured shapes, each turned and scaled onto the others.

    Args:
        shapes: float[entries, points]; NaN where a point did not measure. One of a single point
            says nothing.
        reference: what they are turned to first, float[points]; NaN where it says nothing.

    Returns:
        The mean, of length one, float[k]; the points where something was measured, int[k]; and
        what 1 - MAC of the mean is by the scatter of the entries. What differs by more between
        entries that lie apart in time than between one and the next is a shape that changes: of
        that no number of entries has a mean that is the shape.

    >>> mean, at, noise = mean_shape(np.array([[0.0, 2.0], [0.0, -2.0]]), np.array([1.0, 1.0]))
    >>> mean.tolist(), at.tolist(), noise
    ([0.0, 1.0], [0, 1], 0.0)
    """
    shapes = shapes[np.isfinite(shapes).sum(1) >= FEWEST]
    seen = np.flatnonzero(np.isfinite(shapes).any(0))
    shapes, reference = shapes[:, seen], reference[seen]
    if not len(shapes) or not np.nan_to_num(shapes).any():
        return np.zeros(0), seen[:0], 0.0
    for _ in range(ROUNDS):
        turned = []
        for one in shapes:
            both = np.isfinite(one) & np.isfinite(reference)
            length = float(one[both] @ one[both])
            along = float(one[both] @ reference[both])
            turned.append(one * (along / length if along and length else np.nan))
        stacked = np.array(turned)
        if not np.isfinite(stacked).any():
            # Nothing of the reference is at these points: the first entry is as good.
            reference = shapes[0]
            continue
        with np.errstate(invalid="ignore"):
            mean = np.nansum(stacked, 0) / np.maximum(np.isfinite(stacked).sum(0), 1)
        reference = np.where(np.isfinite(stacked).any(0), mean, np.nan)
    mean = np.nan_to_num(reference)
    mean = mean / np.linalg.norm(mean)
    off = _unlike(shapes, [mean] * len(shapes))
    if len(off) < 2:
        return mean, seen, 0.0
    noise = float(np.mean(off))
    # Of two entries each has its own noise.
    next_to_each_other = 0.5 * float(np.mean(_unlike(shapes[1:], shapes[:-1]) or [0.0]))
    return mean, seen, noise / (len(off) - 1) + max(noise - next_to_each_other, 0.0)


def _unlike(ones: Iterable[FloatArray], others: Iterable[FloatArray]) -> list[float]:
    """1 - MAC of pairs, at the points that both have."""
    pairs = (
        (one, other, np.isfinite(one) & np.isfinite(other))
        for one, other in zip(ones, others, strict=True)
    )
    return [max(0.0, 1.0 - mac(one[both], other[both])) for one, other, both in pairs if both.any()]


def _reference(given: Expected, at: IntArray) -> FloatArray:
    """What is expected of a mode at the points of a record, float[points]; NaN where nothing."""
    known = dict(zip(given.at.tolist(), given.shape.tolist(), strict=True))
    return np.array([known.get(int(point), np.nan) for point in at])


def _noise(
    log_f: FloatArray, contexts: dict[str, FloatArray], stated: FloatArray
) -> tuple[FloatArray, BoolArray, FloatArray]:
    """Scatter of the frequencies about what contexts do to them, where it shows, and memory."""
    windows, modes = log_f.shape
    columns = np.column_stack([np.ones(windows), context_courses(contexts, windows).T])
    scatter, left = np.zeros(modes), np.full((windows, modes), np.nan)
    for mode in range(modes):
        seen = np.isfinite(log_f[:, mode])
        if seen.sum() < max(REPEATS, 2 * columns.shape[1]):
            known = stated[mode]
            scatter[mode] = known if np.isfinite(known) else UNKNOWN_SCATTER
            continue
        own = columns[seen]
        amounts, *_ = np.linalg.lstsq(own, log_f[seen, mode], rcond=None)
        left[seen, mode] = log_f[seen, mode] - own @ amounts
    # Windows overlap or follow each other alike for all modes, and so does their memory.
    spreads, memory = noise_with_memory(left)
    shown = np.isfinite(spreads)
    scatter[shown] = spreads[shown]
    return np.maximum(scatter, LEAST_SCATTER), shown, memory * shown


def context_courses(contexts: dict[str, FloatArray], windows: int) -> FloatArray:
    """What may follow contexts, a line with a bend in it, over their range: float[k, windows]."""
    courses = []
    for course in scaled_contexts(contexts):
        scaled = course - course.mean()
        courses += [scaled, scaled**2 - (scaled**2).mean(), np.abs(scaled) - np.abs(scaled).mean()]
    return np.array(courses).reshape(len(courses), windows)


def scaled_contexts(contexts: dict[str, FloatArray]) -> Iterator[FloatArray]:
    """Contexts that vary, from zero to one, float[windows] each; the mean where one is missing."""
    for column in contexts.values():
        seen = np.isfinite(column)
        if not seen.any() or np.ptp(column[seen]) == 0:
            continue
        filled = np.where(seen, column, column[seen].mean())
        yield (filled - column[seen].min()) / np.ptp(column[seen])


def _far_out(record: ModalRecord, mode: IntArray, standing: Sequence[FloatArray]) -> BoolArray:
    """Entries whose frequency lies far off that of the same mode about then, bool[entries].

    No structure changes for a window or two: they are another mode, or were found wrongly.

    Args:
        record: with its entries.
        mode: number of the mode of each, int[entries]; negative: none.
        standing: contexts that say what loads stand there, float[entries] each. Windows in which
            others stand are held apart.
    """
    far = np.zeros(len(record), dtype=bool)
    state = np.unique(np.column_stack([mode, *standing]), axis=0, return_inverse=True)[1].ravel()
    order = np.argsort(record.time, kind="stable")
    for one in np.unique(state[mode >= 0]):
        own = order[state[order] == one]
        far[own] = lone_values(np.log(record.frequency[own]), LONE)
    return far
