"""Strain gauges that sit elsewhere than the model says."""

from collections.abc import Iterator, Mapping
from typing import Annotated, Any, Literal

from rga.model.action import Action
from rga.model.bending import bending_axes
from rga.model.effect import Effect
from rga.model.effects.joints.joint_rigidity import JointRigidity
from rga.model.effects.sensors.places import Sensors
from rga.model.parameter import Normal, Parameter, Prior, Value, listed
from rga.model.schema import Model
from rga.model.structure import Structure

USUAL = Normal(0.0, 0.15)


class GaugePosition(Effect):
    """A strain gauge off the fibre where the model has it: it reads other bending [m].

    In a plane model it is sought along the one local axis along which its strain varies.
    """

    kind: Literal["gauge_position"] = "gauge_position"
    action = Action(
        inspect="where on the section gauge {place} sits",
        check="its place in the drawing: off the axis it reads bending too",
        test="a second gauge on the opposite face",
    )
    usual = (
        f"y and z {USUAL} m: a judgement from half the depth of a common rolled section, from one "
        "of its flanges to its axis"
    )
    structural = True
    sensor: Sensors
    y: Annotated[Value, Parameter("m", 0.0)] = 0.0
    z: Annotated[Value, Parameter("m", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        joints = {
            name
            for effect in model.effects.values()
            if isinstance(effect, JointRigidity)
            for group in listed(effect.group)
            for name in model.groups[group]
        }
        for name, sensor in model.sensors.items():
            if sensor.kind != "strain" or sensor.member is None:
                continue
            if sensor.member in joints or model.members[sensor.member].kind == "frame":
                yield {"sensor": name}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        (sensor,) = listed(place["sensor"])[:1]
        bending = bending_axes(model, str(model.sensors[sensor].member))
        return dict.fromkeys(bending, USUAL)

    def change_structure(self, structure: Structure, value: Mapping[str, float]) -> None:
        # A simulation may be asked for other sensors than those of the model: member forces, say.
        present = [name for name in listed(self.sensor) if name in structure.sensors]
        rows = [structure.sensors[name] for name in present]
        structure.outputs["vector"][rows, 1:] += value["y"], value["z"]
