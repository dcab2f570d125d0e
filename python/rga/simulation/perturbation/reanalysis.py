"""A structure solved once: further loads, and a few stiffnesses that differ, cost little more."""

from rga import _core
from rga.arrays import FloatArray, IntArray, by_name
from rga.errors import UnstableStructureError
from rga.model.structure import Load, Structure
from rga.simulation.paths.response import patterns, refused

#: loads that are remembered
KEPT = 32


class Reanalysis:
    """The response of one structure, and of those near it: `_core.Reanalysis` in names of a model.

    Args:
        structure: must not be changed afterwards.

    Raises:
        UnstableStructureError: the structure can move; names node and direction.
        InputError: a property that the core refuses.
    """

    def __init__(self, structure: Structure) -> None:
        self.structure = structure
        self._known: dict[bytes, _core.Loaded] = {}
        try:
            self._core = _core.Reanalysis(structure.arrays, structure.outputs)
        except (_core.UnstableStructure, _core.InvalidInput) as error:
            raise refused(structure, error) from None

    def under(self, loads: list[Load]) -> _core.Loaded:
        """The structure under loads; InputError for a property that the core refuses."""
        pattern = patterns(self.structure, loads)
        content = b"".join(array.tobytes() for array in by_name(pattern).values())
        if content not in self._known:
            try:
                self._known[content] = self._core.under(pattern)
            except (_core.UnstableStructure, _core.InvalidInput) as error:
                raise refused(self.structure, error) from None
            if len(self._known) > KEPT:
                del self._known[next(iter(self._known))]
        return self._known[content]

    def differing(self, other: Structure) -> _core.StiffnessDifference | None:
        """Where stiffnesses differ; None where more than few stiffnesses do."""
        return self._core.differing(other.arrays, other.outputs)

    def changed(
        self, loaded: _core.Loaded, other: Structure, where: _core.StiffnessDifference
    ) -> FloatArray:
        """Outputs of a structure near this one, float[patterns, outputs] in SI units.

        Args:
            loaded: this structure under the loads.
            other: the structure near it.
            where: it differs.

        Raises:
            UnstableStructureError: the other structure can move.
            InputError: a property of the other that the core refuses.
        """
        try:
            return self._core.changed(loaded, other.arrays, where)
        except _core.DependentTerms:
            raise UnstableStructureError(
                "the structure can move: nothing takes over what a member or spring loses",
                "members and supports",
                "add a member, a support or a stiffness there, or reduce the loss",
            ) from None
        except _core.InvalidInput as error:
            raise refused(other, error) from None

    def onto(
        self, loaded: _core.Loaded, members: IntArray, springs: IntArray
    ) -> _core.Condensation | None:
        """The structure under loads condensed along members and onto springs.

        None for frame members without springs at their ends.
        """
        return self._core.onto(loaded, members, springs)

    def rates(self, loaded: _core.Loaded) -> dict[int, FloatArray]:
        """Derivatives by the logarithm of EA of truss members, and of others with end springs.

        Returns:
            float[patterns, outputs] by the number of the member.
        """
        members, rates = self._core.rates(loaded)
        return dict(zip(members.tolist(), rates, strict=True))
