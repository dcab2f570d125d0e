"""Causes and broken channels as effects of a model, with what was estimated."""

from typing import Any

from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.search.laplace import Fit
from rga.diagnosis.search.stepwise import Found
from rga.model.effect import Effect
from rga.model.effects.sensors.sensor_bias import SensorBias
from rga.model.effects.sensors.sensor_drift import SensorDrift
from rga.model.effects.sensors.sensor_fault import SensorFault
from rga.model.effects.sensors.sensor_gain import SensorGain
from rga.model.parameter import NORMAL_90, Estimated
from rga.model.schema import Model
from rga.records import Record


def effects_of(found: Found, record: Record) -> list[Effect]:
    """The causes as effects with estimated parameters, onsets as in the record."""
    least = found.problem.criteria.channels.dead_gain
    effects = estimated_effects(found.fit, record)
    onsets = [one.onset for one in found.fit.hypotheses]
    lasting = [_drifting(*one, record) for one in zip(effects, onsets, strict=True)]
    return [as_dead(effect, least) for effect in lasting]


def as_dead(effect: Effect, least: float) -> Effect:
    """A gain of nearly nothing reported as what it is: a channel that is dead."""
    if isinstance(effect, SensorGain) and isinstance(effect.factor, Estimated):
        low, high = effect.factor.ci90
        if low < least < high or abs(effect.factor.value) < least:
            return SensorFault(**effect.place, mode="dead", onset=effect.onset)
    return effect


def cause_name(model: Model, effect: Effect) -> str:
    """A name for a cause in the extended model, new to the model."""
    place = " ".join(str(one) for one in effect.place.values() if isinstance(one, str))
    name = f"{effect.title} {place}".strip()
    return name if name not in model.effects else f"{name} (found)"


def content(effect: Effect) -> dict[str, Any]:
    """An effect as it stands in a model file."""
    return {"kind": effect.kind, **effect.model_dump(mode="json", exclude_defaults=True)}


def fault_effect(fault: BrokenChannel, record: Record) -> SensorFault:
    """A rejected channel as it stands in the extended model."""
    onset = None if fault.row is None else record.time_label(float(record.time[fault.row]))
    return SensorFault(sensor=fault.sensor, mode=fault.mode, onset=onset)


def last_effect(one: Fit, record: Record) -> dict[str, Any]:
    """The last hypothesis of a fit as an effect of a model file, with its estimates."""
    return content(_effect(one, len(one.hypotheses) - 1, record))


def estimated_effects(one: Fit, record: Record) -> list[Effect]:
    return [_effect(one, number, record) for number in range(len(one.hypotheses))]


def _effect(one: Fit, number: int, record: Record) -> Effect:
    hypothesis, where, spreads = one.hypotheses[number], one.slices()[number], one.spreads()
    values = {}
    for (name, prior), z, spread in zip(
        hypothesis.priors.items(), one.z[where], spreads[where], strict=True
    ):
        ends = sorted(prior.value(float(z + sign * NORMAL_90 * spread)) for sign in (-1, 1))
        values[name] = Estimated(value=prior.value(float(z)), ci90=(ends[0], ends[1]))
    effect = hypothesis.beginning(None).effect(one.z[where]).with_values(values)
    if hypothesis.onset is None:
        return effect
    late: dict[str, Any] = {"onset": record.time_label(hypothesis.onset - record.origin)}
    if hypothesis.profile == "ramp":
        late["profile"] = "ramp"
    if hypothesis.end is not None:
        late["end"] = record.time_label(hypothesis.end - record.origin)
    return effect.model_copy(update=late)


def _drifting(effect: Effect, onset: float | None, record: Record) -> Effect:
    """An offset that grows up to the last row reported as what it is: a drift."""
    if not isinstance(effect, SensorBias) or effect.profile != "ramp" or effect.end is not None:
        return effect
    offset = effect.offset
    if onset is None or not isinstance(offset, Estimated):
        return effect
    days = (record.origin + float(record.time[-1]) - onset) / 86400
    low, high = offset.ci90
    rate = Estimated(value=offset.value / days, ci90=(low / days, high / days))
    drift = SensorDrift(sensor=effect.sensor, rate=rate.value).with_values({"rate": rate})
    return drift.model_copy(update={"onset": effect.onset})
