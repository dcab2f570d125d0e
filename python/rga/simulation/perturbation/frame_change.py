"""Frame members that differ: a few of them beside a structure that is solved."""

from typing import Any

import numpy as np
from numpy.typing import NDArray

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga.model.structure import OUTPUT_KIND, Structure
from rga.simulation.paths.response import patterns

Arrays = dict[str, NDArray[Any]]
DISPLACEMENT, REACTION = OUTPUT_KIND["displacement"], OUTPUT_KIND["reaction"]
#: properties of the members, one a member
OF_MEMBERS = ["frame", "E", "G", "A", "Iy", "Iz", "J", "Asy", "Asz"]
OF_MEMBERS += ["local_y", "connection", "rigid_end"]
#: share of a node's largest stiffness against turning that counts as none
LOOSE = 1e-9


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
        owner: place of the member that each of them reads, int[sensors].
        shape: those outputs by displacements of the ends, float[12, sensors].
        read: the same under the loads with ends that do not move, float[patterns, sensors].
    """

    def __init__(self, structure: Structure, members: IntArray, pattern: Arrays) -> None:
        arrays, wanted = structure.arrays, structure.outputs
        count, loaded = len(members), len(pattern["forces"])
        on_members = (wanted["kind"] == OUTPUT_KIND["strain"]) | (
            wanted["kind"] == OUTPUT_KIND["force"]
        )
        self.sensors = np.flatnonzero(on_members & _among(wanted["index"], members))
        nodes = np.arange(2 * count)
        reactions = motions(nodes, REACTION)
        gauges = {name: column[self.sensors] for name, column in wanted.items()}
        self.owner = gauges["index"] = np.searchsorted(members, gauges["index"])
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
        # Nothing joins them: one motion of all serves each of them.
        moves = 12
        prescribed = np.zeros((moves + loaded, count, 12))
        prescribed[:moves] = np.eye(moves)[:, None]
        strain = np.zeros((moves + loaded, count, 3))
        strain[moves:] = pattern["strain"][:, members]
        here = _among(pattern["member_index"], members)
        spread = {
            name: array[here] for name, array in pattern.items() if name.startswith("member_")
        }
        spread["member_pattern"] = spread["member_pattern"] + moves
        spread["member_index"] = np.searchsorted(members, spread["member_index"])
        loads = {
            "forces": np.zeros((moves + loaded, 2 * count, 6)),
            "strain": strain,
            "prescribed": prescribed.reshape(-1, 2 * count, 6),
            "prescribed_inclined": np.zeros((moves + loaded, 0)),
            **spread,
        }
        found = _core.respond(cut, loads, outputs)
        held = found[:, : 12 * count].reshape(-1, count, 12)
        self.stiffness = held[:moves].transpose(1, 2, 0)
        self.forces = held[moves:]
        self.shape, self.read = found[:moves, 12 * count :], found[moves:, 12 * count :]


def stiffened(structure: Structure, nodes: IntArray) -> FloatArray:
    """Unit forces and moments on nodes of frame members that something resists.

    Returns:
        float[forces, 6 nodes]; no moment about an axis that no member stiffens.
    """
    frames = np.flatnonzero(structure.arrays["frame"])
    stiffness = Alone(structure, frames, patterns(structure, [])).stiffness
    turning = np.zeros((len(nodes), 3, 3))
    place = np.searchsorted(nodes, structure.arrays["ends"][frames])
    for end in range(2):
        here = slice(6 * end + 3, 6 * end + 6)
        np.add.at(turning, place[:, end], stiffness[:, here, here])
    values, axes = np.linalg.eigh(turning)
    units = np.zeros((len(nodes), 6, len(nodes), 6))
    for node, own in enumerate(axes):
        units[node, :3, node, :3] = np.eye(3)
        units[node, 3:, node, 3:] = own.T * (values[node] > LOOSE * values[node, -1])[:, None]
    flat = units.reshape(6 * len(nodes), 6 * len(nodes))
    return np.asarray(flat[flat.any(axis=1)])


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
    ends = moved.reshape(-1, count, 12)[:, before.owner]
    bent = np.einsum("psd,ds->ps", ends, after.shape - before.shape)
    found[:, before.sensors] += bent + after.read - before.read
    return np.asarray(found)
