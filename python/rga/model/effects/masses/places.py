"""What effects on masses share."""

from rga.arrays import MassArrays
from rga.model.structure import Structure


def add_masses(structure: Structure, stated: MassArrays, times: float) -> None:
    """Add so many times what is stated to the masses of a structure."""
    masses = structure.masses
    for name in ("line", "section", "nodal"):
        own = masses[name]
        # What effects have added behind has no mass of its own.
        own[: len(stated[name])] += times * stated[name]
