"""The model file: the structure as data, its contexts, its effects and its sensors."""

from collections.abc import Iterator, Mapping
from functools import cached_property
from pathlib import Path
from typing import Annotated, Any, Literal, Union

from pydantic import (
    BeforeValidator,
    ConfigDict,
    Field,
    PrivateAttr,
    SerializeAsAny,
    TypeAdapter,
    ValidationInfo,
    model_validator,
)

from rga.errors import InputError
from rga.model.effect import Effect
from rga.model.parameter import listed
from rga.model.pictured import Pictured
from rga.model.references import EVERYTHING_READ, Mistake, effect_mistakes, mistakes, refuse
from rga.model.schema.context_variable import ContextVariable
from rga.model.schema.modal import ExpectedMode, MeasuringPoint, ModalSensor, is_modal
from rga.model.schema.parts import (
    About,
    Mass,
    Material,
    Member,
    Part,
    Section,
    Spring,
    Support,
    Tie,
    Vector,
)  # fmt: skip
from rga.model.schema.sensor import Sensor
from rga.model.vocabulary import field_texts, kind_text
from rga.no_booleans import NO_BOOLEAN

#: key of what a file has besides, in the context of a validation
UNREAD = "unread"


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
        sensors: of what the structure does under loads.
        modal_sensors: of its natural frequencies and mode shapes; they stand among `sensors` in the
            file.
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
    points: dict[str, MeasuringPoint] = {}
    modes: dict[str, ExpectedMode] = {}
    sensors: dict[str, Sensor] = {}
    modal_sensors: dict[str, ModalSensor] = {}
    analysis: Analysis = Analysis()

    _sha256: str = PrivateAttr(default="")
    _path: Path | None = PrivateAttr(default=None)

    @model_validator(mode="before")
    @classmethod
    def _sensors_apart(cls, given: Any) -> Any:
        if not isinstance(given, dict) or not isinstance(given.get("sensors"), Mapping):
            return given
        modal = {name: one for name, one in given["sensors"].items() if is_modal(one)}
        if not modal:
            return given
        static = {name: one for name, one in given["sensors"].items() if name not in modal}
        return {**given, "sensors": static, "modal_sensors": modal}

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
    sensors = schema["properties"]["sensors"]
    modal = schema["properties"].pop("modal_sensors")
    sensors["additionalProperties"] = {
        "anyOf": [sensors["additionalProperties"], modal["additionalProperties"]]
    }
    schema["$defs"] = {**schema["$defs"], **effects.pop("$defs")}
    schema["$defs"].pop("Effect", None)
    schema["properties"]["effects"]["additionalProperties"] = effects
    return schema
