"""Large displacements: each row in the equilibrium of the deformed structure."""

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga.errors import InputError, UnstableStructureError
from rga.model.schema import DOFS
from rga.model.structure import Load, Structure
from rga.simulation.paths.response import node_name, patterns, refused


def respond_deformed(structure: Structure, loads: list[Load], rows: IntArray) -> FloatArray:
    """Sensors under the sum of each row's loads, float[rows, sensors] in SI units.

    Loads do not superpose here; `_core.respond_nonlinear` tells the method and its sources.

    Args:
        structure: without friction and laws.
        loads: patterns with the coefficients of these rows.
        rows: their numbers, for messages, int[rows].

    Raises:
        InputError: the structure has friction or play as well, or a property that the core
            refuses.
        UnstableStructureError: a row buckles, snaps through or moves freely; names row, node and
            direction.
    """
    if structure.bearings or structure.laws:
        raise InputError(
            "large displacements are not simulated together with friction, play or slack",
            "analysis.geometry and effects",
            "leave the geometry linear, or leave out those effects",
        )
    coefficients = np.column_stack([load.coefficient for load in loads])
    try:
        return _core.respond_nonlinear(
            structure.arrays,
            patterns(structure, loads),
            structure.outputs,
            np.ascontiguousarray(coefficients),
        )
    except (_core.UnstableStructure, _core.InvalidInput) as error:
        raise _refused(structure, error, rows) from None


def _refused(
    structure: Structure, error: _core.UnstableStructure | _core.InvalidInput, rows: IntArray
) -> InputError:
    """What the core refuses, with the row and in the names of the model."""
    told = refused(structure, error)
    if not hasattr(error, "row"):
        return told
    where = f"row {rows[error.row] + 1}"
    if isinstance(error, _core.InvalidInput):
        return InputError(told.what.removeprefix(f"row {error.row}: "), where, told.remedy)
    if error.share is None:
        return UnstableStructureError(told.what, where, told.remedy)
    place = f"node {node_name(structure, error.node)!r} gives way in {DOFS[error.dof]}"
    return UnstableStructureError(
        f"it buckles or snaps through: beyond {100 * error.share:.4g} % of its load no stable "
        f"equilibrium is reached, {place}",
        where,
        "lower the load, or stiffen the structure there",
    )
