"""How large an effect is against what no one can know: an approximate d'.

Per channel the unknown is white noise of the AR noise's long-run variance ``v`` plus the
variance that context errors put in, and a random factor of 3 % on the share of each context
(as-built scatter and gain errors, which no length of record averages out). With ``R``
[n, k] those shares, ``d'^2 = sum over channels of s.T (v I + 0.03^2 R R.T)^-1 s``.
"""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.physics.frame import Array

SCATTER = 0.03


def d_prime(signature: Array, shares: list[Array], variance: Array) -> float:
    """``signature`` [n, c]; ``shares``: one [n, c] per context; ``variance`` ``v`` [c]."""
    total = 0.0
    for c in range(signature.shape[1]):
        s = signature[:, c]
        spread = SCATTER * np.column_stack([share[:, c] for share in shares])
        inner = np.eye(spread.shape[1]) * variance[c] + spread.T @ spread
        across = spread.T @ s
        total += float(s @ s - across @ np.linalg.solve(inner, across)) / float(variance[c])
    return float(np.sqrt(max(total, 0.0)))
