"""What a support holds, in words."""

import re

from rga.errors import InputError
from rga.model.schema import DOFS
from rga.model.structure.arrays import HELD_BY_PLANE

MOVES, TURNS = DOFS[:3], DOFS[3:]
_ROLLER = re.compile(r"roller along ([xyz])(?: and ([xyz]))?")
KNOWN = "'pinned', 'fixed', 'roller along x', 'roller along x and y', or any of " + ", ".join(DOFS)


def held(words: tuple[str, ...], plane: str | None, where: str) -> list[str]:
    """Degrees of freedom that a support holds; without those that a plane model holds anyhow.

    Args:
        words: "pinned" (moves nowhere), "fixed" (does not turn either), "roller along x" or
            "roller along x and y" (moves that way alone), or names of degrees of freedom.
        plane: of the model.

    Raises:
        InputError: a word is unknown, or a roller leaves the plane.

    >>> held(("pinned",), None, "support"), held(("roller along x",), "xz", "support")
    (['ux', 'uy', 'uz'], ['uz'])
    """
    out_of_plane = {DOFS[number] for number in HELD_BY_PLANE.get(plane or "", ())}
    found: set[str] = set()
    for word in words:
        roller = _ROLLER.fullmatch(word) if isinstance(word, str) else None
        if roller is not None:
            free = {f"u{axis}" for axis in roller.groups() if axis}
            if free & out_of_plane:
                raise InputError(f"{word!r} leaves the plane {plane}", where, "name another axis")
            found.update(set(MOVES) - free)
        elif word == "pinned":
            found.update(MOVES)
        elif word == "fixed":
            found.update(DOFS)
        elif word in DOFS:
            found.add(word)
        else:
            raise InputError(f"{word!r} is nothing that a support holds", where, f"use {KNOWN}")
    if len(words) == len(found & set(words)):
        return [dof for dof in DOFS if dof in found]  # as they were named
    return [dof for dof in DOFS if dof in found - out_of_plane]
