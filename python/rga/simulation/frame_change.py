"""Frame members that differ: a few of them beside a structure that is solved."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.model.parameter import FloatArray
from rga.model.structure import OUTPUT_KIND, IntArray, Structure

Arrays = dict[str, NDArray[Any]]
DISPLACEMENT, REACTION = OUTPUT_KIND["displacement"], OUTPUT_KIND["reaction"]
#: properties of the members, one a member
OF_MEMBERS = ["frame", "E", "G", "A", "Iy", "Iz", "J", "Asy", "Asz"]
OF_MEMBERS += ["local_y", "connection", "rigid_end"]


def motions(nodes: IntArray, kind: int = DISPLACEMENT) -> Arrays:
    """Outputs of all six components at nodes: displacements and rotations, or reactions."""
    count = 6 * len(nodes)
    return {
        "kind": np.tile(np.repeat([kind, kind + 1], 3), len(nodes)),
        "index": np.repeat(nodes, 6),
        "other": np.full(count, -1),
        "vector": np.tile(np.eye(3), (2 * len(nodes), 1)),
        "total": np.zeros(count, dtype=bool),
    }


class Alone:
    """Frame members cut out, each held at its own two nodes.

    Args:
        structure: it has them.
        members: their numbers.
        pattern: loads on the structure, as the core takes them.

    Attributes:
        stiffness: forces of the nodes by displacements of the ends, float[members, 12, 12].
        forces: the same under the loads with ends that do not move, float[patterns, members, 12].
        sensors: numbers of the outputs that read these members.
        shape: those outputs by displacements of the ends, float[members, 12, sensors].
        read: the same under the loads with ends that do not move, float[patterns, sensors].
    """

    def __init__(self, structure: Structure, members: IntArray, pattern: Arrays) -> None:
        arrays, wanted = structure.arrays, structure.outputs
        count, patterns = len(members), len(pattern["forces"])
        on_members = (wanted["kind"] == OUTPUT_KIND["strain"]) | (
            wanted["kind"] == OUTPUT_KIND["force"]
        )
        self.sensors = np.flatnonzero(on_members & _among(wanted["index"], members))
        nodes = np.arange(2 * count)
        reactions = motions(nodes, REACTION)
        gauges = {name: column[self.sensors] for name, column in wanted.items()}
        gauges["index"] = np.searchsorted(members, gauges["index"])
        outputs = {
            name: np.concatenate([reactions[name], gauges[name]]).astype(wanted[name].dtype)
            for name in wanted
        }
        ends = arrays["ends"][members]
        cut = {
            **{name: arrays[name][members] for name in OF_MEMBERS},
            "coordinates": arrays["coordinates"][ends].reshape(-1, 3),
            "ends": nodes.reshape(-1, 2),
            "fixed": np.ones((2 * count, 6), dtype=bool),
            **{
                name: array[:0]
                for name, array in arrays.items()
                if name.startswith(("inclined_", "spring_", "tie_"))
            },
        }
        moves = 12 * count
        prescribed = np.zeros((moves + patterns, 2 * count, 6))
        prescribed[:moves] = np.eye(moves).reshape(moves, 2 * count, 6)
        strain = np.zeros((moves + patterns, count, 3))
        strain[moves:] = pattern["strain"][:, members]
        here = _among(pattern["member_index"], members)
        spread = {
            name: array[here] for name, array in pattern.items() if name.startswith("member_")
        }
        spread["member_pattern"] = spread["member_pattern"] + moves
        spread["member_index"] = np.searchsorted(members, spread["member_index"])
        loads = {
            "forces": np.zeros((moves + patterns, 2 * count, 6)),
            "strain": strain,
            "prescribed": prescribed,
            "prescribed_inclined": np.zeros((moves + patterns, 0)),
            **spread,
        }
        found = _core.respond(cut, loads, outputs)
        every = np.arange(count)
        held = found[:moves, :moves].reshape(count, 12, count, 12)
        self.stiffness = held[every, :, every].transpose(0, 2, 1)
        self.forces = found[moves:, :moves].reshape(patterns, count, 12)
        self.shape = found[:moves, moves:].reshape(count, 12, -1)
        self.read = found[moves:, moves:]


def _among(numbers: IntArray, members: IntArray) -> NDArray[np.bool_]:
    return np.asarray((numbers[:, None] == members).any(axis=1))


def change(
    before: Alone,
    after: Alone,
    displacements: FloatArray,
    flexibility: FloatArray,
    influence: FloatArray,
) -> FloatArray:
    """What it makes of the outputs that members differ, float[patterns, outputs].

    Members of stiffness K + D with ends displaced by u act like those of stiffness K with the
    forces D u on their nodes taken off.

    Args:
        before, after: the members as they are in the structure, and as they are to be.
        displacements: of their ends under the loads, float[patterns, 12 members].
        flexibility: the same under unit forces there, float[12 members, 12 members].
        influence: outputs under unit forces there, float[12 members, outputs].
    """
    count = len(before.stiffness)
    blocks = np.zeros((count, 12, count, 12))
    blocks[np.arange(count), :, np.arange(count)] = after.stiffness - before.stiffness
    stiffer = blocks.reshape(12 * count, 12 * count)
    more = (after.forces - before.forces).reshape(len(displacements), -1)
    matrix = np.eye(12 * count) + flexibility @ stiffer
    moved = np.linalg.solve(matrix, (displacements - more @ flexibility).T).T
    found = -(moved @ stiffer.T + more) @ influence
    shape = (after.shape - before.shape).reshape(12 * count, -1)
    found[:, before.sensors] += moved @ shape + after.read - before.read
    return np.asarray(found)
