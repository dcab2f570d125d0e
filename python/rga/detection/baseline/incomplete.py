"""What sensors have in common, from rows of which none need be complete."""

import numpy as np

from rga.arrays import FloatArray

#: rounds at most, and a change of a correlation that is none
ROUNDS, SETTLED = 30, 2e-3
#: variance that is left of every direction, as a share
LEAST = 1e-3
#: work of a round, patterns of gaps times sensors cubed: beyond it there are so many rows that each
#: two sensors tell what they have in common by themselves
MOST_WORK = 1e8


def likeliest_covariance(scores: FloatArray, start: FloatArray) -> FloatArray:
    """The covariance under which normal scores of mean 0 are likeliest as far as they are there.

    By expectation and maximisation: what is missing of a row has the conditional mean and
    covariance that what is there lets expect (Little and Rubin, Statistical Analysis with Missing
    Data, 2019, section 11.2). What is missing may depend on whatever is there.

    Args:
        scores: float[rows, sensors], NaN where missing.
        start: covariance to begin with, float[sensors, sensors]; kept where a round would take
            too long.

    Returns:
        float[sensors, sensors], positive definite.

    >>> scores = np.array([[1.0, 1.0], [-1.0, -1.0], [1.0, -1.0], [2.0, np.nan], [np.nan, 0.5]])
    >>> likeliest_covariance(scores, np.eye(2)).round(1).tolist()
    [[1.7, 0.4], [0.4, 0.8]]
    """
    sensors = len(start)
    found = np.asarray((1.0 - LEAST) * start + LEAST * np.eye(sensors))
    rows = scores[np.isfinite(scores).any(axis=1)]
    patterns, of_row, count = np.unique(
        np.isfinite(rows), axis=0, return_inverse=True, return_counts=True
    )
    if len(patterns) * sensors**3 > MOST_WORK:
        return found
    known = np.nan_to_num(rows)
    alike = (known[of_row.ravel() == number] for number in range(len(patterns)))
    products = np.array([own.T @ own for own in alike])
    there = patterns[:, :, None] * np.eye(sensors)
    lacking, number = np.eye(sensors) - there, count[:, None, None]
    for _ in range(ROUNDS):
        # The inverse of the part of the covariance that is there, and zeros beside it.
        inverse = there @ np.linalg.inv(there @ found @ there + lacking) @ there
        filling = there + lacking @ found @ inverse
        left = lacking @ (found - found @ inverse @ found) @ lacking
        expected = filling @ products @ filling.transpose(0, 2, 1) + number * left
        # Sensors that repeat each other would leave no variance of what they differ by.
        likeliest = expected.sum(axis=0) / len(rows)
        before, found = found, (1.0 - LEAST) * likeliest + LEAST * np.diag(np.diag(likeliest))
        if np.abs(found - before).max() < SETTLED:
            break
    return np.asarray(found)
