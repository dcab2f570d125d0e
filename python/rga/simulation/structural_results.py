"""Results of a structure: displacements, reactions, section forces and stresses."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from io import BytesIO
from pathlib import Path
from typing import Any

import numpy as np
import polars as pl
from numpy.typing import ArrayLike

from rga._core import OutputKind
from rga.arrays import FloatArray, OutputArrays
from rga.errors import InputError
from rga.files import write_whole
from rga.model.effect import Values
from rga.model.schema import DOFS, Model
from rga.model.structure import Load, Structure, build_structure
from rga.simulation.paths.response import respond
from rga.simulation.simulator import Simulator
from rga.simulation.stresses import Stresses, section_stresses

#: components of a section force, and of a reaction
SECTION_FORCES = ("N", "Vy", "Vz", "T", "My", "Mz")
REACTIONS = ("Fx", "Fy", "Fz", "Mx", "My", "Mz")
#: numbers that one call may return: 0.8 GB
MOST = 100_000_000


@dataclass(frozen=True)
class Results:
    """What a structure does under contexts, in SI units.

    Section forces are what the part beyond a section does to the part before it, in the local axes
    of the member: N is positive in tension, My stretches fibres at +z and Mz fibres at -y, so
    that the stress at (y, z) is N / A + My z / Iy - Mz y / Iz. For a level member with the default
    axes z points up: a sagging beam has a negative My.

    Attributes:
        model: the model.
        contexts: the contexts, float[rows] each, `time` [s] among them.
        stations: places along every member, 0..1, float[stations].
        displacements: ux, uy, uz [m], rx, ry, rz [rad] of the nodes, float[rows, nodes, 6].
        held: nodes that supports or springs to the ground hold.
        reactions: Fx, Fy, Fz [N], Mx, My, Mz [N m] of these, float[rows, held, 6].
        section_forces: N, Vy, Vz [N], T, My, Mz [N m], float[rows, members, stations, 6].
    """

    model: Model
    contexts: Values
    stations: FloatArray
    displacements: FloatArray
    held: tuple[str, ...]
    reactions: FloatArray
    section_forces: FloatArray
    _parameters: dict[str, Values]

    @cached_property
    def stresses(self) -> Stresses:
        """Stresses at the fibres of the sections, by member."""
        return section_stresses(self.model, self.section_forces, self._parameters)

    def members(self) -> pl.DataFrame:
        """The extremes of every member over all rows and stations, one row a member.

        Columns: member, N min, N max, V max [N], M max [N m], stress min, stress max [Pa], and the
        utilisation where the material states a yield strength, else null. V and M are the
        larger of the two planes, without sign.
        """
        forces, lowest, highest = self.section_forces, *self.stresses.extremes()
        axial = forces[..., 0]
        strength = [
            self.model.materials[member.material].yield_strength
            for member in self.model.members.values()
        ]
        worst = np.maximum(np.abs(lowest), np.abs(highest))
        return pl.DataFrame(
            {
                "member": list(self.model.members),
                "N min": axial.min(axis=(0, 2)),
                "N max": axial.max(axis=(0, 2)),
                "V max": np.abs(forces[..., 1:3]).max(axis=(0, 2, 3)),
                "M max": np.abs(forces[..., 4:]).max(axis=(0, 2, 3)),
                "stress min": lowest,
                "stress max": highest,
                "utilisation": [
                    None if limit is None else float(size / limit)
                    for size, limit in zip(worst, strength, strict=True)
                ],
            }
        )

    def to_frame(self) -> pl.DataFrame:
        """All results in one table: row, time, quantity, of, at, value, unit.

        `of` is a node or a member, `at` a place along a member, else null. Quantities are those of
        the attributes; a stress is named after its fibre.
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
        path = Path(path)
        frame = self.to_frame()
        if path.suffix.lower() == ".csv":
            content = frame.write_csv().encode()
        elif path.suffix.lower() == ".parquet":
            buffer = BytesIO()
            frame.write_parquet(buffer)
            content = buffer.getvalue()
        else:
            raise InputError(
                f"{path.suffix!r} is no format of results", str(path), "name a .csv or .parquet"
            )
        write_whole({path: content})

    def _long(
        self, values: FloatArray, places: list[str], names: tuple[str, ...], units: list[str]
    ) -> pl.DataFrame:
        """Values float[rows, places, (stations,) names] as a table with one value a line."""
        rows, count = len(values), len(places)
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
                "time": spread(self.contexts["time"], 0),
                "quantity": spread(np.array(names), 3),
                "of": spread(np.array(places), 1),
                "at": spread(at, 2),
                "value": values.ravel(),
                "unit": spread(np.array(units), 3),
            }
        ).with_columns(pl.col("at").fill_nan(None))


def results(
    model: Model, contexts: Mapping[str, ArrayLike] | None = None, *, stations: int = 11
) -> Results:
    """Displacements, reactions, section forces and stresses under contexts.

    Args:
        model: the structure with its effects.
        contexts: as for `Simulator.predict`; None for a model that no context drives.
        stations: places along each member, its two ends among them.

    Raises:
        InputError: as `Simulator.predict`; fewer than two stations, or more numbers than fit.
        UnstableStructureError: the structure can move; names node and direction.
    """
    if stations < 2:
        raise InputError(f"{stations} stations are too few", "results", "give two or more")
    bare = {name: one for name, one in model.effects.items() if not one.at_sensors()}
    silent = model.model_copy(update={"sensors": {}, "effects": bare})
    structure = build_structure(silent)
    places = np.linspace(0.0, 1.0, stations)
    held = held_nodes(model)
    outputs = whole_response(structure, [structure.nodes[node] for node in held], places)
    structure.outputs, structure.per_si = outputs, np.ones(len(outputs["kind"]))
    rows = max((np.size(column) for column in (contexts or {}).values()), default=1)
    if rows * len(outputs["kind"]) > MOST:
        raise InputError(
            f"{rows} rows of {len(outputs['kind'])} results are more than fit into memory",
            "results",
            f"give {MOST // len(outputs['kind'])} rows or fewer at a time, or fewer stations",
        )
    with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
        response = Simulator(silent, structure).respond(contexts or {})
    if not response.plan.patterns:
        # Without a load nothing was solved: a structure that can move would look calm.
        respond(structure, [Load(np.ones(1))], outputs)
    found = response.quantities
    if not np.isfinite(found).all():
        row = int(np.argwhere(~np.isfinite(found))[0, 0])
        raise InputError(
            "a result is no finite number",
            f"contexts, row {row + 1}",
            "check the sizes of contexts and effects",
        )
    rows, nodes, members = len(found), len(model.nodes), len(model.members)
    motions, reactions, forces = np.split(found, np.cumsum([6 * nodes, 6 * len(held)]), axis=1)
    return Results(
        model=model,
        contexts=response.contexts,
        stations=places,
        displacements=motions.reshape(rows, nodes, 6),
        held=held,
        reactions=reactions.reshape(rows, len(held), 6),
        section_forces=forces.reshape(rows, members, stations, 6),
        _parameters=response.values,
    )


def held_nodes(model: Model) -> tuple[str, ...]:
    """Nodes that supports or springs to the ground hold, in the order of the model."""
    supported = {support.node for support in model.supports.values()}
    supported |= {spring.node for spring in model.springs if spring.to is None}
    return tuple(node for node in model.nodes if node in supported)


def whole_response(structure: Structure, held: list[int], places: FloatArray) -> OutputArrays:
    """What the core is to read: motions of all nodes, reactions, section forces.

    Args:
        structure: of the model, without what effects add.
        held: numbers of the nodes whose reactions are wanted.
        places: along each member, 0..1, float[stations].
    """
    nodes, members = len(structure.nodes), len(structure.members)
    axes = np.eye(3)

    def of_nodes(numbers: ArrayLike, kinds: tuple[OutputKind, OutputKind]) -> list[FloatArray]:
        """Columns kind, index, other, vector of three directions of each kind, node by node."""
        numbers = np.asarray(numbers)
        count = len(numbers)
        kind = np.tile(np.repeat([int(one) for one in kinds], 3), count)
        return [kind, np.repeat(numbers, 6), np.full(6 * count, -1), np.tile(axes, (2 * count, 1))]

    count = members * len(places)
    vector = np.zeros((6 * count, 3))
    vector[:, 0] = np.tile(np.repeat(places, 6), members)
    sections = [
        np.full(6 * count, int(OutputKind.SECTION_FORCE)),
        np.repeat(np.arange(members), 6 * len(places)),
        np.tile(np.arange(6), count),
        vector,
    ]
    parts = (
        of_nodes(np.arange(nodes), (OutputKind.DISPLACEMENT, OutputKind.ROTATION)),
        of_nodes(held, (OutputKind.REACTION_FORCE, OutputKind.REACTION_MOMENT)),
        sections,
    )
    kind, index, other, vectors = (np.concatenate(columns) for columns in zip(*parts, strict=True))
    return {
        "kind": kind.astype(np.int64),
        "index": index.astype(np.int64),
        "other": other.astype(np.int64),
        "vector": vectors.astype(float),
        "total": np.zeros(len(kind), dtype=bool),
    }
