"""PyNite: a frame program in Python; the model is built once, and its properties change."""

import numpy as np

from rga.arrays import FloatArray
from rga_bench.installed import NotInstalledError
from rga_bench.solver.peers.linear_system import LinearSystem
from rga_bench.solver.space_truss import SpaceTruss

TRANSLATIONS = ("DX", "DY", "DZ")


class PyNite:
    """A truss of PyNite's two-node springs, its least costly member, analysed for each sample.

    PyNite has no temperatures: forces at the nodes stand for them.
    """

    rows = 1

    def __init__(self, truss: SpaceTruss, system: LinearSystem) -> None:
        """Builds the model.

        Raises:
            NotInstalledError: PyNite is not there.
        """
        try:
            from Pynite import FEModel3D
        except ImportError:
            raise NotInstalledError("PyNiteFEA") from None
        structure, outputs = truss.structure, truss.outputs
        nodes, ends = structure["coordinates"], structure["ends"]
        self._system = system
        self._free = np.argwhere(~structure["fixed"][:, :3])
        self._model = model = FEModel3D()
        for number, (place, held) in enumerate(zip(nodes, structure["fixed"], strict=True)):
            model.add_node(str(number), *place)
            # No member turns a node.
            model.def_support(str(number), *(bool(one) for one in held[:3]), True, True, True)
        length = np.linalg.norm(nodes[ends[:, 1]] - nodes[ends[:, 0]], axis=1)
        self._axial = structure["E"] * structure["A"] / length
        for number, (i, j) in enumerate(ends):
            model.add_spring(str(number), str(i), str(j), self._axial[number])
        self._on_ground = structure["spring_stiffness"]
        self._springs = [
            (str(node), TRANSLATIONS[direction])
            for (node, _), direction in zip(
                structure["spring_node"], structure["spring_dof"], strict=True
            )
        ]
        self._read = [str(node) for node in outputs["index"]], outputs["vector"]
        model.add_load_combo("all", {"sample": 1.0})

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""
        forces = self._system.forces(factors, coefficients)
        return np.array([self._solve(*sample) for sample in zip(factors, forces, strict=True)])

    def _solve(self, factors: FloatArray, forces: FloatArray) -> FloatArray:
        model = self._model
        count = len(self._axial)
        members = zip(model.springs.values(), factors[:count] * self._axial, strict=True)
        for spring, stiffness in members:
            spring.ks = stiffness
        on_ground = factors[count:] * self._on_ground
        for (node, direction), stiffness in zip(self._springs, on_ground, strict=True):
            model.def_support_spring(node, direction, stiffness)
        for node in model.nodes.values():
            node.NodeLoads.clear()
        for (node, direction), force in zip(self._free, forces, strict=True):
            model.add_node_load(str(node), f"F{'XYZ'[direction]}", force, "sample")
        model.analyze_linear(check_stability=False)
        names, vectors = self._read
        moved = [[getattr(model.nodes[name], to)["all"] for to in TRANSLATIONS] for name in names]
        return np.asarray((np.array(moved) * vectors).sum(axis=1))
