"""Bearings with Coulomb friction: the response row after row, on condensed quantities."""

import numpy as np

from rga import _core
from rga._core import OutputKind
from rga.arrays import FloatArray, OutputArrays
from rga.errors import InputError
from rga.model.structure import Load, Structure
from rga.simulation.paths.response import respond

UP = (0.0, 0.0, 1.0)


def respond_with_friction(
    structure: Structure, loads: list[Load], rested: FloatArray | None
) -> tuple[FloatArray, FloatArray]:
    """Sensors under loads that follow each other in time, and where bearings then rest.

    Args:
        structure: with its bearings.
        loads: on it, with the coefficients of the rows.
        rested: where they rested in the row before, as `slid` has it.

    Returns:
        float[rows, sensors] in SI units, and float[2, bearings] as `slid` has it.
    """
    coefficients = np.column_stack([load.coefficient for load in loads])
    return slid(structure, coefficients, frictionless(structure, loads), rested)


def frictionless(structure: Structure, loads: list[Load]) -> FloatArray:
    """The structure under loads, then under unit forces at its bearings.

    Returns:
        float[loads + bearings, sensors + 2 bearings] in SI units: behind the sensors the motion of
        each bearing, then its vertical reaction.
    """
    unit = [
        Load(np.zeros(0), forces={bearing.node: np.eye(6)[bearing.dof]})
        for bearing in structure.bearings
    ]
    return respond(structure, [*loads, *unit], _with_bearings(structure))


def slid(
    structure: Structure,
    coefficients: FloatArray,
    response: FloatArray,
    rested: FloatArray | None = None,
) -> tuple[FloatArray, FloatArray]:
    """Sensors as friction makes them, row after row, and where bearings rest in the last.

    The friction force of each bearing is bounded by mu times the vertical reaction plus the
    permanent force; both follow from the response to unit forces at the bearings.

    Args:
        structure: with its bearings.
        coefficients: of the load patterns, float[rows, patterns].
        response: without friction, as `frictionless` has it.
        rested: where bearings rested in the row before; None: there was none, and the first row is
            without friction, as what is locked in before it is not known.

    Returns:
        float[rows, sensors] in SI units; and the motion without friction of each bearing [m], then
        its friction force [N], in the last row, float[2, bearings].

    Raises:
        InputError: friction forces do not settle.
    """
    bearings, patterns = structure.bearings, coefficients.shape[1]
    free = coefficients @ response[:patterns]
    influence = response[patterns:]
    count = len(structure.outputs["kind"])
    slide, normal = count, count + len(bearings)
    motion = np.ascontiguousarray(free[:, slide:normal])
    before = np.stack([motion[0], np.zeros(len(bearings))]) if rested is None else rested
    permanent = np.array([bearing.permanent_force for bearing in bearings])
    try:
        force = _core.slide(
            motion,
            np.ascontiguousarray(influence[:, slide:normal].T),
            np.ascontiguousarray(free[:, normal:] + permanent),
            np.ascontiguousarray(influence[:, normal:].T),
            np.array([bearing.mu for bearing in bearings]),
            before,
        )
    except (_core.NotConverged, _core.InvalidInput) as error:
        raise InputError(
            str(error), "bearings with friction", "check mu and the supports"
        ) from None
    # What a bearing does to the structure is a part of the reaction there.
    own = influence[:, :count] + _own_reactions(structure)
    return np.asarray(free[:, :count] + force @ own), np.stack([motion[-1], force[-1]])


def _own_reactions(structure: Structure) -> FloatArray:
    """What reaction sensors read of a unit force at a bearing, float[bearings, sensors]."""
    outputs = structure.outputs
    reacts = outputs["kind"] == OutputKind.REACTION_FORCE
    return np.array(
        [
            np.where(reacts & (outputs["index"] == one.node), outputs["vector"][:, one.dof], 0.0)
            for one in structure.bearings
        ]
    )


def _with_bearings(structure: Structure) -> OutputArrays:
    bearings = structure.bearings
    nodes = np.array([bearing.node for bearing in bearings], dtype=np.int64)
    along = np.eye(6)[[bearing.dof for bearing in bearings], :3]
    none = np.full(len(bearings), -1, dtype=np.int64)
    kinds = np.repeat([OutputKind.DISPLACEMENT, OutputKind.REACTION_FORCE], len(bearings))
    upwards = np.tile(UP, (len(bearings), 1))
    outputs = structure.outputs
    return {
        "kind": np.concatenate([outputs["kind"], kinds]),
        "index": np.concatenate([outputs["index"], nodes, nodes]),
        "other": np.concatenate([outputs["other"], none, none]),
        "vector": np.concatenate([outputs["vector"], along, upwards]),
        "total": np.append(outputs["total"], np.zeros(2 * len(bearings), dtype=bool)),
    }
