"""Steels."""

from rga.errors import InputError
from rga.model.schema import Material

#: yield strength [Pa] up to 16 mm (EN 1993-1-1, table 3.1) and up to 20 mm (IS 2062)
YIELD = {
    "S235": 235e6,
    "S275": 275e6,
    "S355": 355e6,
    "S450": 440e6,
    "S460": 460e6,
    "E250": 250e6,
    "E300": 300e6,
    "E350": 350e6,
    "E410": 410e6,
    "E450": 450e6,
}
#: moduli [Pa] of EN 1993-1-1, 3.2.6, and of IS 800, 2.2.4.1
EUROPEAN, INDIAN = 2.1e11, 2.0e11


def steel(grade: str | None = None) -> Material:
    """Structural steel: E 210 GPa, nu 0.3, alpha 12e-6 1/K, density 7850 kg/m3.

    By EN 1993-1-1, 3.2.6, and EN 1991-1-1, table A.4; the grades E250 to E450 of IS 2062 have the
    200 GPa of IS 800. A grade states the yield strength of thin parts: up to 16 mm, or 20 mm.

    Raises:
        InputError: the grade is unknown.

    >>> steel("S355").yield_strength, steel("E250").E
    (355000000.0, 200000000000.0)
    """
    if grade is not None and grade not in YIELD:
        raise InputError(f"the grade {grade!r} is unknown", "steel", "use " + ", ".join(YIELD))
    return Material(
        E=INDIAN if grade is not None and grade.startswith("E") else EUROPEAN,
        nu=0.3,
        alpha=1.2e-5,
        density=7850.0,
        yield_strength=None if grade is None else YIELD[grade],
    )
