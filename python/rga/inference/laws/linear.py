"""A robust line through estimates that may be grossly off, or off by a whole wagon."""

from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: degrees of freedom of the errors: a gross error pulls no more than a small one
FREEDOM = 2.0
#: probability that a row says nothing true
NONSENSE = 0.05
#: rows that the starts are compared on, and the line is fitted to, at most
FEW, MANY = 200, 2000
LEVELS, RATES, STARTS = 60, 121, 6
SWEEPS = 100


def fit_line(
    time: FloatArray,
    value: FloatArray,
    information: FloatArray,
    share: FloatArray,
    span: tuple[float, float],
    rate: tuple[float, float] | None,
    reversed_: NDArray[np.bool_] | None = None,
) -> tuple[FloatArray, FloatArray]:
    """The most plausible line through candidates of every row.

    A row is a mixture of Student's t about its candidates and of nonsense evenly over the range;
    the line is found by expectation and maximisation from several starts.

    Args:
        time: float[n].
        value: candidates, float[n, modes].
        information: one over the variance of each, float[n, modes]; zero where there is none.
        share: probability of each, float[n, modes].
        span: range of the level, its prior.
        rate: range of the slope; None: a constant.
        reversed_: bool[modes], candidates that belong to falling lines, the others to rising ones.

    Returns:
        The line and its standard deviation, float[n] each.
    """
    informative = np.flatnonzero((information > 0).any(1))
    clock = time - time[informative].mean() if len(informative) else time - time.mean()
    width = span[1] - span[0]
    centre, variance = [sum(span) / 2], [width**2 / 12]
    if rate is not None:
        centre.append(sum(rate) / 2)
        variance.append((rate[1] - rate[0]) ** 2 / 12)
    basis = np.column_stack([np.ones(len(time)), clock])[:, : len(centre)]
    rows = _Rows(
        basis[informative], value[informative], information[informative], share[informative], width,
        np.array(centre), 1.0 / np.array(variance), rate, reversed_,
    )  # fmt: skip
    if len(informative) == 0:
        covariance = np.diag(variance)
        line = rows.centre
    else:
        few, more = rows.thinned(FEW), rows.thinned(MANY)
        found = np.array([few.climb(start) for start in few.starts()])
        line = more.climb(found[int(np.argmin(more.costs(found)))])
        covariance = rows.covariance(line)
    spread = np.sqrt(np.einsum("ni,ij,nj->n", basis, covariance, basis))
    return np.asarray(basis @ line), np.asarray(spread)


@dataclass(frozen=True)
class _Rows:
    basis: FloatArray
    value: FloatArray
    information: FloatArray
    share: FloatArray
    width: float
    centre: FloatArray
    precision: FloatArray
    rate: tuple[float, float] | None
    reversed: NDArray[np.bool_] | None

    def costs(self, lines: FloatArray) -> FloatArray:
        """Minus the log likelihood of each line, float[lines]."""
        likelihood = self._likelihood(lines).sum(2) + NONSENSE / self.width
        prior = 0.5 * ((lines - self.centre) ** 2 * self.precision).sum(1)
        return np.asarray(prior - np.log(likelihood).sum(1))

    def thinned(self, count: int) -> "_Rows":
        """At most so many of the rows, evenly spread."""
        kept = np.unique(np.linspace(0, len(self.basis) - 1, count).astype(int))
        return replace(
            self,
            basis=self.basis[kept],
            value=self.value[kept],
            information=self.information[kept],
            share=self.share[kept],
        )

    def starts(self) -> list[FloatArray]:
        """The best lines of a grid of slopes, each through one of the candidates."""
        sharp = np.argsort(-(self.information * self.share).ravel(), kind="stable")[: 4 * LEVELS]
        anchor = sharp[:: max(1, len(sharp) // LEVELS)]
        clock = self.basis[anchor // self.value.shape[1], -1]
        lines = []
        for slope in np.zeros(1) if self.rate is None else np.linspace(*self.rate, RATES):
            level = self.value.ravel()[anchor] - slope * clock
            some = np.column_stack([level, np.full(len(level), slope)])[:, : len(self.centre)]
            costs = self.costs(some)
            lines.append((float(costs.min()), some[int(np.argmin(costs))]))
        lines.sort(key=lambda one: one[0])
        return [line for _, line in lines[:STARTS]]

    def climb(self, line: FloatArray) -> FloatArray:
        """The nearest most plausible line."""
        for _ in range(SWEEPS):
            before = line
            weights = self._weights(line)
            line = self._solve(weights)
            if self.rate is not None and not self.rate[0] <= line[1] <= self.rate[1]:
                slope = float(np.clip(line[1], *self.rate))
                left = (weights * (self.value - slope * self.basis[:, 1:])).sum()
                total = weights.sum() + self.precision[0]
                level = (left + self.precision[0] * self.centre[0]) / total
                line = np.array([level, slope])
            if np.allclose(line, before, rtol=1e-10, atol=1e-12 * self.width):
                break
        return line

    def covariance(self, line: FloatArray) -> FloatArray:
        """Of the line; errors that resemble their neighbours count for fewer."""
        weights = self._weights(line)
        of_row = weights.sum(1)
        meant = (weights * self.value).sum(1) / np.maximum(of_row, 1e-300)
        left = (meant - self.basis @ line) * np.sqrt(of_row)
        power = max(float(left @ left), 1e-300)
        memory = float(np.clip(left[1:] @ left[:-1] / power, 0.0, 0.98))
        size = max(1.0, power / len(left)) * (1.0 + memory) / (1.0 - memory)
        normal = (self.basis * (of_row / size)[:, None]).T @ self.basis
        return np.linalg.inv(normal + np.diag(self.precision))

    def _solve(self, weights: FloatArray) -> FloatArray:
        normal = (self.basis * weights.sum(1)[:, None]).T @ self.basis + np.diag(self.precision)
        moment = self.basis.T @ (weights * self.value).sum(1) + self.precision * self.centre
        return np.linalg.solve(normal, moment)

    def _likelihood(self, lines: FloatArray) -> FloatArray:
        """Of each candidate under each line, float[lines, rows, modes]."""
        off = self.value - (lines @ self.basis.T)[..., None]
        bell = 1.0 + off**2 * self.information / FREEDOM
        height = np.where(
            self.information > 0, np.sqrt(self.information) / np.sqrt(8.0), 1.0 / self.width
        )
        each = self.share * height * bell ** (-0.5 * (FREEDOM + 1.0))
        if self.reversed is not None and self.rate is not None:
            each = each * (self.reversed == (lines[:, 1:] < 0))[:, None]
        return np.asarray(each)

    def _weights(self, line: FloatArray) -> FloatArray:
        """Information of each candidate that the line is to follow, float[rows, modes]."""
        each = self._likelihood(line[None])[0]
        meant = each / (each.sum(1, keepdims=True) + NONSENSE / self.width)
        off = self.value - (self.basis @ line)[:, None]
        pull = (FREEDOM + 1.0) / (FREEDOM + off**2 * self.information)
        return np.asarray(meant * pull * self.information)
