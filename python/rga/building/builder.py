"""A model file from Python, part by part."""

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import Any, Literal, Self

from rga.building.loads import Force, load_effects
from rga.building.mistakes import read_settled
from rga.building.parts import checked
from rga.building.quantities import Amount, amount, amounts, difference, kelvin
from rga.building.sensors import SensorKind, sensor_name, sensor_part
from rga.building.structure_builder import StructureBuilder
from rga.errors import InputError, kind_of
from rga.files import as_file
from rga.model.io import model_content, write_model
from rga.model.schema import ContextVariable, Model, Sensor


class ModelBuilder(StructureBuilder):
    """Collects the parts of a model, and builds the model of them.

    Numbers are in SI units; a quantity may be a text with its unit ("20 m", "3.2 kN") or one of
    pint as well. Parts are named by what they are: a node or a context before whatever names it, or
    after, as it comes. A wrong value is refused where it is given; what does not fit together is
    told by `build`, all of it at once.

    Args:
        name: of the model.
        plane: "xz", "xy" or "yz" for a model in that plane; what leaves it is held.
        about: whom it is for: client, structure, author, date, version.

    >>> beam = ModelBuilder("cantilever", plane="xz")
    >>> beam = beam.add_material("steel", "S355").add_section("beam", "IPE 200")
    >>> beam = beam.add_node("A", 0).add_node("B", "2.5 m")
    >>> beam = beam.add_member("A", "B", "beam", kind="frame").support("A", "fixed")
    >>> model = beam.load_case("weight", down={"B": "3 kN"}).build()
    >>> model.members["A-B"].material, model.effects["weight"].forces
    ('steel', {'B': [0.0, 0.0, -3000.0]})
    """

    @classmethod
    def of(cls, model: Model) -> "ModelBuilder":
        """A builder that goes on with a model."""
        builder = cls(model.name, model.plane)
        builder._content.update(model_content(model))
        return builder

    def context(
        self,
        name: str,
        unit: str,
        range: Sequence[Amount],
        *,
        noise: Amount | None = None,
        law: Literal["independent", "constant", "linear", "smooth"] = "independent",
        rate: Sequence[float] | None = None,
    ) -> Self:
        """A context variable, in a unit of its own that records have it in.

        Args:
            range: smallest and largest value; numbers are in the unit.
            noise: standard deviation of its measurement; left out, it is estimated.
            law, rate: how it moves where it is not measured; see the model format.
        """
        where = f"context {name!r}"
        given = {
            "unit": unit,
            "range": amounts(range, unit, f"range of {where}", 2),
            "noise": noise and difference(noise, unit, f"noise of {where}"),
            "law": law,
            "rate": rate,
        }
        return self._add("context", name, checked(ContextVariable, given, where))

    def temperature(
        self,
        context: str,
        reference: Amount = 0.0,
        groups: Iterable[str] | Mapping[str, float] | None = None,
        name: str = "warmth",
    ) -> Self:
        """Members that warm as a context does, from a reference on.

        Args:
            reference: the context's value at which nothing is strained; a text is converted to the
                context's unit, which is then to be known.
            groups: that warm, or how many kelvin each per kelvin; left out, all members.
        """
        variable = self._content["context"].get(context)
        where = f"temperature {name!r}"
        if variable is None and not isinstance(reference, int | float):
            raise InputError(f"there is no context {context!r} yet", where, "add it before")
        minus = amount(reference, variable["unit"] if variable else "", f"reference of {where}")
        warming = groups
        if warming is not None and not isinstance(warming, Mapping):
            warming = dict.fromkeys([warming] if isinstance(warming, str) else warming, 1.0)
        delta = {"context": context, "minus": minus}
        effect = {"kind": "temperature", "groups": warming and dict(warming), "delta": delta}
        return self._add("effects", name, effect)

    def load_case(
        self,
        name: str,
        *,
        forces: Mapping[str, Force] | None = None,
        down: Mapping[str, Amount] | None = None,
        uniform: Mapping[str, Force] | None = None,
        points: Mapping[str, tuple[Amount, Force]] | None = None,
        context: str | None = None,
        factor: float = 1.0,
    ) -> Self:
        """Loads that act together: one effect, or one a member where members carry several.

        Args:
            forces: node -> (fx, fy, fz) or (fx, fy, fz, mx, my, mz), in global axes [N, N m].
            down: node -> force downward [N].
            uniform: member or group -> (wx, wy, wz), in local axes [N/m].
            points: member or group -> (x from its first node [m], (Px, Py, Pz) in local axes [N]).
            context: variable that they follow; they are then what one unit of it brings.
            factor: on all of them.
        """
        follows: Any = factor if context is None else {"context": context, "times": factor}
        effects = load_effects(
            name, follows, forces or {}, down or {}, uniform or {}, points or {}, self._members_of
        )
        for effect, keys in effects.items():
            self._add("effects", effect, keys)
        return self

    def axles(
        self,
        name: str,
        path: Sequence[str],
        forces: Sequence[Amount],
        position: str | Amount,
        *,
        offsets: Sequence[Amount] = (0.0,),
        context: str | None = None,
        carried_by: Literal["nodes", "members"] | None = None,
    ) -> Self:
        """A train of axles on a path of nodes.

        Args:
            forces: axle loads, downward [N].
            position: where the first axle stands along the path [m]: a context, or a place.
            offsets: distance of each axle behind the first [m].
            context: variable that all of the forces are multiplied by.
            carried_by: what carries an axle between two nodes; left out, the frame member that
                joins them, or the nodes where none does.
        """
        where = f"axles {name!r}"
        follows = isinstance(position, str) and position[:1] not in "+-−.0123456789"
        keys: dict[str, Any] = {
            "kind": "axle_load",
            "path": list(path),
            "forces": amounts(list(forces), "N", f"forces of {where}", len(forces)),
            "offsets": amounts(list(offsets), "m", f"offsets of {where}", len(offsets)),
            "position": {"context": position} if follows else amount(position, "m", where),
            **({} if carried_by is None else {"carried_by": carried_by}),
        }
        if context is not None:
            keys["factor"] = {"context": context}
        return self._add("effects", name, keys)

    def effect(self, name: str, kind: str, **keys: Any) -> Self:
        """Any effect of the vocabulary, by the keys of the model file.

        Args:
            kind: such as "nodal_load".
            keys: of that kind: `effect("push", "nodal_load", forces={"B": [1000, 0, 0]})`.

        Raises:
            InputError: the kind is no text; a table of a model file, say.
        """
        if not isinstance(kind, str):
            raise InputError(
                f"{kind_of(kind)} is no kind of effect",
                f"effect {name!r}",
                f"write the kind, and its keys beside it: effect({name!r}, 'nodal_load', "
                "forces={'B': [1000, 0, 0]})",
            )
        return self._add("effects", name, {"kind": kind, **keys})

    def sensor(self, name: str, kind: SensorKind, **keys: Any) -> Self:
        """A sensor.

        Args:
            kind: "displacement", "rotation", "reaction" (with `node` and `direction`), "strain" or
                "force" (with `member`).
            keys: as in the model file, where `direction` may be a word ("z", "down"), `noise` a
                text with a unit, and `fibre` stands for `y` and `z`: a name of the section's. The
                unit left out is mm, mrad, microstrain or kN.
        """
        part = sensor_part(name, kind, keys, self._content)
        return self._add("sensors", name, checked(Sensor, part, f"sensor {name!r}"))

    def sensors(
        self, kind: SensorKind, places: str | Iterable[str], name: str | None = None, **keys: Any
    ) -> Self:
        """Alike sensors on several members or nodes.

        Args:
            places: their names, or that of a group: its members, or the nodes that they join.
            name: pattern of their names; left out, "S {place}" for strains, "D {place}" for
                displacements, and so on.
            keys: as of `sensor`.
        """
        at = "member" if kind in ("strain", "force") else "node"
        if isinstance(places, str):
            of_group = self._members_of if at == "member" else lambda group, _: self.nodes_in(group)
            places = of_group(places, f"{kind} sensors")
        for place in places:
            self.sensor(sensor_name(kind, name, place), kind, **{at: place}, **keys)
        return self

    def build(self) -> Model:
        """The model.

        Raises:
            InputError: what does not fit together, all of it.
        """
        content = {**self._content}
        content["members"] = {name: self._made(one) for name, one in content["members"].items()}
        content["effects"] = {name: self._warmed(one) for name, one in content["effects"].items()}
        return read_settled(content, self._where)

    def write(self, path: str | Path) -> Model:
        """Write the model file, whole or not at all, as JSON.

        Returns:
            The model.

        Raises:
            InputError: what does not fit together, or a file that cannot be written.
        """
        path = as_file(path)
        if path.suffix.lower() != ".json":
            raise InputError("models are written as JSON", str(path), "give a name in .json")
        model = self.build()
        write_model(model, path)
        return model

    def _made(self, member: dict[str, Any]) -> dict[str, Any]:
        """A member with its material."""
        materials = list(self._content["materials"])
        if member["material"] or len(materials) != 1:
            return member
        return {**member, "material": materials[0]}

    def _warmed(self, effect: dict[str, Any]) -> dict[str, Any]:
        """A temperature in kelvin, with its groups: each member's first, if none are named."""
        if effect["kind"] != "temperature":
            return effect
        variable = self._content["context"].get(effect["delta"]["context"])
        times = 1.0 if variable is None else kelvin(variable["unit"])
        if times != 1.0:
            effect = {**effect, "delta": {**effect["delta"], "times": times}}
        if effect["groups"] is not None:
            return effect
        members = self._content["members"]
        if bare := [name for name, one in members.items() if not one.get("groups")]:
            what = f"member {bare[0]!r} is in no group that could warm"
            raise InputError(what, self._where, "give members groups")
        return {**effect, "groups": {one["groups"][0]: 1.0 for one in members.values()}}
