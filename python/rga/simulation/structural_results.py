"""Results of a structure: displacements, reactions, section forces and stresses."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import polars as pl
from numpy.typing import ArrayLike

from rga._core import OutputKind
from rga.arrays import FloatArray, OutputArrays
from rga.errors import InputError
from rga.files import write_table
from rga.model import as_model
from rga.model.effect import Values, when_all_act
from rga.model.schema import DOFS, Model
from rga.model.structure import Load, Structure, build_structure
from rga.notebook import short_html
from rga.quantities import counted
from rga.simulation.contexts import Contexts, contexts_by_name
from rga.simulation.critical_places import ForcesAlong
from rga.simulation.outputs import joined, node_outputs, section_outputs
from rga.simulation.paths.response import respond
from rga.simulation.simulator import Response, Simulator
from rga.simulation.stresses import Stresses, section_stresses

if TYPE_CHECKING:
    from matplotlib.axes import Axes

#: components of a section force, and of a reaction
SECTION_FORCES = ("N", "Vy", "Vz", "T", "My", "Mz")
REACTIONS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
#: numbers that one call may return: 0.8 GB
MOST = 100_000_000
#: stations that may be asked for: extremes are found between them as well
MOST_STATIONS = 10_001


@dataclass(frozen=True)
class Results:
    """What a structure does under contexts, in SI units.

    Section forces are what the part beyond a section does to the part before it, in the local axes
    of the member: N is positive in tension, My stretches fibres at +z and Mz fibres at -y, so
    that the stress at (y, z) is N / A + My z / Iy - Mz y / Iz. For a level member with the default
    axes z points up: a sagging beam has a negative My.

    Attributes:
        model: the model.
        contexts: the contexts, float[rows] each, `time` [s] among them where it was given.
        stations: places along every member, 0..1, float[stations].
        displacements: ux, uy, uz [m], rx, ry, rz [rad] of the nodes, float[rows, nodes, 6].
        held: nodes that supports or springs to the ground hold.
        reactions: Fx, Fy, Fz [N], Mx, My, Mz [N m] of these, float[rows, held, 6].
        section_forces: N, Vy, Vz [N], T, My, Mz [N m], float[rows, members, stations, 6].
        parameters: of all effects, by name, float[rows] each.
    """

    model: Model
    contexts: Values
    stations: FloatArray
    displacements: FloatArray
    held: tuple[str, ...]
    reactions: FloatArray
    section_forces: FloatArray
    parameters: dict[str, Values]

    @cached_property
    def along(self) -> ForcesAlong:
        """Section forces everywhere along the members, between stations too."""
        members, forces = list(self.model.members), self.section_forces
        return forces_along(self.model, self.contexts, members, forces, self.parameters)

    @cached_property
    def stresses(self) -> Stresses:
        """Stresses at the fibres of the sections, by member."""
        return section_stresses(self.section_forces, self.along)

    def plot(self, ax: "Axes | None" = None, *, row: int = 1, **shown: Any) -> "Axes":
        """The deformed shape of a row, or with `forces="M"` a diagram, in axes of matplotlib.

        Args:
            ax: axes; None: those of a new figure.
            row: of the contexts, from 1.
            shown: what is to be seen, as for `rga.plot_results`.

        Raises:
            InputError: as for `rga.plot_results`.
        """
        # What draws stands above the simulation: it is reached through the front of the package.
        import rga

        return rga.plot_results(self, ax, row=row, **shown)

    def _repr_html_(self) -> str:
        said = (
            f"{counted(len(self.displacements), 'row')}; the extremes of every member [N, N m, Pa]"
        )
        return short_html(self.model.name, said, self.members())

    def __repr__(self) -> str:
        rows = counted(len(self.displacements), "row")
        members = counted(len(self.model.members), "member")
        return f"Results of {self.model.name!r}: {rows}, {members}"

    def members(self, row: int | None = None) -> pl.DataFrame:
        """The extremes of every member, however many stations there are, one line a member.

        Columns: member, N min, N max, V max [N], M max [N m], stress min, stress max [Pa], and the
        utilisation: the largest stress over the yield strength where the material states one,
        else null. It says nothing of buckling. V and M are the larger of the two planes,
        without sign. Where a member may bend and its section states no fibres, its stresses are
        not known, and null.

        Args:
            row: of the contexts, from 1; None: of all rows.

        Raises:
            InputError: a row that there is not.
        """
        rows = len(self.displacements)
        if row is not None and not 1 <= row <= rows:
            raise InputError(f"there is no row {row}", "results", f"give 1 to {rows}")
        chosen = slice(None) if row is None else slice(row - 1, row)
        forces, (lowest, highest) = self.along.limits(chosen), self.stresses.extremes(chosen)
        sizes = np.abs(forces).max(axis=(0, 3))
        strength = [
            self.model.materials[member.material].yield_strength
            for member in self.model.members.values()
        ]
        known = [
            member.kind != "frame" or bool(self.model.sections[member.section].fibres)
            for member in self.model.members.values()
        ]
        worst = np.maximum(np.abs(lowest), np.abs(highest))
        table = pl.DataFrame(
            {
                "member": list(self.model.members),
                "N min": forces[..., 0, 0].min(axis=0),
                "N max": forces[..., 0, 1].max(axis=0),
                "V max": sizes[:, 1:3].max(axis=1),
                "M max": sizes[:, 4:].max(axis=1),
                "stress min": lowest,
                "stress max": highest,
                "utilisation": [
                    None if limit is None else float(size / limit)
                    for size, limit in zip(worst, strength, strict=True)
                ],
                "known": known,
            },
            schema_overrides={"utilisation": pl.Float64},
        )
        stresses = pl.col("stress min", "stress max", "utilisation")
        return table.with_columns(pl.when("known").then(stresses)).drop("known")

    def to_frame(self) -> pl.DataFrame:
        """All results in one table: row, time, quantity, of, at, value, unit.

        `of` is a node or a member, `at` a place along a member, else null, as is a time that was
        not given. Quantities are those of the attributes; a stress is named after its fibre.
        """
        nodes, members = list(self.model.nodes), list(self.model.members)
        force, moment = ["N"] * 3, ["N m"] * 3
        every_fibre = dict.fromkeys(
            fibre for fibres in self.stresses.of_members.values() for fibre in fibres
        )
        parts = [
            self._long(self.displacements, nodes, DOFS, ["m"] * 3 + ["rad"] * 3),
            self._long(self.reactions, list(self.held), REACTIONS, force + moment),
            self._long(self.section_forces, members, SECTION_FORCES, force + moment),
        ]
        for fibre in every_fibre:
            having = [name for name in members if fibre in self.stresses.of_members[name]]
            values = np.stack([self.stresses.of_members[name][fibre] for name in having], axis=1)
            parts.append(self._long(values[..., None], having, (f"stress {fibre}",), ["Pa"]))
        return pl.concat(parts)

    def write(self, path: str | Path) -> None:
        """Write the table of `to_frame` as CSV or Parquet.

        Raises:
            InputError: another format, or a place that cannot be written to.
        """
        write_table(self.to_frame(), path)

    def _long(
        self, values: FloatArray, places: list[str], names: tuple[str, ...], units: list[str]
    ) -> pl.DataFrame:
        """Values float[rows, places, (stations,) names] as a table with one value a line."""
        rows, count = len(values), len(places)
        time = self.contexts.get("time", np.full(rows, np.nan))
        at = self.stations if values.ndim == 4 else np.array([np.nan])
        # One axis each of rows, places, stations and quantities.
        shape = (rows, count, len(at), len(names))

        def spread(column: Any, axis: int) -> Any:
            along = [1, 1, 1, 1]
            along[axis] = -1
            return np.broadcast_to(np.reshape(column, along), shape).ravel()

        return pl.DataFrame(
            {
                "row": spread(np.arange(1, rows + 1), 0),
                "time": spread(time, 0),
                "quantity": spread(np.array(names), 3),
                "of": spread(np.array(places), 1),
                "at": spread(at, 2),
                "value": values.ravel(),
                "unit": spread(np.array(units), 3),
            }
        ).with_columns(pl.col("time", "at").fill_nan(None))


def results(
    model: Model | str | Path,
    contexts: Contexts | None = None,
    *,
    stations: int = 11,
) -> Results:
    """Displacements, reactions, section forces and stresses under contexts.

    Args:
        model: the structure with its effects, or its file.
        contexts: as for `Simulator.predict`; None for a model that no context drives. Without
            `time` all effects act, those too that begin late.
        stations: places along each member, its two ends among them: 2 to 10001.

    Raises:
        InputError: as `Simulator.predict`; another number of stations, or more numbers than fit.
        UnstableStructureError: the structure can move; names node and direction.
    """
    model = as_model(model)
    held = held_nodes(model)
    places = _places(stations)

    def wanted(structure: Structure) -> OutputArrays:
        at_held = [structure.nodes[node] for node in held]
        return joined(
            node_outputs(
                list(structure.nodes.values()), OutputKind.DISPLACEMENT, OutputKind.ROTATION
            ),
            node_outputs(at_held, OutputKind.REACTION_FORCE, OutputKind.REACTION_MOMENT),
            section_outputs(list(structure.members.values()), places),
        )

    given = {} if contexts is None else contexts_by_name(contexts, model.context)
    nodes, members = len(model.nodes), len(model.members)
    response = _respond(model, given, wanted, 6 * (nodes + len(held) + members * stations))
    found = response.quantities
    rows = len(found)
    motions, reactions, forces = np.split(found, np.cumsum([6 * nodes, 6 * len(held)]), axis=1)
    return Results(
        model=model,
        contexts={
            name: column
            for name, column in response.contexts.items()
            if name != "time" or name in given
        },
        stations=places,
        displacements=motions.reshape(rows, nodes, 6),
        held=held,
        reactions=reactions.reshape(rows, len(held), 6),
        section_forces=forces.reshape(rows, members, stations, 6),
        parameters=response.values,
    )


def forces_of_members(
    model: Model, contexts: Mapping[str, ArrayLike], members: Sequence[str], *, stations: int = 11
) -> tuple[FloatArray, dict[str, Values]]:
    """Section forces of some members alone, where those of all would be too many.

    Args:
        model: the structure with its effects.
        contexts: as for `results`, with the same errors.
        members: names.
        stations: as for `results`.

    Returns:
        N, Vy, Vz [N], T, My, Mz [N m], float[rows, members, stations, 6], and the parameters of all
        effects, by name.
    """
    places = _places(stations)

    def wanted(structure: Structure) -> OutputArrays:
        return section_outputs([structure.members[name] for name in members], places)

    response = _respond(model, contexts, wanted, 6 * len(members) * stations)
    shape = (len(response.quantities), len(members), stations, 6)
    return response.quantities.reshape(shape), response.values


def forces_along(
    model: Model,
    contexts: Mapping[str, ArrayLike],
    members: Sequence[str],
    section_forces: FloatArray,
    parameters: dict[str, Values],
) -> ForcesAlong:
    """Section forces everywhere along members, from those that were solved for.

    Args:
        model: the structure with its effects.
        contexts: as for `results`.
        members: names.
        section_forces: of these, as `forces_of_members` gives them.
        parameters: of all effects, by name.
    """
    first, four = section_forces[:, :, 0], section_forces
    if model.analysis.geometry == "linear":
        return ForcesAlong(model, members, first, parameters)
    if section_forces.shape[2] != 4:
        four, _ = forces_of_members(model, contexts, members, stations=4)
    return ForcesAlong(model, members, first, parameters, thirds=four[:, :, 1:3])


def held_nodes(model: Model) -> tuple[str, ...]:
    """Nodes that supports or springs to the ground hold, in the order of the model."""
    supported = {support.node for support in model.supports.values()}
    supported |= {spring.node for spring in model.springs if spring.to is None}
    return tuple(node for node in model.nodes if node in supported)


def _places(stations: int) -> FloatArray:
    whole = isinstance(stations, (int, np.integer)) and not isinstance(stations, bool)
    if not whole or not 2 <= stations <= MOST_STATIONS:
        what = f"a member cannot have {stations!r} stations"
        raise InputError(what, "stations", f"give a whole number from 2 to {MOST_STATIONS}")
    return np.linspace(0.0, 1.0, stations)


def _respond(
    model: Model,
    contexts: Mapping[str, ArrayLike],
    wanted: Callable[[Structure], OutputArrays],
    count: int,
) -> Response:
    """The response of a model of which other things are read than what its sensors show.

    Args:
        model, contexts: as for `results`.
        wanted: what is read.
        count: of its numbers in a row.
    """
    rows = max((np.size(column) for column in contexts.values()), default=1)
    if rows * count > MOST:
        at_a_time = f"{counted(MOST // count, 'row')} or fewer at a time, or "
        raise InputError(
            f"{counted(rows, 'row')} of {count} results are more than fit into memory",
            "results",
            f"give {at_a_time if count <= MOST else ''}fewer stations",
        )
    bare = {name: one for name, one in model.effects.items() if not one.at_sensors()}
    begun = when_all_act(bare.values())
    if begun is not None and "time" not in contexts:
        contexts = {**contexts, "time": begun}
    silent = model.model_copy(update={"sensors": {}, "effects": bare})
    structure = build_structure(silent)
    outputs = wanted(structure)
    structure.outputs, structure.per_si = outputs, np.ones(count)
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        values = Simulator(silent, structure).parameters(contexts)
        exact = {name: one.exact_for(values[name]) for name, one in silent.effects.items()}
        loaded = silent.model_copy(update={"effects": exact})
        response = Simulator(loaded, structure).respond(contexts)
    if not response.plan.patterns:
        # Without a load nothing was solved: a structure that can move would look calm.
        respond(structure, [Load(np.ones(1))], outputs)
    if not np.isfinite(response.quantities).all():
        row = int(np.argwhere(~np.isfinite(response.quantities))[0, 0])
        raise InputError(
            "a result is no finite number",
            f"contexts, row {row + 1}",
            "check the sizes of contexts and effects",
        )
    return response
