"""What findings keep of the windows in which modes were measured."""

import numpy as np
import pytest

from independent.modal_bridge import MEMORY, NOISE, Hidden, Parked, measured
from rga.diagnosis.modal.account import windows_of
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials


def test_windows_are_kept_with_their_noise() -> None:
    truck = Parked({"b3n": 1000.0, "b3s": 1000.0}, (10, 80))
    model, record = measured(3, Hidden(), modes=4, windows=80, parked=truck)
    readings = ModalReadings.of(model, record)
    windows = windows_of(ModalLikelihood(ModalTrials(model, readings)))
    assert (windows.count, windows.contexts) == (80, {"truck": (0.0, 1.0)})
    assert list(windows.modes) == ["m0", "m1", "m2", "m3"]
    for mode in windows.modes.values():
        assert mode.scatter == pytest.approx(NOISE, rel=0.35)
        assert mode.memory == pytest.approx(MEMORY, abs=0.3)
        assert 0.7 < mode.found < 1.0
        assert mode.shape.keys() == model.points.keys()
        np.testing.assert_allclose(np.linalg.norm(list(mode.shape.values())), 1.0)
        assert 0.0 < mode.shape_noise < 0.01
