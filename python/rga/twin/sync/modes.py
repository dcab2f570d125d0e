"""The monitor over natural frequencies: are they what they were, whatever was not found?"""

from dataclasses import dataclass

import numpy as np
from threadpoolctl import threadpool_limits

from rga.arrays import BoolArray, FloatArray
from rga.detection import Alarm, SyncMonitor
from rga.errors import InputError
from rga.model.schema import Model
from rga.quantities import counted
from rga.records.modal.record import ModalRecord
from rga.simulation.modal.simulator import ModalSimulator
from rga.simulation.modal.units import check_units
from rga.simulation.modal.windows import NONE, named_modes
from rga.twin.sync.context_courses import ContextCourses, outside, without_courses
from rga.twin.sync.protocol import OutOfSync, listed


@dataclass(frozen=True)
class WatchedModes:
    """Natural frequencies, window by window, and the alarm that they raise.

    Attributes:
        modes: names, in the order of the model.
        time: of the windows as the record writes it.
        left: ln f less its level and what follows contexts [-], float[windows, modes]; NaN where a
            mode was not found or is not judged.
        baseline: windows that say what is usual, the first ones.
        alarm: that stands at the end; None: nothing has changed that the monitor can see.
        unwatched: modes that are not watched, and why.
        warnings: windows and entries that were left out, and reasons why alarms may come without a
            change.
    """

    modes: tuple[str, ...]
    time: tuple[str | float, ...]
    left: FloatArray
    baseline: int
    alarm: OutOfSync | None
    unwatched: dict[str, str]
    warnings: tuple[str, ...]

    @property
    def told(self) -> tuple[str, ...]:
        """The alarm, if there is one, and the warnings."""
        return self.warnings if self.alarm is None else (self.alarm.words, *self.warnings)


def watch_modes(
    model: Model, record: ModalRecord, baseline: int, *, arl0: float = 10_000.0, seed: int = 0
) -> WatchedModes:
    """Watch the natural frequencies of a modal record.

    In every window modes are known by their shapes, never by their order; windows of which another
    pairing is nearly as probable are left out. What contexts in the record do to each frequency is
    learned from the baseline, mode by mode, from the windows in which it was found: none has to
    hold all of them. What is left is watched by a `SyncMonitor`. Windows under contexts that the
    baseline has not seen are not judged.

    Args:
        model: with the modes that are expected.
        record: of its structure.
        baseline: windows that say what is usual, the first ones.
        arl0: windows between false alarms, on average.
        seed: of the simulation of thresholds.

    Raises:
        InputError: the model expects no modes, the baseline is longer than the record or tells
            enough of no mode, or `arl0` is impossible.

    >>> import rga
    >>> from rga.model.schema import ExpectedMode
    >>> mast = rga.ModelBuilder("mast").add_material("steel", "S355").add_section("tube", "HEB 200")
    >>> mast = mast.add_node("foot").add_node("head", z="6 m").support("foot", "fixed")
    >>> mast = mast.add_member("foot", "head", "tube", kind="frame").mass("head", "500 kg").build()
    >>> modes = {"sway": ExpectedMode(near=1.588), "nod": ExpectedMode(near=2.678)}
    >>> mast = mast.model_copy(update={"modes": modes})
    >>> frequencies = np.tile([1.588, 2.678], (200, 1))  # [Hz], in each window
    >>> frequencies *= 1 + 0.002 * np.random.default_rng(0).standard_normal((200, 2))
    >>> frequencies[160:] *= 0.97
    >>> found = [{"Fn": window} for window in frequencies]
    >>> record = rga.modal_record(found, mast, [], time=[600.0 * k for k in range(200)])
    >>> watch_modes(mast, record, 100).alarm.words
    'out of sync: a step since 96000.0: sway -2.9 %, nod -3.1 %'
    """
    simulator = ModalSimulator(model)
    named = named_modes(record, model, simulator.expected)
    check_units(named, record, simulator.expected, model)
    windows = len(named.time)
    if not 0 < baseline < windows:
        raise InputError(
            f"{counted(baseline, 'window')} are to say what is usual, and the record has {windows}",
            "setting calibration_rows",
            "give fewer, so that some are left to be watched, or a longer record",
        )
    of_entry = record.windows
    sure = (named.mode >= 0) & ~np.isin(of_entry, named.doubtful)
    log_f = np.full((windows, len(simulator.expected)), np.nan)
    log_f[of_entry[sure], named.mode[sure]] = np.log(record.frequency[sure])
    contexts = {
        name: np.array([column[of_entry == one][0] for one in range(windows)])
        for name, column in record.contexts.items()
    }
    known = np.isfinite(log_f[:baseline]).sum(axis=0)
    usual = {name: column[:baseline] for name, column in contexts.items()}
    courses = ContextCourses.of(usual, int(np.median(known[known > 0])) if known.any() else 0)
    columns = courses.columns(contexts, windows)
    left = without_courses(columns, log_f, baseline)
    modes = tuple(simulator.expected)
    learned = left[:baseline]
    with threadpool_limits(1):  # the same bits, however many there are
        monitor = SyncMonitor(learned, arl0=arl0, seed=seed, names=modes, fitted=courses.fitted)
        monitor.update_many(left[baseline:])
    time = tuple(record.time_label(float(one)) for one in named.time)
    raised = monitor.alarm
    alarm = None if raised is None else _out_of_sync(raised, left[baseline:], modes, time)
    unwatched = {modes[one]: why for one, why in monitor.unwatched.items()}
    told = [f"mode {name} is not watched: {why}" for name, why in unwatched.items()]
    told += _left_out(
        len(named.doubtful), outside(columns), int((named.mode == NONE).sum()), courses
    )
    return WatchedModes(modes, time, left, baseline, alarm, unwatched, (*told, *monitor.warnings))


def _out_of_sync(
    alarm: Alarm, left: FloatArray, modes: tuple[str, ...], time: tuple[str | float, ...]
) -> OutOfSync:
    """An alarm in windows of the record, with what has become of the frequencies.

    Args:
        alarm: by the windows behind the baseline.
        left: of these, float[windows, modes].
        modes: their names.
        time: of all windows.
    """
    baseline, changes = len(time) - len(left), []
    for mode, change in zip(alarm.sensors, alarm.change, strict=True):
        if alarm.kind == "variance":
            changes.append(f"{modes[mode]} scatters {change:.2g} times as much")
            continue
        # The monitor cuts what is larger than it has seen; frequencies themselves do not.
        by = np.nanmedian(left[alarm.since :, mode]) if alarm.kind == "step" else change
        changes.append(f"{modes[mode]} {100 * np.expm1(by):+.2g} %")
    since = baseline + alarm.since
    words = f"out of sync: {alarm.looks} since {time[since]}: {listed(changes)}"
    sensors = tuple(modes[one] for one in alarm.sensors)
    return OutOfSync(baseline + alarm.row, since, sensors, words)


def _left_out(
    doubtful: int, outside: BoolArray, unnamed: int, courses: ContextCourses
) -> list[str]:
    told = []
    if doubtful:
        told.append(
            f"{counted(doubtful, 'window')} left out of the watch: another pairing of the modes is "
            "nearly as probable"
        )
    if outside.any():
        ranges = (f"{name} {low:g} to {high:g}" for name, (low, high) in courses.ranges.items())
        told.append(
            f"{counted(int(outside.sum()), 'window')} not judged by the watch: what says what is "
            f"usual has seen {', '.join(ranges)} alone"
        )
    if unnamed:
        told.append(f"{counted(unnamed, 'mode')} of the record none of those expected")
    return told
