"""A first guess of contexts, from simulated rows."""

import numpy as np

from rga.arrays import FloatArray
from rga.inference.map.standard_units import EDGE, standard
from rga.inference.rows import Rows
from rga.numerics.decompositions import thin_svd

#: weight of the ridge, as rows
RIDGE = 10.0


class QuadraticGuess:
    """Contexts as quadratic functions of what sensors show together, by ridge regression.

    Where the descent starts decides which of its modes a row ends in: where the crowd is light,
    its position and eccentricity have several. The nearest of a thousand rows in eight dimensions
    is no near one, and a quadratic function through all of them is.

    Args:
        source: simulated rows, without noise.
        noise: standard deviation of each sensor's noise, float[sensors].
        ranges: smallest and largest of each context, float[contexts, 2].
        seed: of the noise under which it is learned.
    """

    def __init__(self, source: Rows, noise: FloatArray, ranges: FloatArray, seed: int) -> None:
        self._noise, (self._middle, self._scale) = noise, standard(ranges)
        shown = source.readings / noise
        self._mean = shown.mean(axis=0)
        _, size, ways = thin_svd(shown - self._mean)
        # What varies by less than the noise shows nothing.
        size = size / np.sqrt(len(shown))
        self._size, self._ways = size[size > 1.0], ways[size > 1.0].T
        noisy = source.readings + noise * np.random.default_rng(seed).standard_normal(shown.shape)
        features = self._features(noisy)
        inner = features.T @ features + RIDGE * np.eye(features.shape[1])
        wanted = (source.contexts - self._middle) / self._scale
        self._weights = np.linalg.solve(inner, features.T @ wanted)

    def __call__(self, readings: FloatArray) -> FloatArray:
        """Contexts, float[n, contexts], of readings, float[n, sensors]; NaN where missing."""
        guessed = self._features(readings) @ self._weights
        return np.asarray(self._middle + self._scale * np.clip(guessed, -EDGE, EDGE))

    def _features(self, readings: FloatArray) -> FloatArray:
        """Scores of principal components, as the sensors seen give them, and products of scores."""
        seen = np.isfinite(readings)
        off = np.where(seen, readings / self._noise - self._mean, 0.0)
        scores = np.empty((len(readings), len(self._size)))
        patterns, of_row = np.unique(seen, axis=0, return_inverse=True)
        for number, pattern in enumerate(patterns):
            rows, ways = np.flatnonzero(of_row.ravel() == number), self._ways[pattern]
            inner = ways.T @ ways + np.diag(self._size**-2.0)
            gain = np.linalg.solve(inner, ways.T)
            # Row by row: the last bits of a product of matrices depend on how many rows there are.
            for row in rows:
                scores[row] = gain @ off[row, pattern]
        scores = scores / self._size
        pairs = [scores[:, [k]] * scores[:, k:] for k in range(scores.shape[1])]
        return np.hstack([np.ones((len(scores), 1)), scores, *pairs])
