"""Measured modes beside what is simulated of them, as findings and reports hold them."""

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.checks import gain_interval, squares
from rga.diagnosis.modal.likelihood import ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction
from rga.findings.modal_arrays import ModeReading
from rga.findings.schema import FoundMode, Gap, GroupGap, HeldOut, SensorGap, Windows
from rga.model import Model
from rga.simulation.modal.expected import Expected, mac


def by_sensor(
    model: Model, likelihood: ModalLikelihood, before: Prediction, after: Prediction
) -> dict[str, SensorGap]:
    """Squared deviations of the frequencies, over what noise and model may be off."""
    own = [squares(likelihood, one) for one in (before, after)]
    modes = likelihood.readings.modes
    return {
        name: SensorGap(before=float(own[0][at]), after=float(own[1][at]))
        for name, sensor in model.modal_sensors.items()
        if sensor.point is None and sensor.mode in modes
        for at in [modes.index(sensor.mode)]
    }


def mode_gap(
    model: Model,
    likelihood: ModalLikelihood,
    ends: tuple[Prediction, Prediction],
    before: FloatArray,
    after: FloatArray,
) -> Gap:
    """The gap of the modes, and of modes that were left out.

    Args:
        model: with sensors of modes.
        likelihood: of the modes.
        ends: without causes and with them.
        before, after: squared deviations of modes left out, without causes and with them,
            float[modes].
    """
    own = [squares(likelihood, one) for one in ends]
    gains = before - after
    return Gap(
        before=float(own[0].mean()),
        after=float(own[1].mean()),
        unit="mean squared deviation of frequencies over what noise and a right model leave",
        held_out=HeldOut(
            before=float(before.mean()),
            after=float(after.mean()),
            gain=float(gains.mean()),
            gain_ci90=gain_interval(gains),
        ),
        by_sensor=by_sensor(model, likelihood, *ends),
    )


def mode_groups(
    model: Model, likelihood: ModalLikelihood, before: Prediction, after: Prediction
) -> list[GroupGap]:
    """Every mode, as per cent that is measured beyond what is simulated."""
    ends = [np.expm1(likelihood.mean_off(one)) for one in (before, after)]
    return [
        GroupGap(
            group=f"mode {mode}",
            sensors=[name for name, one in model.modal_sensors.items() if one.mode == mode],
            before_percent=float(100 * ends[0][at]),
            after_percent=float(100 * ends[1][at]),
        )
        for at, mode in enumerate(likelihood.readings.modes)
    ]


def windows_of(likelihood: ModalLikelihood) -> Windows:
    """The windows in which modes were measured, as a plan needs them."""
    readings = likelihood.readings
    points = list(likelihood.trials.model.points)
    known = {name: one[np.isfinite(one)] for name, one in readings.contexts.items()}
    return Windows(
        count=len(readings.time),
        contexts={
            name: (float(one.min()), float(one.max())) for name, one in known.items() if len(one)
        },
        modes={
            name: FoundMode(
                frequency=look.near,
                scatter=float(readings.scatter[at]),
                memory=float(readings.memory[at]),
                found=float(readings.found[at]),
                shape={
                    points[number]: float(motion)
                    for number, motion in zip(look.at, look.shape, strict=True)
                },
                shape_noise=float(readings.shape_noise[at]),
            )
            for at, (name, look) in enumerate(zip(readings.modes, readings.looks, strict=True))
        },
    )


def mode_readings(
    likelihood: ModalLikelihood, before: Prediction, after: Prediction
) -> list[ModeReading]:
    readings, trials = likelihood.readings, likelihood.trials
    points = list(trials.model.points)
    return [
        ModeReading(
            name=name,
            frequency=float(np.exp(np.nanmean(readings.log_f[:, at]))),
            scatter=float(readings.scatter[at]),
            found=float(readings.found[at]),
            points=[points[number] for number in look.at],
            shape=look.shape,
            log_f=readings.log_f[:, at],
            before=before.log_f[:, at],
            after=after.log_f[:, at],
            mac=(_alike(look, before.at_points[at]), _alike(look, after.at_points[at])),
            number=(int(before.number[at]) + 1, int(after.number[at]) + 1),
            shapes=(before.shapes[at], after.shapes[at]),
        )
        for at, (name, look) in enumerate(zip(readings.modes, readings.looks, strict=True))
    ]


def _alike(look: Expected, at_points: FloatArray) -> float:
    """MAC of what was measured in all windows and what is simulated of them, at all points."""
    return mac(look.shape, at_points[look.at]) if len(look.at) else np.nan
