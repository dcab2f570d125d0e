"""What a simulator keeps of the rows so far, so that it can go on without them."""

import json
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.effect import Effect, Past
from rga.model.schema import Model
from rga.simulation.paths.friction_past import FrictionPast


@dataclass(frozen=True, eq=False)
class Memory:
    """What a simulator keeps of the rows so far: exact, and of a size that rows do not change.

    It is a few numbers for each effect that looks back, and for a `clock_lag` the rows that a late
    clock has yet to show. For a model without such effects it is empty.

    Attributes:
        effects: what each effect keeps, by its name.
        friction: where bearings with friction stand.

    >>> Memory({"drift": {"first": np.array([0.1])}}).to_bytes()
    b'{"effects":{"drift":{"first":[0.1]}}}'
    >>> Memory.from_bytes(_).effects
    {'drift': {'first': array([0.1])}}
    """

    effects: dict[str, Past] = field(default_factory=dict)
    friction: FrictionPast = field(default_factory=FrictionPast)

    def to_bytes(self) -> bytes:
        """The memory as text; every number keeps its bits."""
        content: dict[str, Any] = {
            "effects": {
                name: {key: kept.tolist() for key, kept in past.items()}
                for name, past in self.effects.items()
            }
        }
        if self.friction.last is not None:
            content["friction"] = {
                "changes": self.friction.changes,
                "last": self.friction.last.tolist(),
                "rested": [
                    [list(state), kept.tolist()] for state, kept in self.friction.rested.items()
                ],
            }
        return json.dumps(content, separators=(",", ":")).encode()

    @classmethod
    def from_bytes(cls, content: bytes) -> "Memory":
        """The memory that `to_bytes` wrote.

        Raises:
            InputError: this is none.
        """
        try:
            read = json.loads(content)
            effects = {
                name: {key: _numbers(kept) for key, kept in past.items()}
                for name, past in read["effects"].items()
            }
            if "friction" not in read:
                return cls(effects)
            friction = read["friction"]
            rested = {tuple(map(float, one)): _numbers(kept) for one, kept in friction["rested"]}
            past = FrictionPast(int(friction["changes"]), _numbers(friction["last"]), rested)
        except (ValueError, KeyError, TypeError, AttributeError):
            raise InputError(
                "this is no memory of a simulator", "memory", "give what `to_bytes` wrote"
            ) from None
        return cls(effects, past)


@dataclass(frozen=True)
class Followed:
    """Rows that were followed.

    Attributes:
        readings: float[rows, sensors] in the units of the sensors.
        memory: with which the next rows are followed.
    """

    readings: FloatArray
    memory: Memory


@dataclass(frozen=True)
class Trail:
    """What rows leave behind while they are simulated.

    Attributes:
        effects: of the model, by name; those that look back go on from what they have kept.
        friction: where bearings stand; in place.
    """

    effects: dict[str, Effect]
    friction: FrictionPast = field(default_factory=FrictionPast)

    @classmethod
    def behind(cls, model: Model, memory: Memory | None) -> "Trail":
        """The trail of rows that follow others, or of the first.

        Args:
            model: of which they are.
            memory: of the rows before; None: there are none. It stays as it is.

        Raises:
            InputError: it is the memory of other effects.
        """
        keeping = [name for name, effect in model.effects.items() if effect.keeps_past]
        before = memory or Memory({name: {} for name in keeping})
        if set(before.effects) != set(keeping):
            raise InputError(
                f"the memory is of effects {list(before.effects)}, and those of the model that "
                f"look back are {keeping}",
                f"model {model.name!r}",
                "follow the rows from the first on",
            )
        effects = {
            name: effect.going_on(dict(before.effects[name])) if effect.keeps_past else effect
            for name, effect in model.effects.items()
        }
        return cls(effects, before.friction.copy())

    @property
    def memory(self) -> Memory:
        """What has been kept."""
        kept = {name: effect.past for name, effect in self.effects.items() if effect.keeps_past}
        rubs = any(effect.structural and effect.remembers for effect in self.effects.values())
        return Memory(kept, self.friction if rubs else FrictionPast())


def hindrance(model: Model) -> str:
    """Why rows of a model cannot be followed without those before; empty where they can."""
    for name, effect in model.effects.items():
        if effect.hindrance:
            return f"effect {name!r}: {effect.hindrance}"
    for name, sensor in model.sensors.items():
        if sensor.zero is not None:
            return f"sensor {name!r}: its zero is a mean of rows that may not have come yet"
    return ""


def _numbers(kept: Any) -> FloatArray:
    return np.array(kept, dtype=float)
