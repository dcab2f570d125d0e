"""What the causes mean for the members: their forces with and without each of them."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.findings.arrays import DiagnosisArrays
from rga.model.effect import Effect, Values
from rga.model.schema import Model, Sensor
from rga.simulation import Simulator

#: share of the largest amplitude below which a member carries too little for a ratio
IDLE = 0.01


@dataclass(frozen=True)
class Forces:
    """Axial forces of every member under the contexts of the rows in which causes act.

    An amplitude is the root mean square over these rows. A ratio is over what the model as it was
    given calculates; where that is next to nothing it is infinite, or NaN if it stays so.

    Attributes:
        members: names, in the order of the model.
        row: the heaviest of these rows: where the model as it was given stores most energy in its
            members.
        given, extended: in that row [N], float[members].
        amplitude, changed: of the model as it was given and with all causes [N], float[members].
        ratio: `changed` over `amplitude`, float[members].
        credited: the same without bearings' restraint, float[members]; None where no cause is such.
        without: the same with all causes but one, by the cause's name, float[members] each;
            none where there is one cause only, or the one is the only bearing.
        measured: amplitude measured by strain gauges over `amplitude`, float[members]; NaN where
            there is no gauge.
    """

    members: tuple[str, ...]
    row: int
    given: FloatArray
    extended: FloatArray
    amplitude: FloatArray
    changed: FloatArray
    ratio: FloatArray
    credited: FloatArray | None
    without: dict[str, FloatArray]
    measured: FloatArray


def member_forces(account: DiagnosisArrays) -> Forces | None:
    """Forces with and without the causes; None where no cause can change any.

    A gauge gives the force of its member by way of the extended model: the measured strain over
    the simulated one, times the simulated force. For a bar that is strain times EA, with the
    noise and the errors of the gauge that were found taken out.
    """
    given, extended = account.model, account.extended
    causes = {
        name: effect
        for name, effect in extended.effects.items()
        if name not in given.effects and not effect.at_sensors()
    }
    if not causes or not account.contexts:
        return None

    acting = slice(account.since, None)

    def forces(chosen: Mapping[str, Effect]) -> FloatArray:
        # Some effects remember the rows before.
        return _forces(given.extended(dict(chosen)), account.contexts)[acting]

    held = {name for name, effect in causes.items() if effect.may_let_go}
    try:
        whole = forces(causes)
        base = forces({})
        without = {
            name: forces({k: one for k, one in causes.items() if k != name})
            for name in (causes if len(causes) > 1 else ())
            if held != {name}
        }
        let_go = forces({k: one for k, one in causes.items() if k not in held}) if held else None
    except InputError:
        # Without one of its causes the structure may be unstable.
        return None
    amplitude = _amplitude(base)
    changed = _amplitude(whole)
    least = IDLE * amplitude.max(initial=0.0)
    idle = amplitude <= least

    def over(values: FloatArray) -> FloatArray:
        new = np.where(_amplitude(values) > least, np.inf, np.nan)
        return np.where(idle, new, _amplitude(values) / np.where(idle, 1.0, amplitude))

    row = int(np.argmax((base**2 * _compliance(given)).sum(1)))
    ratio = over(whole)
    return Forces(
        members=tuple(given.members),
        row=account.since + row,
        given=base[row],
        extended=whole[row],
        amplitude=amplitude,
        changed=changed,
        ratio=ratio,
        credited=None if let_go is None else over(let_go),
        without={name: over(values) for name, values in without.items()},
        measured=ratio * _measured_over_simulated(account),
    )


def _forces(model: Model, contexts: Values) -> FloatArray:
    """Axial force of every member [N], float[rows, members]."""
    gauges = {name: Sensor(kind="force", member=name, unit="N") for name in model.members}
    bare = {name: one for name, one in model.effects.items() if not one.at_sensors()}
    return Simulator(model.model_copy(update={"sensors": gauges, "effects": bare})).predict(
        contexts
    )


def _amplitude(values: FloatArray) -> FloatArray:
    return np.asarray(np.sqrt((values**2).mean(0)))


def _compliance(model: Model) -> FloatArray:
    """L/(EA) of every member [m/N]."""
    found = []
    for member in model.members.values():
        first, last = (np.array(model.nodes[node]) for node in member.nodes)
        stiffness = model.materials[member.material].E * model.sections[member.section].A
        found.append(np.linalg.norm(last - first) / stiffness)
    return np.array(found)


def _measured_over_simulated(account: DiagnosisArrays) -> FloatArray:
    """Amplitude that gauges measured over that of the extended model, their mean by member.

    The noise is taken out of the measured amplitude; NaN where there is no gauge, or its reading
    is not above its noise.
    """
    found: dict[str, list[float]] = {name: [] for name in account.model.members}
    for column, name in enumerate(account.record.sensors):
        sensor = account.model.sensors.get(name)
        if sensor is None or sensor.member is None or account.rejected[column]:
            continue
        measured = account.record.readings[account.since :, column]
        simulated = account.after[account.since :, column]
        seen = np.isfinite(measured) & np.isfinite(simulated)
        if not seen.any():
            continue
        noise = account.sigma[column] ** 2
        power, own = (measured[seen] ** 2).mean() - noise, (simulated[seen] ** 2).mean()
        if min(power, own) > noise:
            found[sensor.member].append(float(np.sqrt(power / own)))
    return np.array([np.mean(one) if one else np.nan for one in found.values()])
