"""What sensors and the logger make of reality, and its noise.

Sources: makers' data and VDI/VDE/GESA 2635 for gauges (gauge factor within 1 %, transverse
sensitivity below 1 %, some degrees of misalignment, lead wires); makers' data for displacement
transducers (linearity 0.1 % to 0.5 % of the span) and inclinometers (0.5 %).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from rga_bench.field.solver import Array
from rga_bench.field.structure import FieldStructure

#: gauge factor: uniform within [-]; half of what lead wires take away at most [-]
_GAUGE_FACTOR, _WIRES = 0.01, 0.005
#: transverse sensitivity at most [-], misalignment at most [rad]
_TRANSVERSE, _TURNED = 0.008, np.radians(4.0)
_POISSON = 0.3
#: linearity of displacement transducers, of their span, from the best class to the worst; spans
#: that are sold [mm]
_LINEARITY, _SPANS = (0.001, 0.005), (10.0, 25.0, 50.0, 100.0, 200.0, 500.0)
_TILT = 0.005
#: of a temperature-compensated gauge: what is left [noise/K]; drift of a zero over a record
#: [noise]. Both too small to be seen: what is seen of either is a finding, and no null record.
_WARMTH, _DRIFT = 0.004, 0.1
#: coefficients of the noise, ARMA(1, 1), between rows
_AR, _MA = (0.0, 0.8), (-0.3, 0.4)
#: swing of the logarithm of the noise's deviation over a record
_SWING = 0.3
#: share of outliers at most, and their size in the noise
_OUTLIERS, _FAR = 0.003, (4.0, 10.0)
#: logger's step in the noise: 16 bits over a wide range
_STEP = (0.3, 1.0)


@dataclass(frozen=True)
class Logger:
    """Errors of the channels, [c] each, and the noise.

    ``bow``: the deviation of a transducer at half of its span, ``half``: that half.
    ``long_run`` [c]: variance of white noise that averages out as slowly as the channel's.
    """

    gain: Array
    bow: Array
    half: Array
    per_kelvin: Array
    walk: Array  # [n, c]
    noise: Array  # [n, c]
    step: Array
    offset: Array
    long_run: Array

    def read(self, channels: Array, kelvin: Array) -> Array:
        """Readings [n, c] of healthy sensors before noise, ``kelvin`` [n] above the mean."""
        bent = self.bow * np.sin(np.pi * channels / self.half)
        return np.asarray(
            self.gain * channels + bent + self.per_kelvin * kelvin[:, None] + self.walk
        )

    def logged(self, readings: Array) -> Array:
        """With noise, in the logger's steps where it has some."""
        out = readings + self.noise
        coarse = self.step > 0.0
        out[:, coarse] = self.step[coarse] * np.round(out[:, coarse] / self.step[coarse])
        return out


def logger(
    structure: FieldStructure,
    rng: np.random.Generator,
    healthy: Array,
    spread: float,
    quantised: bool,
) -> Logger:
    """The logger of a record whose channels move as ``healthy`` [n, c]."""
    sensors = list(structure.model["sensors"].values())
    rows, many = healthy.shape
    nominal = np.array([s["noise"] for s in sensors])
    gain, bow = np.ones(many), np.zeros(many)
    half = np.ones(many)
    for k, sensor in enumerate(sensors):
        draws = rng.uniform(-1.0, 1.0, 4)
        if sensor["kind"] == "strain":
            turned = np.sin(_TURNED * draws[1]) ** 2 * (1.0 + _POISSON)
            across = _TRANSVERSE * draws[2] * _POISSON
            wires = _WIRES * (1.0 + draws[3])
            gain[k] = 1.0 + spread * (_GAUGE_FACTOR * draws[0] - turned - across - wires)
        elif sensor["kind"] == "displacement":
            reach = 1.2 * float(np.abs(healthy[:, k]).max())
            half[k] = next((s for s in _SPANS if s >= reach), reach)
            linear = _LINEARITY[0] + np.ptp(_LINEARITY) * abs(draws[0])
            bow[k] = linear * half[k] * np.sign(draws[1])
        else:
            gain[k] = 1.0 + spread * _TILT * draws[0]
    sd = nominal * np.exp(0.15 * spread * rng.standard_normal(many))
    walk = np.cumsum(rng.standard_normal((rows, many)), axis=0) / np.sqrt(rows)
    ar = np.asarray(rng.uniform(*_AR, size=many))
    ma = np.asarray(rng.uniform(*_MA, size=many))
    wave = np.sin(2.0 * np.pi * (np.arange(rows)[:, None] / rows * rng.uniform(0.5, 2.0, many)))
    noise = _arma(rng, rows, ar, ma) * sd * np.exp(_SWING * rng.uniform(-1, 1, many) * wave)
    hit = rng.random((rows, many)) < _OUTLIERS * rng.random(many)
    noise += hit * rng.choice([-1.0, 1.0], hit.shape) * rng.uniform(*_FAR, hit.shape) * sd
    step = nominal * rng.uniform(*_STEP, many) if quantised else np.zeros(many)
    power = 1.0 + (ar + ma) ** 2 / (1.0 - ar**2)
    return Logger(
        gain=gain,
        bow=bow,
        half=half,
        per_kelvin=spread * _WARMTH * nominal * rng.standard_normal(many),
        walk=spread * _DRIFT * nominal * walk,
        noise=noise,
        step=step,
        offset=nominal * rng.uniform(-400.0, 400.0, many),
        long_run=np.asarray(sd**2 / power * ((1.0 + ma) / (1.0 - ar)) ** 2),
    )


def _arma(rng: np.random.Generator, rows: int, ar: Array, ma: Array) -> Array:
    """ARMA(1, 1) of unit variance, [n, c]."""
    warm_up = 50
    shock = rng.standard_normal((rows + warm_up, len(ar)))
    out = np.zeros_like(shock)
    for k in range(1, len(out)):
        out[k] = ar * out[k - 1] + shock[k] + ma * shock[k - 1]
    power = 1.0 + (ar + ma) ** 2 / (1.0 - ar**2)
    return np.asarray(out[warm_up:] / np.sqrt(power))
