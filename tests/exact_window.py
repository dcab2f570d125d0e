"""The rule of the Gaussian window in fractions, and streams that are hard on it."""

from collections import deque
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Rows = NDArray[np.float64]


def exact_alarms(
    rows: Rows,
    window: int,
    z: float,
    *,
    inclusive: bool = False,
    persistence: tuple[int, int] = (1, 1),
    frozen: bool = False,
) -> NDArray[np.bool_]:
    """The rule as it is told, in fractions."""
    alarms = np.zeros(rows.shape, dtype=bool)
    k, n = persistence
    for sensor in range(rows.shape[1]):
        held: deque[Fraction] = deque(maxlen=window - 1 if inclusive else window)
        tested: deque[bool] = deque(maxlen=n)
        for row in np.flatnonzero(~np.isnan(rows[:, sensor])):
            value = Fraction(float(rows[row, sensor]))
            exceeds = False
            if len(held) == held.maxlen:
                judged = [*held, value] if inclusive else list(held)
                mean = sum(judged, Fraction(0)) / window
                variance = sum(((each - mean) ** 2 for each in judged), Fraction(0)) / window
                exceeds = value > mean and (value - mean) ** 2 > Fraction(z) ** 2 * variance
                tested.append(exceeds)
                alarms[row, sensor] = sum(tested) >= k
            if not (frozen and exceeds):
                held.append(value)
    return alarms


def hard_streams() -> Rows:
    """Outliers of 1e9; a spread of 1e-2 on a level of 1e4; a scale that drops by 1e8."""
    noise = np.random.default_rng(7).normal(size=(1200, 3))
    noise[100::170, 0] += 1e9
    noise[:, 1] = 1e4 + 1e-2 * noise[:, 1]
    noise[:, 2] *= np.where(np.arange(1200) // 150 % 2, 1e-4, 1e4)
    return noise
