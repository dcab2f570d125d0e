"""How step sizes and the reversal's strength go over a training."""

import math

WARM_UP = 0.05


def falling(done: float) -> float:
    """Factor on the learning rate: up over the first 5 %, then half a cosine down to zero.

    >>> round(falling(0.05), 3), round(falling(1.0), 3)
    (1.0, 0.0)
    """
    if done < WARM_UP:
        return (done + 1e-3) / (WARM_UP + 1e-3)
    return 0.5 * (1.0 + math.cos(math.pi * (done - WARM_UP) / (1.0 - WARM_UP)))


def reversal_strength(done: float) -> float:
    """Strength of the gradient reversal, 0 to 1 (Ganin et al. 2016, section 5.2.2).

    >>> reversal_strength(0.0), round(reversal_strength(1.0), 4)
    (0.0, 0.9999)
    """
    return 2.0 / (1.0 + math.exp(-10.0 * done)) - 1.0
