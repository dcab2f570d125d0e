"""Modes of a structure that wind and traffic move, window by window, by pyOMA2.

Stochastic subspace identification from covariances (SSI-cov; Peeters and De Roeck, Reference-based
stochastic subspace identification for output-only modal analysis, Mechanical Systems and Signal
Processing 13, 1999) with many orders. Poles that pyOMA2 calls stable from order to order and that
are alike in frequency and shape are a mode, where enough orders have them.
"""

import logging
from collections.abc import Sequence
from contextlib import redirect_stderr
from dataclasses import dataclass
from io import StringIO
from pathlib import Path

import numpy as np
from scipy import signal

from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.lazy import needing_extras
from rga.records.modal.columns import DAMPING, DURATION, FREQUENCY, TIME
from rga.records.modal.decay_files import Decay
from rga.records.modal.formats.entries import table_of_entries
from rga.records.modal.poles import alike_poles
from rga.records.record import time_label
from rga.records.table import Table

#: samples that are kept of a period of the highest frequency
PER_PERIOD = 3
#: block rows, rows of all sensors in the Hankel matrix at most, and orders
ROWS, TALLEST, FEWEST, ORDERS = 40, 1200, 10, 60
#: samples in a block row of which anything is found
LEAST = 20
#: how poles may differ from order to order: frequency, damping and 1 - MAC; most damping, and least
#: collinearity and greatest deviation of phases
STABLE = {"err_fn": 0.01, "err_xi": 0.1, "err_phi": 0.02}
HARD = {"xi_max": 0.1, "mpc_lim": 0.7, "mpd_lim": 0.3, "CoV_max": 0.2}


@dataclass(frozen=True)
class OperationalMode:
    """A mode found in a window.

    Attributes:
        frequency: [Hz].
        damping: share of the critical one.
        shape: complex[sensors], to any scale.
        found: share of the orders that have it.
    """

    frequency: float
    damping: float
    shape: np.ndarray
    found: float


def operational_modes(motion: FloatArray, step: float, highest: float) -> list[OperationalMode]:
    """The modes in a window of readings, the lowest first.

    Args:
        motion: what sensors of one kind read, each of which moves, float[samples, sensors].
        step: between samples [s].
        highest: frequency that is looked for [Hz].

    Raises:
        InputError: samples are too few or too far apart.
        MissingPackageError: pyOMA2 is not installed.
    """
    if not 0 < PER_PERIOD * highest * step <= 1.5:
        raise InputError(
            f"samples every {step:g} s do not show frequencies up to {highest:g} Hz",
            "highest",
            f"look for frequencies up to {1.5 / (PER_PERIOD * step):.3g} Hz",
        )
    of_each = int(max(1, 1.0 / (PER_PERIOD * highest * step)))
    rows = max(FEWEST, min(ROWS, TALLEST // motion.shape[1]))
    if len(motion) < of_each * rows * LEAST:
        raise InputError(
            f"a window lasts {len(motion) * step:g} s",
            f"with frequencies up to {highest:g} Hz",
            f"give windows of {of_each * rows * LEAST * step:.3g} s at least",
        )
    motion = signal.detrend(motion, axis=0)
    if of_each > 1:
        motion = signal.decimate(motion, of_each, n=20 * of_each, ftype="fir", axis=0)
    frequency, damping, shape, order, orders = _stable_poles(motion, step * of_each, rows)
    kept = frequency < highest
    return _alike(frequency[kept], damping[kept], shape[kept], order[kept], orders)


def _stable_poles(
    motion: FloatArray, step: float, rows: int
) -> tuple[FloatArray, FloatArray, np.ndarray, IntArray, int]:
    """Frequency, damping, shape of length one and order of stable poles; and how many orders."""
    with needing_extras():
        from pyoma2.algorithms import SSI
        from pyoma2.setup import SingleSetup
    most = min(ORDERS, rows * motion.shape[1])
    logging.getLogger("pyoma2").setLevel(logging.WARNING)
    setup = SingleSetup(motion, fs=1.0 / step)
    identification = SSI(name="windows", br=rows, ordmax=most, step=2, sc=STABLE, hc=HARD)
    setup.add_algorithms(identification)
    with redirect_stderr(StringIO()):  # it draws bars of progress
        setup.run_all()
    found = identification.result
    at = np.nonzero((found.Lab == 1) & np.isfinite(found.Fn_poles))
    shapes = found.Phi_poles[at]
    shapes = shapes / np.linalg.norm(shapes, axis=1, keepdims=True)
    return found.Fn_poles[at], found.Xi_poles[at], shapes, at[1], found.Lab.shape[1]


def _alike(
    frequency: FloatArray, damping: FloatArray, shape: np.ndarray, order: IntArray, orders: int
) -> list[OperationalMode]:
    """Modes of poles that are alike in enough orders: those with the most first."""
    modes = []
    for own in alike_poles(frequency, shape, order, orders):
        middle = shape[own][0]
        turned = shape[own] * np.exp(-1j * np.angle(shape[own] @ middle.conj()))[:, None]
        modes.append(
            OperationalMode(
                float(np.median(frequency[own])),
                float(np.median(damping[own])),
                turned.mean(0),
                len(np.unique(order[own])) / orders,
            )
        )
    return sorted(modes, key=lambda one: one.frequency)


def windows_of(measured: Decay, seconds: float) -> list[Decay]:
    """Windows one after the other; what is left at the end is left out.

    Args:
        measured: the whole of it.
        seconds: that each lasts.

    Raises:
        InputError: not one window lasts as long, or one holds no two readings; a reading is
            missing, or a sensor does not move in a window.
    """
    samples = round(seconds / measured.step)
    if samples < 2:
        raise InputError(
            f"a window of {seconds:g} s holds no two readings, one comes every {measured.step:g} s",
            "--minutes",
            "give longer windows, of some minutes",
        )
    count = len(measured.motion) // samples
    if count == 0:
        raise InputError(
            f"the file lasts {measured.duration:g} s",
            f"windows of {seconds:g} s",
            f"give shorter windows: --minutes {measured.duration / 60:.3g} at most",
        )
    half = measured.duration / 2
    windows = [
        Decay(
            measured.motion[at * samples : (at + 1) * samples],
            measured.step,
            measured.points,
            time_label(measured.middle, (at + 0.5) * samples * measured.step - half),
        )
        for at in range(count)
    ]
    for window in windows:
        _check_motion(window)
    return windows


def _check_motion(window: Decay) -> None:
    """Refuse a window in which a reading is missing, or a sensor does not move."""
    for point, readings in zip(window.points, window.motion.T, strict=True):
        where = f"sensor {point!r}, window about {window.middle}"
        missing = int((~np.isfinite(readings)).sum())
        if missing:
            raise InputError(
                f"{missing} of {len(readings)} readings are missing",
                where,
                "give a stretch without gaps by --from and --until, or leave the column out",
            )
        if not np.ptp(readings) > 0:
            raise InputError(
                f"the sensor does not move: it reads {readings[0]:g} all the time",
                where,
                "leave the column out: name the others by --column",
            )


def operational_table(
    windows: Sequence[Decay], modes: Sequence[Sequence[OperationalMode]], path: Path
) -> Table:
    """Modes of windows as a modal record.

    No standard deviation is written: that of windows beside each other is told by themselves.

    Raises:
        InputError: no mode was found.
    """
    found = [(window, one) for window, own in zip(windows, modes, strict=True) for one in own]
    if not found:
        raise InputError("no mode was found in any window", str(path), "give longer windows")
    entries = {
        TIME: [window.middle for window, _ in found],
        DURATION: [window.duration for window, _ in found],
        FREQUENCY: [one.frequency for _, one in found],
        DAMPING: [one.damping for _, one in found],
    }
    shapes = np.array([one.shape for _, one in found])
    return table_of_entries(path, "windows", entries, shapes, windows[0].points)
