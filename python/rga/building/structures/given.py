"""What structures are given: materials, numbers of parts, words."""

from typing import Literal

from rga.building.builder import ModelBuilder
from rga.building.materials import steel
from rga.errors import InputError
from rga.model.schema import Material, Section

#: a section, or the name of a rolled one
AnySection = Section | str
#: a material, or the name of a steel; None: steel
AnyMaterial = Material | str | None
Joints = Literal["pinned", "rigid"]


def add_material(builder: ModelBuilder, material: AnyMaterial) -> None:
    """The one material of a structure."""
    if isinstance(material, Material):
        builder.add_material("material", material)
    else:
        builder.add_material("steel", steel(material))


def check_count(number: object, of: str, where: str, fewest: int, most: int) -> None:
    """InputError where this is no number of parts."""
    if isinstance(number, bool) or not isinstance(number, int) or not fewest <= number <= most:
        what = f"{number!r} is no number of {of}"
        raise InputError(what, where, f"give a whole number from {fewest} to {most}")


def check_word(word: object, words: tuple[str, ...], of: str, where: str) -> None:
    """InputError where a word is none of those that there are."""
    if word not in words:
        raise InputError(
            f"{of}: {word!r} is unknown", where, "use " + " or ".join(map(repr, words))
        )
