"""What is hidden in a case, in the words of a model file."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from rga.model.effect import Effect
from rga.model.effects.joints.joint_rigidity import JointRigidity
from rga_bench.synthetic import BRIDGES, Case


@dataclass(frozen=True)
class Truth:
    """An effect that is hidden in a case.

    Attributes:
        kind, place: as in a model file.
        values: of its parameters.
        onset, end: of the effect and of its ramp [s]; None: always there, a jump.
        d_prime: by the truth's own account of noise and scatter.
    """

    kind: str
    place: Mapping[str, Any]
    values: dict[str, float]
    onset: float | None
    end: float | None
    d_prime: float

    @classmethod
    def of(cls, case: Case) -> "list[Truth]":
        """All that is hidden in a case."""
        facts = [] if case.truth["kind"] == "null" else [case.truth, *case.truth["beside"]]
        return [cls._read(one) for one in facts]

    @classmethod
    def _read(cls, facts: dict[str, Any]) -> "Truth":
        known = Effect.vocabulary.get(facts["kind"])
        values = {
            name: float(facts[name])
            for name in (known.parameters() if known else ())
            if isinstance(facts.get(name), int | float)
        }
        if facts["parameter"] is not None:
            values[facts["parameter"]] = facts["value"]
        place = dict(facts["place"])
        if facts["kind"] == "sensor_fault":
            place["mode"] = facts["mode"]
        return cls(facts["kind"], place, values, facts["onset"], facts["end"], facts["d_prime"])

    @property
    def profile(self) -> Literal["step", "ramp"]:
        """How it begins."""
        return "step" if self.end is None else "ramp"

    @property
    def can_be_simulated(self) -> bool:
        """Whether a model could simulate what it does; not where a sensor is broken."""
        return self.kind in Effect.vocabulary and self.kind != "sensor_fault"

    def effect(self) -> Effect:
        """As it would stand in a model."""
        late: dict[str, Any] = {}
        if self.onset is not None and self.kind != "sensor_fault":
            late = {"onset": self.onset}
        if self.end is not None:
            late |= {"end": self.end, "profile": "ramp"}
        return Effect.vocabulary[self.kind](kind=self.kind, **self.place, **self.values, **late)

    def is_at(self, effect: dict[str, Any]) -> bool:
        """Kind and place of an effect right: the order of a list, or up for down, do not matter.

        Stiff joints are proposed for one group or for all that bend: a place that holds the true
        one is right.
        """
        if effect["kind"] != self.kind:
            return False
        if self.kind == "joint_rigidity":
            return _names(self.place["group"]) <= _names(effect["group"])
        return all(
            effect.get(name) is not None and _alike(effect[name], value)
            for name, value in self.place.items()
            if name != "mode"
        )


def stiff_joints(case: Case) -> Effect | None:
    """The stiff joints of a frame that is modelled as a truss, as a model would have them."""
    stiffness = case.truth["joint_stiffness"]
    if stiffness is None or case.truth["kind"] == "joint_rigidity":
        return None
    groups = BRIDGES[case.truth["bridge"]](np.random.default_rng(0)).jointed
    return JointRigidity(group=groups, stiffness=stiffness)


def _alike(one: Any, other: Any) -> bool:
    if isinstance(one, Sequence) and not isinstance(one, str) and _numbers(one):
        return bool(np.allclose(one, other) or np.allclose(np.negative(one), other))
    return _names(one) == _names(other)


def _numbers(values: Sequence[Any]) -> bool:
    return all(isinstance(value, int | float) for value in values)


def _names(place: Any) -> frozenset[Any]:
    return frozenset([place] if isinstance(place, str) else place)
