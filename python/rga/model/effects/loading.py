"""Loads that are larger, elsewhere or others than the model says."""

from collections.abc import Iterator, Mapping
from dataclasses import replace
from functools import partial
from typing import Annotated, Any, Literal

import numpy as np

from rga.arrays import FloatArray
from rga.model.effect import Effect, Values
from rga.model.parameter import (
    Driven,
    Factor,
    Normal,
    Number,
    Parameter,
    Place,
    Prior,
    Value,
    listed,
)
from rga.model.schema import Model
from rga.model.structure import HELD_BY_PLANE, Load, Structure, check_direction, unit_vector

Effects = Annotated[str | list[str], Place("effect")]
LOAD_KINDS = ("nodal_load", "member_load", "axle_load")


class LoadScale(Effect):
    """A factor on a load, or on several: weights, impact."""

    kind: Literal["load_scale"] = "load_scale"
    effect: Effects
    factor: Annotated[Value, Parameter("-", 1.0)] = 1.0

    def check(self, model: Model) -> None:
        _check_target(self, self.effect, model, "factor")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from together(model, list(load_names(model)))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"factor": Factor(0.15)}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for name in listed(self.effect):
            other = all_values[name]
            other["factor"] = other["factor"] * values["factor"]


class LoadPosition(Effect):
    """Axles that stand ahead of the position given [m]."""

    kind: Literal["load_position"] = "load_position"
    effect: Effects
    offset: Annotated[Value, Parameter("m", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        _check_target(self, self.effect, model, "position")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        # The offset of a position that is inferred cannot be told from the position itself.
        names = [
            name
            for name, effect in model.effects.items()
            if effect.kind == "axle_load"
            and (
                not isinstance(position := getattr(effect, "position"), Driven)  # noqa: B009
                or model.context[position.context].law == "independent"
            )
        ]
        yield from together(model, names)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"offset": Normal(0.0, 1.0)}

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        for name in listed(self.effect):
            other = all_values[name]
            other["position"] = other["position"] + values["offset"]


class LoadEccentricity(Effect):
    """Loads shifted sideways: at +y nodes times (1 + 2 share), at -y nodes (1 - 2 share).

    A load along a member is shifted as the mean of the member's two nodes.
    """

    kind: Literal["load_eccentricity"] = "load_eccentricity"
    effect: Effects
    share: Annotated[Value, Parameter("-", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        _check_target(self, self.effect, model, "factor")

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        if np.ptp([point[1] for point in model.nodes.values()]) > 0:
            yield from together(model, list(load_names(model)))

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"share": Normal(0.0, 0.1)}

    def change_loads(
        self, loads: dict[str, list[Load]], structure: Structure, values: Values
    ) -> None:
        for name in listed(self.effect):
            shifted = [
                structure.once(partial(_shifted, structure, load), *load.pattern).times(
                    2 * values["share"] * load.coefficient
                )
                for load in loads[name]
            ]
            loads[name] = [*loads[name], *shifted]


def _shifted(structure: Structure, load: Load) -> Load:
    """A load that is full at the +y side of the structure and turned round at the -y side."""
    y = structure.arrays["coordinates"][:, 1]
    side = np.sign(np.round(y - (y.min() + y.max()) / 2, 9))
    of_member = side[structure.arrays["ends"]].mean(axis=1)
    return replace(
        load,
        forces={node: side[node] * force for node, force in load.forces.items()},
        spread=[
            (member, *along, of_member[member] * start, of_member[member] * end)
            for member, *along, start, end in load.spread
        ],
    )


class UnmodelledLoad(Effect):
    """A load along the members of a group that follows a context: wind, snow.

    Attributes:
        direction: of the load in global axes.
        context: the context variable that the load follows.
        rate: [N/m per unit of the context].
    """

    kind: Literal["unmodelled_load"] = "unmodelled_load"
    loads_by_geometry = True
    group: Annotated[str | list[str], Place("group")]
    direction: Annotated[tuple[Number, Number, Number], Place("")]
    context: Annotated[str, Place("context")]
    rate: Annotated[Value, Parameter("N/m per unit", 0.0)] = 0.0

    def check(self, model: Model) -> None:
        check_direction(self.direction)

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        for group in model.groups:
            for held, direction in ((1, (0.0, 1.0, 0.0)), (2, (0.0, 0.0, 1.0))):
                if held not in HELD_BY_PLANE.get(model.plane or "", ()):
                    for context in model.context:
                        yield {"group": group, "direction": direction, "context": context}

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        low, high = model.context[place["context"]].range
        return {"rate": Normal(0.0, 1000.0 / (high - low))}

    def drivers(self) -> set[str]:
        return super().drivers() | {self.context}

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        return {"rate": super().values(contexts, rows)["rate"] * contexts[self.context]}

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        return [Load(values["rate"], forces=line_forces(structure, self.group, self.direction))]


class DeadLoad(Effect):
    """A permanent load along the members of a group, downward [N/m]."""

    kind: Literal["dead_load"] = "dead_load"
    loads_by_geometry = True
    group: Annotated[str | list[str], Place("group")]
    force_per_length: Annotated[Value, Parameter("N/m", 0.0)] = 0.0

    @classmethod
    def places(cls, model: Model) -> Iterator[dict[str, Any]]:
        yield from ({"group": group} for group in model.groups)

    @classmethod
    def priors(cls, model: Model, place: Mapping[str, Any]) -> dict[str, Prior]:
        return {"force_per_length": Normal(0.0, 1000.0)}

    def loads(self, structure: Structure, values: Values, others: dict[str, Values]) -> list[Load]:
        forces = line_forces(structure, self.group, (0.0, 0.0, -1.0))
        return [Load(values["force_per_length"], forces=forces, permanent=not self.drivers())]


def line_forces(
    structure: Structure, group: str | list[str], direction: tuple[float, float, float]
) -> dict[int, FloatArray]:
    """Nodal forces of a unit load per length on a group: half of each member to each end."""
    unit = np.append(unit_vector(direction), np.zeros(3))
    forces: dict[int, FloatArray] = {}
    lengths = structure.lengths
    for member in structure.named(None, group):
        for node in structure.arrays["ends"][member]:
            share = unit * lengths[member] / 2
            forces[int(node)] = forces.get(int(node), np.zeros(6)) + share
    return forces


def _check_target(effect: Effect, named: str | list[str], model: Model, parameter: str) -> None:
    """Refuse an effect on others that lack the parameter that it changes (ValueError)."""
    for name in listed(named):
        kind = type(model.effects[name])
        if kind.loads is Effect.loads or parameter not in kind.parameters():
            raise ValueError(
                f"{effect.kind} acts on the {parameter} of a load, which {name!r} "
                f"({model.effects[name].kind}) has not: name a load with one"
            )


def load_names(model: Model) -> Iterator[str]:
    """Names of the loads of a model."""
    yield from (name for name, effect in model.effects.items() if effect.kind in LOAD_KINDS)


def together(model: Model, names: list[str]) -> Iterator[dict[str, Any]]:
    """Loads that one context moves or scales count as one place; then each load, then all."""
    shared: dict[frozenset[str], list[str]] = {}
    for name in names:
        shared.setdefault(frozenset(model.effects[name].drivers()), []).append(name)
    for same in shared.values():
        yield {"effect": same[0] if len(same) == 1 else same}
        if len(same) > 1:
            yield from ({"effect": name} for name in same)
    if len(shared) > 1:
        yield {"effect": names}
