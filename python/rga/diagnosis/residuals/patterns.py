"""Structure that is left: patterns that many sensors share and no cause explains.

What sensors share, row by row, beyond loads, contexts and scatter shows as correlation between
their innovations. The largest eigenvalue of that correlation is compared with what as many rows of
independent noise give (Marchenko and Pastur 1967 for its edge, a margin for its scatter).
"""

from collections.abc import Collection, Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.noise.unexplainable import unexplainable
from rga.diagnosis.residuals.curvature import curves
from rga.diagnosis.residuals.slopes import bends
from rga.diagnosis.search.linearised import Problem, load_basis, pose
from rga.findings.criteria.residuals import StructureCriteria
from rga.model.effect import Values

#: rows over which patterns are looked for together, and pieces of that length that are needed
WIDTHS, LEAST_PIECES = (1, 8), 20


@dataclass(frozen=True)
class Pattern:
    """A pattern over the sensors that varies for reasons unknown.

    Attributes:
        direction: over the sensors, in their units, float[sensors].
        share: of the variance of the innovations [-].
    """

    direction: FloatArray
    share: float


@dataclass(frozen=True)
class Leftover:
    """A pattern of unknown origin, drawn out in time.

    Attributes:
        pattern: over the sensors, root mean square over the noise of each [-], float[sensors];
            the sign is that of a positive amplitude.
        amplitude: float[rows], scaled to a root mean square of one [-].
        follows: what the amplitude goes with, in words.
        drivers: contexts with the rank correlation of the amplitude with each, or with its
            distance from its middle or its rate where that is stronger, the strongest first.
    """

    pattern: FloatArray
    amplitude: FloatArray
    follows: str
    drivers: dict[str, float]


def with_leftovers(problem: Problem) -> Problem:
    """The problem with the patterns that it leaves added to the covariance."""
    for _ in range(problem.criteria.structure.most_patterns):
        pattern = shared_pattern(problem)
        if pattern is None:
            break
        factors = np.column_stack([problem.factors, pattern.direction])
        problem = pose(problem.simulator, problem.data, problem, factors)
    return problem


def shared_pattern(problem: Problem) -> Pattern | None:
    """The strongest pattern that the sensors still share, or None where there is none."""
    white, seen = innovations(problem)
    working = seen.sum(0) > 0.5 * len(seen)
    if working.sum() < 3:
        return None
    noise = problem.noise
    best: Pattern | None = None
    for width in WIDTHS:
        columns = _averaged(white[:, working], seen[:, working], width)
        rows, sensors = columns.shape
        if rows < LEAST_PIECES:
            break
        scale = np.sqrt((columns**2).mean(0))
        # A channel that follows a context has little left, all of it by what the others show.
        largest = np.linalg.norm(columns / np.maximum(scale, 1.0), 2) ** 2 / rows
        edge = (1 + np.sqrt(sensors / rows)) ** 2
        if largest <= problem.criteria.structure.pattern_margin * edge:
            continue
        columns = columns / np.maximum(scale, 1e-12)
        values, vectors = np.linalg.eigh(columns.T @ columns / rows)
        # What moves slowly is small in the innovations of noise with a memory.
        slow = np.sqrt((1 + noise.phi) / (1 - noise.phi) / width) if width > 1 else 1.0
        size = np.sqrt(values[-1]) * noise.sigma * slow
        direction = np.zeros(len(working))
        direction[working] = vectors[:, -1] * size[working]
        found = Pattern(direction, float((values[-1] - 1) / sensors))
        if best is None or found.share > best.share:
            best = found
    return best


def _averaged(white: FloatArray, seen: BoolArray, width: int) -> FloatArray:
    """Innovations put together over so many rows, of variance one, float[pieces, sensors]."""
    pieces = len(white) // width
    few = white[: pieces * width].reshape(pieces, width, -1).sum(1)
    count = seen[: pieces * width].reshape(pieces, width, -1).sum(1)
    return np.asarray(few / np.sqrt(np.maximum(count, 1)))


def innovations(problem: Problem) -> tuple[FloatArray, BoolArray]:
    """What is new in every row, whitened, beyond what any linear structure could explain.

    Returns:
        float[rows, sensors], and bool[rows, sensors] where there is one.
    """
    data = problem.data
    residual = problem.residual(problem.simulated)
    left = unexplainable(residual, data.observed, load_basis(problem.simulator, data))
    rows = problem.covariance.rows
    error = rows.context_error(left)
    left = left - np.einsum("tsi,ti->ts", rows.context_jacobian, error)
    return rows.whiten(left.T).T, data.observed


def share_left(problem: Problem) -> float:
    """Share of the innovations' variance that unexplained patterns take [-]."""
    variance = problem.noise.sigma**2
    spread = problem.noise.context_sigma[
        len(problem.noise.context_sigma) - problem.factors.shape[1] :
    ]
    patterns = ((problem.factors * spread) ** 2).sum(1)
    return float(np.mean(patterns / (patterns + variance)))


def _errors(problem: Problem) -> FloatArray:
    """Errors of the contexts and amplitudes of the patterns, float[rows, contexts + patterns]."""
    residual = problem.residual(problem.simulated)
    estimate = problem.covariance.scatter_estimate(residual)
    scatter = problem.covariance.scatter.at(estimate)
    return problem.covariance.rows.context_error(residual - scatter)


def known_contexts(problem: Problem, measured: Collection[str]) -> Values:
    """The contexts that were measured or are a line in time, float[rows] each."""
    belief = problem.data.belief
    names = sorted({*measured, *belief.lines} & belief.table.keys())
    return {name: belief.table[name] for name in names}


def leftovers(problem: Problem, contexts: Values) -> list[Leftover]:
    """The patterns of unknown origin with what they follow.

    Args:
        problem: at the end of a diagnosis.
        contexts: that the amplitude may follow, float[rows] each.
    """
    error, criteria = _errors(problem), problem.criteria.structure
    first = error.shape[1] - problem.factors.shape[1]
    found = []
    for number, direction in enumerate(problem.factors.T):
        amplitude = error[:, first + number]
        scale = max(float(np.sqrt((amplitude**2).mean())), 1e-300)
        drivers = _drivers(amplitude, problem.data.time, contexts)
        found.append(
            Leftover(
                pattern=direction * scale / problem.noise.sigma,
                amplitude=amplitude / scale,
                follows=_follows(amplitude, problem.data.time, drivers, criteria),
                drivers=_by_context(drivers),
            )
        )
    return found


def nonlinear(problem: Problem) -> list[str]:
    """In words: responses that are not in proportion."""
    curved = [f"the response to {one.context} bends with {one.by}" for one in bends(problem)]
    return [*curved, *(one.words for one in curves(problem))]


def in_words(problem: Problem, contexts: Values, curved: Sequence[str] = ()) -> str:
    """What is left: patterns with what they follow, and the scatter that had to be assumed.

    Args:
        problem: at the end of a diagnosis.
        contexts: that a pattern may follow, float[rows] each.
        curved: responses that are not in proportion, in words.
    """
    members, gains = 100 * problem.levels[0], 100 * problem.levels[1]
    chance = f"single members and channels are off by chance ({members:.1f} % and {gains:.1f} %)"
    scatter = "; ".join([*curved, chance])
    if problem.factors.shape[1] == 0:
        return f"nothing that varies in common from row to row; {scatter}"
    patterns = []
    for one in leftovers(problem, contexts):
        strongest = np.argsort(-np.abs(one.pattern))[:4]
        signs = (
            f"{problem.data.sensors[k]} ({'+' if one.pattern[k] > 0 else '-'})" for k in strongest
        )
        patterns.append(f"a pattern of {', '.join(signs)} that {one.follows}")
    return f"{'; '.join(patterns)}; {scatter}"


def _drivers(
    amplitude: FloatArray, time: FloatArray, contexts: Values
) -> dict[tuple[str, str], float]:
    """Rank correlation of an amplitude with each context, by the context and the way of it."""
    drivers = {}
    for name, column in contexts.items():
        if np.ptp(column) > 0:
            drivers[name, "{}"] = column
            drivers[name, "the distance of {} from its middle"] = np.abs(column - np.median(column))
        rate = np.gradient(column, time)
        if np.ptp(rate) > 1e-6 * np.abs(rate).max():
            drivers[name, "the rate of {}, in a loop: a lag, or friction"] = rate
    return {
        way: abs(float(scipy.stats.spearmanr(column, amplitude)[0]))
        for way, column in drivers.items()
    }


def _by_context(drivers: dict[tuple[str, str], float]) -> dict[str, float]:
    strongest: dict[str, float] = {}
    for (name, _), size in drivers.items():
        strongest[name] = max(size, strongest.get(name, 0.0))
    return dict(sorted(strongest.items(), key=lambda one: -one[1]))


def _follows(
    amplitude: FloatArray,
    time: FloatArray,
    drivers: dict[tuple[str, str], float],
    criteria: StructureCriteria,
) -> str:
    """What an amplitude goes with: a context by rank correlation, else a frequency, else time."""
    best = max(drivers, key=lambda way: drivers[way], default=None)
    if best is not None and drivers[best] > criteria.follows:
        name, way = best
        return f"goes with {way.format(name)} (rank correlation {drivers[best]:.2f})"
    centred = amplitude - amplitude.mean()
    period, power = _period(centred, time)
    if power > criteria.swings:
        return f"swings with a period of {period:.3g} s, as a static model cannot"
    memory = float((centred[1:] * centred[:-1]).sum() / max((centred**2).sum(), 1e-300))
    if memory > criteria.follows:
        return f"moves with memory ({memory:.2f} from row to row) and with no context"
    return "follows no context and changes from row to row"


def _period(amplitude: FloatArray, time: FloatArray) -> tuple[float, float]:
    """Period of the strongest oscillation [s], and its share of the variance."""
    # Slow to load, and few records come here.
    from scipy.signal import lombscargle

    span, step = float(np.ptp(time)), float(np.median(np.diff(time)))
    frequencies = np.arange(3, max(4, int(span / step / 3))) / span
    power = lombscargle(time, amplitude, 2 * np.pi * frequencies, normalize=True)
    strongest = int(np.argmax(power))
    return float(1 / frequencies[strongest]), float(power[strongest])
