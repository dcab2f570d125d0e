"""What the paper's rule and the monitor cost: rows a second, beside memory and other packages.

What a row costs from Rust, `cargo bench -p rga-detect --bench gaussian_window` shows: `update`
beside `read`.
"""

from collections.abc import Callable
from functools import partial
from itertools import cycle

import numpy as np
from scipy.signal import lfilter

from rga.arrays import FloatArray
from rga.detection import GaussianWindow
from rga.detection.baseline.baseline_model import Reference
from rga.detection.monitor import ROWS_KEPT
from rga.detection.statistic import STATISTICS
from rga_bench.detection.windows import Bottleneck, River
from rga_bench.installed import present
from rga_bench.measurement import Measurement
from rga_bench.timing import shortest

SENSORS, WINDOW, Z = 84, 200, 3.0
#: of rows that are read from memory, beyond the caches
BYTES = 2**27
#: of a call, in rows: short enough to find a moment without other work
CALL = 8192
#: rows behind the first window that slow peers take
FEW = 50
#: seconds that a row may take from Python, beside reading it
MOST = 1e-6
#: of a monitor
BASELINE = 2000
MONITOR = f"Monitor, {SENSORS} sensors"
CASE = f"Gaussian window, {SENSORS} sensors, W = {WINDOW}"


def throughput(seconds: float, seed: int = 0, size: int = BYTES) -> list[Measurement]:
    """Figures of the window, on one core.

    Args:
        seconds: that a figure is measured for.
        seed: of the rows.
        size: bytes of the rows that calls take in turn.

    Raises:
        ArithmeticError: a peer decides otherwise.
    """
    draw = np.random.default_rng(seed)
    calls = max(1, size // (8 * SENSORS * CALL))
    rows = draw.standard_normal((calls * CALL, SENSORS)) ** 2
    window, source = GaussianWindow(SENSORS, WINDOW, Z), rows.ravel()
    parts = cycle(np.split(rows, calls))
    single = list(rows[:CALL])

    def row_by_row() -> None:
        for row in single:
            window.update(row)

    many, one, read = shortest(
        [lambda: window.update_many(next(parts)), row_by_row, lambda: source @ source],
        3.0 * seconds,
    )
    bandwidth = source.nbytes / read
    taken = 8 * SENSORS * CALL / many
    beyond = one / CALL - 8 * SENSORS / bandwidth
    rate = Measurement(CASE, "update_many", SENSORS * CALL / many, "/s")
    return [
        *monitor(rows, bandwidth, seconds, draw),
        Measurement(CASE, "update_many, rows read", taken / 1e9, "GB/s").beside(
            "NumPy, scalar product", bandwidth / 1e9, 0.4
        ),
        Measurement(CASE, "update of a row, beyond reading it", beyond, "s").beside(
            "most", MOST, 1.0
        ),
        rate.beside("river GaussianScorer", river(rows[: WINDOW + FEW], seconds), 1000.0),
        rate.beside("bottleneck move_mean, move_std", bottleneck(rows, seconds), 8.0),
    ]


def monitor(
    rows: FloatArray, bandwidth: float, seconds: float, draw: np.random.Generator
) -> list[Measurement]:
    """Rows that the monitor reads in a second, beside memory [bytes/s].

    Its reference is learned from white noise, and from noise that remembers and that sensors
    share, which takes a product with a matrix for each row.

    Args:
        rows: float[n, SENSORS].
        bandwidth: bytes read by a scalar product [1/s].
        seconds: that a figure is measured for.
        draw: of the baselines.
    """
    white = draw.standard_normal((BASELINE, SENSORS))
    shared = lfilter([1.0], [1.0, -0.5], white + draw.standard_normal((BASELINE, 1)), axis=0)
    never = np.full(len(STATISTICS), np.inf)
    plain, mixing = (
        Reference.learn(baseline).statistics(never, ROWS_KEPT) for baseline in (white, shared)
    )
    parts = cycle(np.split(rows, len(rows) // CALL))
    taken = shortest(
        [lambda: plain.update_many(next(parts)), lambda: mixing.update_many(next(parts))],
        2.0 * seconds,
    )
    rates = [8 * SENSORS * CALL / one / 1e9 for one in taken]
    peer = ("NumPy, scalar product", bandwidth / 1e9)
    return [
        Measurement(MONITOR, "update_many, white noise", rates[0], "GB/s").beside(*peer, 0.1),
        Measurement(
            MONITOR, "update_many, noise with memory and in common", rates[1], "GB/s"
        ).beside(*peer),
    ]


def river(rows: FloatArray, seconds: float) -> float | None:
    """Values that river tests in a second; nothing where it is not installed."""
    peer = present(lambda: River(WINDOW, Z))
    if peer is None:
        return None
    agree("river", peer.alarms, rows)
    (taken,) = shortest([partial(peer.alarms, rows)], seconds, turns=1)
    return rows.size / taken


def bottleneck(rows: FloatArray, seconds: float) -> float | None:
    """Values that bottleneck tests in a second; nothing where it is not installed."""
    peer = present(lambda: Bottleneck(WINDOW, Z))
    if peer is None:
        return None
    call = np.asfortranarray(rows[: WINDOW + peer.rows])
    agree("bottleneck", peer.alarms, call)
    (taken,) = shortest([partial(peer.alarms, call)], seconds)
    return SENSORS * peer.rows / taken


def agree(name: str, alarms: Callable[[FloatArray], object], rows: FloatArray) -> None:
    """Refuses a peer whose decisions are not those of `GaussianWindow`.

    Raises:
        ArithmeticError: with the number of decisions that differ.
    """
    ours = GaussianWindow(SENSORS, WINDOW, Z).update_many(rows)[WINDOW:]
    differ = int((np.asarray(alarms(rows)) != ours).sum())
    if differ:
        raise ArithmeticError(f"{name} decides {differ} of {ours.size} values otherwise")
