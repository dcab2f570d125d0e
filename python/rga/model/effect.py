"""The base of every effect: a physical influence on a structure, on its loads or on its sensors."""

from collections.abc import Iterable, Iterator, Mapping
from datetime import UTC, datetime
from functools import cache
from typing import TYPE_CHECKING, Any, ClassVar, Literal, Self

import numpy as np
from pydantic import BaseModel, ConfigDict, PrivateAttr, field_validator, model_validator

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model.action import Action
from rga.model.parameter import (
    AnyNumber,
    Driven,
    Estimated,
    Parameter,
    Place,
    Prior,
    listed,
    marks,
    resolve,
)
from rga.model.quantities import value_words

if TYPE_CHECKING:
    from rga.model.readings import Readings
    from rga.model.schema import Model
    from rga.model.structure import Load, Structure

Values = dict[str, FloatArray]
#: what an effect keeps of the rows so far, under names of its own
Past = dict[str, FloatArray]
#: units on a dof that turns, by those on one that moves along
TURNING = {"N/m": "N m/rad", "m": "rad"}


class Effect(BaseModel):
    """One physical influence. A subclass with a `kind` joins the vocabulary when it is defined.

    All that is known of a kind is in its class. It declares its place and its parameters as fields
    marked with `Place` and `Parameter`, says with `places` where in a model it may act and with
    `priors` what is known of its parameters, and overrides those of the `change_...` methods and
    `loads` that it needs: the mechanism. With `title` and `size_words` it says how sentences name
    it, with `action` what it calls for, with `usual` where its priors come from. Its docstring is
    the text of its entry in docs/reference/vocabulary.md.

    Raises (when a subclass is defined):
        InputError: the vocabulary has another class of this kind.

    Attributes:
        onset: time at which the effect begins, as in the record [s or ISO 8601]; None: always.
        end: time at which a ramp is full; None: the last row.
        profile: "step", or "ramp" from 0 at the onset to full at the end.
    """

    model_config = ConfigDict(extra="forbid", frozen=True, defer_build=True)
    vocabulary: ClassVar[dict[str, type["Effect"]]] = {}

    kind: str
    onset: AnyNumber | str | None = None
    end: AnyNumber | str | None = None
    profile: Literal["step", "ramp"] = "step"

    #: Name in prose; left out, the kind with spaces.
    title: ClassVar[str] = ""
    #: What a cause of this kind calls for.
    action: ClassVar[Action] = Action(
        "{place}", "what the model says of {place}", "{load}, near {place}"
    )
    #: What size is usual, in words: what `priors` say, and where it comes from.
    usual: ClassVar[str] = ""
    #: True for a load of the model as it is drawn: others, such as `load_scale`, may act on it.
    is_load: ClassVar[bool] = False
    #: True for a restraint that may let go at any time, so that it is normally not credited.
    may_let_go: ClassVar[bool] = False
    #: True where `factor` is a share of the section of members, which then bears that much less.
    takes_section: ClassVar[bool] = False
    #: True where the parameters change the structure itself.
    structural: ClassVar[bool] = False
    #: True where the effect changes nothing but natural frequencies and mode shapes.
    on_modes: ClassVar[bool] = False
    #: True where the effect changes nothing but what sensors show.
    on_sensors: ClassVar[bool] = False
    #: True where loads, and what is done to those of others, follow from the geometry and alpha
    #: alone, whatever the stiffnesses.
    loads_by_geometry: ClassVar[bool] = False
    #: True where a row depends on the rows before it.
    remembers: ClassVar[bool] = False
    #: True where it goes on from its `past`, so that rows can be followed without those before.
    keeps_past: ClassVar[bool] = False
    #: Values that follow from all rows at once, and no context of one row changes.
    of_all_rows: ClassVar[frozenset[str]] = frozenset()

    _past: Past | None = PrivateAttr(default=None)

    @classmethod
    def __pydantic_init_subclass__(cls, **_: Any) -> None:
        kind = cls.model_fields["kind"].default
        if not isinstance(kind, str):
            return
        if kind in Effect.vocabulary:
            first = Effect.vocabulary[kind]
            raise InputError(
                f"the kind {kind!r} is that of {first.__module__}.{first.__qualname__} already",
                f"class {cls.__qualname__}",
                f"give it a kind of its own, or first: del Effect.vocabulary[{kind!r}]",
            )
        if "title" not in vars(cls):
            cls.title = kind.replace("_", " ")
        Effect.vocabulary[kind] = cls

    @field_validator("onset", "end")
    @classmethod
    def _a_time(cls, moment: float | str | None) -> float | str | None:
        if moment is not None:
            check_moment(moment)
        return moment

    @model_validator(mode="after")
    def _some_parameter(self) -> Self:
        marked = self.parameters()
        idle = all(
            type(self).model_fields[name].default in (None, mark.neutral)
            for name, mark in marked.items()
            if mark.neutral is not None
        )
        if marked and idle and not self.model_fields_set & marked.keys():
            needed = " or ".join(f"{name!r} [{mark.unit}]" for name, mark in marked.items())
            raise ValueError(f"without {needed} the effect does nothing: give it")
        return self

    @model_validator(mode="after")
    def _grows_forward(self) -> Self:
        late = self.onset is not None and self.end is not None
        if late and seconds(self.end or 0.0) < seconds(self.onset or 0.0):
            raise ValueError(f"end: {self.end} lies before the onset {self.onset}")
        return self

    @model_validator(mode="after")
    def _large_enough(self) -> Self:
        for name, mark in self.parameters().items():
            raw = getattr(self, name)
            stated = raw.value if isinstance(raw, Estimated) else raw
            if mark.least is not None and isinstance(stated, float) and stated < mark.least:
                raise ValueError(f"{name}: {stated:g} {mark.unit} is below {mark.least:g}")
        return self

    @classmethod
    @cache
    def parameters(cls) -> dict[str, Parameter]:
        """The marked parameters by field name."""
        found = ((name, marks(field, Parameter)) for name, field in cls.model_fields.items())
        return {name: mark for name, mark in found if mark is not None}

    @classmethod
    @cache
    def place_fields(cls) -> dict[str, Place]:
        """The marked place fields by name."""
        found = ((name, marks(field, Place)) for name, field in cls.model_fields.items())
        return {name: mark for name, mark in found if mark is not None}

    @classmethod
    @cache
    def at_sensors(cls) -> bool:
        """True where the place is a sensor: members and other channels do not feel it."""
        return cls.on_sensors or any(mark.of == "sensor" for mark in cls.place_fields().values())

    @classmethod
    @cache
    def at_points(cls) -> bool:
        """True where the place may be a point at which mode shapes are measured."""
        return any(mark.of == "point" for mark in cls.place_fields().values())

    def sensors_named(self) -> list[str]:
        """The sensors of its place."""
        return self._named("sensor")

    def points_named(self) -> list[str]:
        """The points of its place: it changes what is measured of mode shapes there."""
        return self._named("point")

    def _named(self, of: str) -> list[str]:
        return [
            one
            for name, mark in self.place_fields().items()
            if mark.of == of
            for one in listed(getattr(self, name))
        ]

    @classmethod
    @cache
    def overrides(cls, method: str) -> bool:
        """True where a kind has a `change_...` method, or `loads`, of its own.

        Those of this class do nothing.
        """
        return getattr(cls, method) is not getattr(Effect, method)

    @classmethod
    def unit(cls, parameter: str, place: Mapping[str, Any]) -> str:
        """Unit of a parameter at a place: stiffnesses and motions of a rotation have their own."""
        unit = cls.parameters()[parameter].unit
        turns = str(place.get("dof", "")).startswith("r")
        return TURNING.get(unit, unit) if turns else unit

    @classmethod
    def size_words(cls, effect: Mapping[str, Any]) -> str:
        """How large an effect is, as it follows its place in a sentence.

        Args:
            effect: its keys and values as in a model file.
        """
        values = "; ".join(
            f"{name.replace('_', ' ')} {value_words(effect[name], cls.unit(name, effect))}"
            for name in cls.parameters()
            if effect.get(name) is not None
        )
        return values and f": {values}"

    @property
    def place(self) -> dict[str, Any]:
        """The place as the keys and values of the model file."""
        chosen = ((name, getattr(self, name)) for name in self.place_fields())
        return {name: value for name, value in chosen if value is not None}

    @classmethod
    def places(cls, model: "Model") -> Iterator[dict[str, Any]]:
        """Places at which a diagnosis may propose this effect; none by default."""
        return iter(())

    @classmethod
    def priors(cls, model: "Model", place: Mapping[str, Any]) -> dict[str, Prior]:
        """The prior of each parameter at a place."""
        return {}

    @classmethod
    def forms(cls, model: "Model", place: Mapping[str, Any]) -> list[dict[str, Prior]]:
        """Sets of parameters of which a diagnosis may propose one at a time, with their priors."""
        return [cls.priors(model, place)]

    def with_values(self, values: Mapping[str, float | Estimated]) -> Self:
        """The same effect with other parameter values, which are taken as they are.

        So a validator of a kind may refuse a parameter, and must not change it.
        """
        return self.model_copy(update=dict(values))

    def going_on(self, past: Past) -> Self:
        """The same effect for the next rows: it goes on from a past, and writes into it.

        Args:
            past: what it has kept so far; empty before the first row.
        """
        found = self.model_copy()
        found._past = past
        return found

    @property
    def past(self) -> Past:
        """What it keeps of the rows so far: nothing where rows are simulated all at once."""
        return {} if self._past is None else self._past

    @property
    def hindrance(self) -> str:
        """Why its rows cannot be followed without those before; empty where they can."""
        if self.onset is not None and self.end is None and self.profile == "ramp":
            return "a ramp without an end is full in the last row, and there is always another"
        if self.remembers and not self.keeps_past:
            return f"the kind {self.kind} does not say what it keeps of the rows before"
        return ""

    def weight(self, time: FloatArray) -> FloatArray:
        """Share of the effect that is present at each time [s], float[rows] in 0..1."""
        if self.onset is None:
            return np.ones(len(time))
        onset = seconds(self.onset)
        if self.profile == "step":
            return (time >= onset).astype(float)
        end = float(time[-1]) if self.end is None else seconds(self.end)
        return np.clip((time - onset) / max(end - onset, 1e-12), 0.0, 1.0)

    def values(self, contexts: Mapping[str, FloatArray], rows: int) -> Values:
        """Parameter values of every row, the onset included."""
        resolved = {}
        weight = self.weight(contexts["time"]) if self.onset is not None else None
        for name, parameter in self.parameters().items():
            raw = getattr(self, name)
            if raw is None:
                continue
            value = resolve(raw, contexts, rows, parameter.neutral)
            if weight is not None and parameter.neutral is not None:
                value = blend(value, parameter.neutral, weight)
            resolved[name] = value
        return resolved

    def exact_for(self, values: Values) -> Self:
        """The same effect, without approximations for rows of these parameters.

        Args:
            values: parameters of the rows, others than which it is not asked for afterwards.
        """
        return self

    def swinging(self) -> "Effect | None":
        """What stands for it where the structure swings freely: itself if it changes that."""
        return self if self.structural else None

    def check(self, model: "Model") -> None:
        """Refuse a model that the effect does not fit (ValueError), beyond missing places."""

    def drivers(self) -> set[str]:
        """Context variables that drive parameters of this effect."""
        given = (getattr(self, name) for name in self.parameters())
        return {value.context for value in given if isinstance(value, Driven)}

    def change_contexts(self, contexts: Values, values: Values) -> None:
        """Turn measured contexts into true ones, in place."""

    def change_values(
        self, all_values: dict[str, Values], values: Values, time: FloatArray
    ) -> None:
        """Change parameter values of other effects, by effect name, in place."""

    def change_structure(self, structure: "Structure", value: Mapping[str, float]) -> None:
        """Change the structure, in place."""

    def loads(
        self, structure: "Structure", values: Values, others: dict[str, Values]
    ) -> list["Load"]:
        """Loads of this effect: patterns with a coefficient a row."""
        return []

    def change_loads(
        self, loads: dict[str, list["Load"]], structure: "Structure", values: Values
    ) -> None:
        """Change loads of other effects, by effect name, in place."""

    def frequency_factor(self, values: Values) -> FloatArray:
        """By which natural frequencies are read larger than they are, float[rows]."""
        return np.ones(len(next(iter(values.values()))))

    def change_readings(self, readings: "Readings", values: Values) -> None:
        """Change what the sensors of its place show, in place: all, where it names none."""


def blend(value: FloatArray, neutral: float, weight: FloatArray) -> FloatArray:
    """Between neutral (weight 0) and value (weight 1); in compliance where neutral is infinite."""
    if np.isinf(neutral):
        with np.errstate(divide="ignore"):
            return value / weight
    return neutral + weight * (value - neutral)


def check_moment(moment: float | str) -> None:
    """ValueError where this is no time that `seconds` reads."""
    try:
        known = bool(np.isfinite(seconds(moment)))
    except (ValueError, OverflowError):
        known = False
    if not known:
        raise ValueError(f"{moment!r} is no time: give seconds or ISO 8601")


def when_all_act(effects: Iterable["Effect"]) -> float | None:
    """A time [s] at which every effect has fully begun; None where none begins late."""
    moments = [one.end or one.onset for one in effects if one.onset is not None]
    return max(seconds(moment) for moment in moments if moment is not None) + 1 if moments else None


def seconds(moment: float | str) -> float:
    """A time of a record [s]: a number as it is, an ISO 8601 text since 1970 (UTC by default)."""
    if isinstance(moment, str):
        read = datetime.fromisoformat(moment)
        return (read if read.tzinfo else read.replace(tzinfo=UTC)).timestamp()
    return float(moment)
