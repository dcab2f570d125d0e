"""Modes of a small frame that white noise moves come back, and of noise alone there are none."""

import numpy as np
import pytest
from scipy.linalg import eigh, expm

from rga.records.modal.operational import operational_modes

pytest.importorskip("pyoma2", reason='pyOMA2 is not installed: pip install "rga[oma]"')
STEP, SAMPLES = 0.02, 30_000
MASS = np.diag([1.0, 1.0, 0.8])
STIFFNESS = 400.0 * np.array([[2.0, -1.0, 0.0], [-1.0, 1.9, -0.9], [0.0, -0.9, 0.9]])


def accelerations(rng: np.random.Generator) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Those of three storeys under white noise; the frame's frequencies [Hz], and shapes."""
    squares, shapes = eigh(STIFFNESS, MASS)
    rates = np.sqrt(squares)
    motion = np.zeros((SAMPLES, 3))
    for rate, shape in zip(rates, shapes.T, strict=True):
        system = np.array([[0.0, 1.0], [-(rate**2), -2 * 0.01 * rate]])
        forward = expm(system * STEP)
        push = np.linalg.solve(system, (forward - np.eye(2)) @ [0.0, 1.0])
        state = np.zeros(2)
        for at, force in enumerate(rng.standard_normal(SAMPLES)):
            motion[at] += shape * (system[1] @ state + force)
            state = forward @ state + push * force
    noise = 0.05 * motion.std(0) * rng.standard_normal(motion.shape)
    return motion + noise, rates / (2 * np.pi), shapes


def test_frequencies_and_shapes_come_back() -> None:
    motion, frequencies, shapes = accelerations(np.random.default_rng(0))
    found = operational_modes(motion, STEP, 8.0)
    assert [one.frequency for one in found] == pytest.approx(frequencies, rel=5e-3)
    for one, shape in zip(found, shapes.T, strict=True):
        alike = abs(one.shape.conj() @ shape) ** 2
        assert alike / (np.linalg.norm(one.shape) * np.linalg.norm(shape)) ** 2 > 0.98
        assert one.damping == pytest.approx(0.01, abs=0.005)


@pytest.mark.parametrize("seed", range(3))
def test_of_noise_alone_there_is_no_mode(seed: int) -> None:
    noise = np.random.default_rng(seed).standard_normal((SAMPLES, 3))
    assert operational_modes(noise, STEP, 8.0) == []
