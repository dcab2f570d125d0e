"""Noise with memory, gaps in the data, and the random streams of a case."""

from __future__ import annotations

import zlib

import numpy as np

from rga_bench.synthetic.physics.frame import Array


def stream(seed: int, purpose: str) -> np.random.Generator:
    """Random numbers of one purpose: what another purpose draws never shifts them."""
    return np.random.default_rng([seed, zlib.crc32(purpose.encode())])


def autoregressive(rng: np.random.Generator, rows: int, sd: Array, phi: Array) -> Array:
    """Stationary AR(1) noise, shape [rows, k], of marginal ``sd`` [k] and memory ``phi`` [k]."""
    shock = rng.standard_normal((rows, len(sd))) * sd
    out = np.empty_like(shock)
    fresh = np.sqrt(1.0 - phi**2)
    last = shock[0]
    out[0] = last
    for row in range(1, rows):
        last = phi * last + fresh * shock[row]
        out[row] = last
    return out


def heavy_tailed(rng: np.random.Generator, rows: int, sd: Array) -> Array:
    """White noise of Student's t with three degrees of freedom, shape [rows, k], of ``sd`` [k]."""
    return np.asarray(rng.standard_t(3.0, (rows, len(sd))) / np.sqrt(3.0) * sd)


def long_run_variance(sd: Array, phi: Array) -> Array:
    """Variance of the white noise that averages out as slowly as the AR(1) noise, shape [k]."""
    return np.asarray(sd**2 * (1.0 + phi) / (1.0 - phi))


def missing(rng: np.random.Generator, rows: int, channels: int) -> np.ndarray:
    """True where a value is lost, shape [rows, channels]: single ones and one short outage."""
    lost = rng.random((rows, channels)) < rng.uniform(0.0, 0.004)
    start = int(rng.integers(0, rows))
    lost[start : start + int(rng.integers(1, 6)), int(rng.integers(0, channels))] = True
    return lost
