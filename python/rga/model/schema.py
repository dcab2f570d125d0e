"""The model file: the structure as data, its contexts, its effects and its sensors."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, Union

from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    SerializeAsAny,
    TypeAdapter,
    ValidationInfo,
    field_validator,
    model_validator,
)

from rga.errors import InputError
from rga.model.effect import Effect, check_moment, seconds
from rga.model.parameter import SMALLEST, AboveZero, AnyNumber, NotNegative, Number, listed
from rga.model.pictured import Pictured
from rga.model.references import EVERYTHING_READ, Mistake, effect_mistakes, mistakes, refuse
from rga.model.units import UNITS
from rga.model.vocabulary import field_texts, kind_text
from rga.no_booleans import NO_BOOLEAN

#: key of what a file has besides, in the context of a validation
UNREAD = "unread"
DOFS = ("ux", "uy", "uz", "rx", "ry", "rz")
Dof = Literal["ux", "uy", "uz", "rx", "ry", "rz"]
Vector = tuple[Number, Number, Number]


class Part(BaseModel):
    """A part of a model file: unknown keys are refused."""

    model_config = ConfigDict(extra="forbid", frozen=True)


class About(Part):
    """Whom and what a model is for: the head of its reports.

    Attributes:
        client, structure, author, date, version: as they are to be printed.
    """

    client: str = ""
    structure: str = ""
    author: str = ""
    date: str = ""
    version: str = ""


class Material(Part):
    """E [Pa], nu [-], alpha [1/K], density [kg/m3].

    Attributes:
        yield_strength: [Pa]; stresses are set against it where it is given.
    """

    E: AboveZero
    nu: Annotated[float, Field(gt=-1, lt=0.5), NO_BOOLEAN] = 0.3
    alpha: Number = 0.0
    density: NotNegative = 0.0
    yield_strength: AboveZero | None = None


class Section(Part):
    """A [m2], second moments Iy and Iz [m4], torsion constant J [m4], shear areas [m2].

    Attributes:
        fibres: local y and z [m] of the points whose stresses are of interest, by name.
    """

    A: AboveZero
    Iy: NotNegative = 0.0
    Iz: NotNegative = 0.0
    J: NotNegative = 0.0
    Asy: AboveZero | None = None
    Asz: AboveZero | None = None
    fibres: dict[str, tuple[Number, Number]] = {}


class Ends(Part):
    """What each end of a member has: `i` is its first node, `j` its second."""

    @model_validator(mode="before")
    @classmethod
    def _named(cls, given: Any) -> Any:
        if isinstance(given, Mapping) and (
            others := [end for end in given if end not in cls.model_fields]
        ):
            raise ValueError(
                f"{others[0]!r} is no end of a member: i is that at its first node, j at its second"
            )
        return given


class Releases(Ends):
    """Degrees of freedom that the member does not pass on at its ends, in local axes."""

    i: list[Dof] = []
    j: list[Dof] = []


class EndSprings(Ends):
    """Stiffness of the connection of the member's ends, in local axes [N m/rad or N/m]."""

    i: dict[Dof, AboveZero] = {}
    j: dict[Dof, AboveZero] = {}


class Member(Part):
    """A straight member between two nodes: `truss` (axial) or `frame`."""

    nodes: tuple[str, str]
    section: str
    material: str
    kind: Literal["truss", "frame"] = "truss"
    groups: list[str] = []
    local_y: Vector | None = None
    releases: Releases = Releases()
    end_springs: EndSprings = EndSprings()


class Support(Part):
    """A support: fixed degrees of freedom of a node, or the direction in which it is held."""

    node: str
    fixed: list[Dof] = []
    along: Vector | None = None


class Spring(Part):
    """A spring from a node to the ground, or between two nodes [N/m or N m/rad]."""

    node: str
    to: str | None = None
    dof: Dof
    stiffness: AboveZero


class Tie(Part):
    """Two nodes that share the degrees of freedom named."""

    nodes: tuple[str, str]
    dofs: list[Dof]


class Mass(Part):
    """A mass on a node [kg]; statics has no use for it.

    Attributes:
        inertia: about the global axes [kg m2].
    """

    node: str
    mass: NotNegative
    inertia: tuple[Number, Number, Number] = (0.0, 0.0, 0.0)


class ContextVariable(Part):
    """What changes from record to record.

    Attributes:
        range: prior of a latent variable, range of validity of a measured one.
        noise: standard deviation of its measurement; None: estimated.
        law: how a latent variable moves; rate bounds the law `linear` [unit/s].
    """

    unit: str
    range: tuple[Number, Number]
    noise: AboveZero | None = None
    law: Literal["independent", "constant", "linear", "smooth"] = "independent"
    rate: tuple[Number, Number] | None = None

    @model_validator(mode="after")
    def _ordered(self) -> "ContextVariable":
        if not self.range[0] < self.range[1]:
            raise ValueError(f"range {list(self.range)} must grow: [smallest, largest]")
        if self.law == "linear" and self.rate is None:
            raise ValueError("the law 'linear' needs a rate: [smallest, largest] per second")
        if self.noise and not 1e-12 <= self.noise / (self.range[1] - self.range[0]) <= 1e6:
            raise ValueError(f"a noise of {self.noise:g} is none beside the range: state another")
        return self


class Sensor(Part):
    """A sensor; `direction` for displacement, rotation and reaction, `member` for strain and force.

    Attributes:
        at: place along the member, 0..1; y, z: fibre of a frame member [m].
        total: a strain that contains thermal expansion.
        zero: the logger's mean over this time was taken off.
        noise: standard deviation of one reading [unit]; None: estimated.
    """

    kind: Literal["displacement", "rotation", "strain", "force", "reaction"]
    unit: str
    node: str | None = None
    direction: Vector | None = None
    relative_to: str | None = None
    member: str | None = None
    at: Annotated[float, Field(ge=0, le=1), NO_BOOLEAN] = 0.5
    y: Number = 0.0
    z: Number = 0.0
    total: bool = False
    zero: tuple[AnyNumber | str, AnyNumber | str] | None = None
    noise: AboveZero | None = None
    groups: list[str] = []

    @field_validator("zero")
    @classmethod
    def _times(
        cls, zero: tuple[float | str, float | str] | None
    ) -> tuple[float | str, float | str] | None:
        for moment in zero or ():
            check_moment(moment)
        if zero and seconds(zero[1]) < seconds(zero[0]):
            raise ValueError("the times run backwards: give [from, to]")
        return zero

    @model_validator(mode="after")
    def _complete(self) -> "Sensor":
        if self.unit not in UNITS[self.kind]:
            raise ValueError(
                f"the unit {self.unit!r} is not one of a {self.kind} sensor; use "
                + ", ".join(UNITS[self.kind])
            )
        if self.kind in ("strain", "force"):
            if self.member is None:
                raise ValueError(f"a {self.kind} sensor needs 'member'")
        elif self.node is None or self.direction is None:
            lacking = [name for name in ("node", "direction") if getattr(self, name) is None]
            raise ValueError(f"a {self.kind} sensor needs {' and '.join(map(repr, lacking))}")
        elif max(map(abs, self.direction)) < SMALLEST:
            raise ValueError(f"the direction {list(self.direction)} points nowhere")
        return self


class Analysis(Part):
    """How the structure is analysed.

    Attributes:
        geometry: `linear`: equilibrium of the structure as drawn; `nonlinear`: of the deformed
            one, where tension stiffens, compression softens and buckles.
    """

    geometry: Literal["linear", "nonlinear"] = "linear"


def _unknown_kind(effect: Any) -> Iterator[Mistake]:
    kind = effect.get("kind") if isinstance(effect, dict) else None
    if not isinstance(kind, str) or kind not in Effect.vocabulary:
        known = ", ".join(sorted(Effect.vocabulary))
        yield ("kind",), f"{kind!r} is no kind of effect; known are {known}"


def _of_vocabulary(effect: Any) -> Effect:
    if isinstance(effect, Effect):
        return effect
    refuse("Effect", _unknown_kind(effect), "unknown_kind")
    return Effect.vocabulary[effect["kind"]].model_validate(effect)


class Model(Pictured, Part):
    """A model file. SI units, z up, tension and elongation positive; docs explain its keys.

    Raises on validation: unknown keys, members between missing nodes, places that do not exist.

    Attributes:
        schema_file: the JSON Schema by which an editor completes the file (`"$schema"`).
    """

    model_config = ConfigDict(serialize_by_alias=True, validate_by_name=True)

    schema_file: Annotated[str | None, Field(alias="$schema")] = None
    rga_model: Annotated[Literal[1], NO_BOOLEAN]
    name: str
    about: About = About()
    plane: Literal["xy", "xz", "yz"] | None = None
    materials: dict[str, Material]
    sections: dict[str, Section]
    nodes: dict[str, Vector]
    members: dict[str, Member]
    supports: dict[str, Support]
    springs: list[Spring] = []
    ties: list[Tie] = []
    masses: dict[str, Mass] = {}
    context: dict[str, ContextVariable] = {}
    effects: dict[str, Annotated[SerializeAsAny[Effect], BeforeValidator(_of_vocabulary)]] = {}
    sensors: dict[str, Sensor] = {}
    analysis: Analysis = Analysis()

    _sha256: str = PrivateAttr(default="")
    _path: Path | None = PrivateAttr(default=None)

    @model_validator(mode="after")
    def _references(self, info: ValidationInfo) -> "Model":
        unread = (info.context or {}).get(UNREAD, EVERYTHING_READ)
        refuse("Model", mistakes(self, unread))
        return self

    def check_effect(self, effect: Effect, where: str) -> None:
        """Refuse an effect whose place or driving context is not in the model (ValueError)."""
        for place, what in effect_mistakes(self, effect, (where,)):
            raise ValueError(f"{'.'.join(place)}: {what}")

    @cached_property
    def groups(self) -> dict[str, list[str]]:
        """Members of each group, in the order of the file."""
        found: dict[str, list[str]] = {}
        for name, member in self.members.items():
            for group in member.groups:
                found.setdefault(group, []).append(name)
        return found

    @property
    def sha256(self) -> str:
        """Hash of the file the model came from; empty for a model made in memory."""
        return self._sha256

    @property
    def path(self) -> Path | None:
        """The file the model came from."""
        return self._path

    def with_sensors(self, sensors: dict[str, Sensor]) -> "Model":
        """The same structure with other sensors, without the effects on those that it then lacks.

        An effect on a sensor stays where that very sensor does, not another under its name.
        """

        def stays(effect: Effect) -> bool:
            return all(
                name in sensors and sensors[name] == self.sensors.get(name)
                for field, mark in effect.place_fields().items()
                if mark.of == "sensor"
                for name in listed(effect.place.get(field))
            )

        effects = {name: effect for name, effect in self.effects.items() if stays(effect)}
        return self.model_copy(update={"sensors": sensors, "effects": effects})

    def without_zeros(self) -> "Model":
        """The same model with sensors from which no logger's zero is taken off."""
        if all(sensor.zero is None for sensor in self.sensors.values()):
            return self
        untared = {n: one.model_copy(update={"zero": None}) for n, one in self.sensors.items()}
        return self.model_copy(update={"sensors": untared})

    def extended(self, effects: dict[str, Effect]) -> "Model":
        """The same model with more effects; refuses those that do not fit it."""
        self.check_effects(effects)
        return self.model_copy(update={"effects": {**self.effects, **effects}})

    def check_effects(self, effects: Mapping[str, Effect]) -> None:
        """Refuse effects that do not fit the model (InputError)."""
        for name, effect in effects.items():
            try:
                self.check_effect(effect, f"effects.{name}")
            except ValueError as error:
                raise InputError(str(error), f"model {self.name!r}", "name a part it has") from None


def read_effect(effect: Any, name: str) -> Effect:
    """An effect of the vocabulary from its keys; ValueError where the kind is unknown."""
    if not isinstance(effect, Effect):
        for place, what in _unknown_kind(effect):
            raise ValueError(f"effects.{name}.{'.'.join(place)}: {what}")
    return _of_vocabulary(effect)


def model_schema() -> dict[str, Any]:
    """JSON Schema of a model file, the kinds of effects in it."""
    schema = Model.model_json_schema()
    kinds: Any = Union[tuple(Effect.vocabulary.values())]  # noqa: UP007
    effects = TypeAdapter(kinds).json_schema()
    for definition in effects["$defs"].values():
        properties = definition.get("properties", {})
        for entry in properties.values():
            if entry.get("default") == float("inf"):
                del entry["default"]  # JSON has no infinity
        if "kind" in properties:
            kind = Effect.vocabulary[properties["kind"]["default"]]
            definition["required"] = sorted({"kind", *definition.get("required", [])})
            definition["description"] = kind_text(kind)
            for name, text in field_texts(kind).items():
                properties[name]["description"] = text
    schema["$defs"] = {**schema["$defs"], **effects.pop("$defs")}
    schema["$defs"].pop("Effect", None)
    schema["properties"]["effects"]["additionalProperties"] = effects
    return schema
