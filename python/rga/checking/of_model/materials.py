"""Properties of materials that look as if they were given in other units."""

from collections.abc import Iterator

from rga.checking.finding import Finding
from rga.checking.over_ranges import OverRanges
from rga.model.schema import Material

#: what materials of structures have, with room on both sides: soft timber and rubber bearings to
#: carbon fibre for E, aerated concrete to lead for density, plastics for alpha
MODULI, DENSITIES, STRENGTHS = (1e6, 2e12), (50.0, 25000.0), (1e5, 1e10)
EXPANSIONS = (0.0, 3e-4)
#: units that are mixed up with the one that is meant: name -> its size
OF_STRESS = {"GPa": 1e9, "MPa (N/mm2)": 1e6, "kPa (kN/m2)": 1e3, "psi": 6894.757}
OF_DENSITY = {"t/m3 (g/cm3)": 1e3, "kN/m3": 1e3 / 9.81}
OF_EXPANSION = {"1e-6/K (microstrain per kelvin)": 1e-6, "mm/(m K)": 1e-3}
#: what is usual of the same, to tell which unit was meant
USUAL_MODULI, USUAL_DENSITIES = (5e9, 4e11), (300.0, 9000.0)
USUAL_STRENGTHS, USUAL_EXPANSIONS = (5e6, 2e9), (1e-6, 1e-4)
#: Poisson's ratio of a material without ribs or voids
RATIOS = (0.0, 0.48)


def materials(over: OverRanges) -> Iterator[Finding]:
    """E, density, alpha, yield strength and nu that no material of a structure has."""
    for name, one in over.model.materials.items():
        where = f"material {name!r}"
        for key, value, unit, within, usual, units in _properties(one):
            if value is not None and not within[0] <= value <= within[1]:
                yield Finding(
                    "warning",
                    where,
                    f"{key} is {value:g} {unit}, which no material of a structure has",
                    meant(value, unit, usual, units),
                )
        if not RATIOS[0] <= one.nu <= RATIOS[1]:
            yield Finding("warning", where, f"nu is {one.nu:g}", "give 0.3 for steel, 0.2 concrete")


def meant(value: float, unit: str, usual: tuple[float, float], units: dict[str, float]) -> str:
    """A remedy that names the unit in which a value would be usual.

    >>> meant(210.0, "Pa", USUAL_MODULI, OF_STRESS)
    'it would be usual in GPa: write 2.1e+11'
    >>> meant(1e-9, "Pa", USUAL_MODULI, OF_STRESS)
    'give it in Pa'
    """
    for name, size in units.items():
        if usual[0] <= value * size <= usual[1]:
            return f"it would be usual in {name}: write {value * size:.6g}"
    return f"give it in {unit}"


def _properties(
    one: Material,
) -> Iterator[
    tuple[str, float | None, str, tuple[float, float], tuple[float, float], dict[str, float]]
]:
    yield "E", one.E, "Pa", MODULI, USUAL_MODULI, OF_STRESS
    density = one.density or None
    yield "density", density, "kg/m3", DENSITIES, USUAL_DENSITIES, OF_DENSITY
    yield "alpha", one.alpha, "1/K", EXPANSIONS, USUAL_EXPANSIONS, OF_EXPANSION
    yield "yield_strength", one.yield_strength, "Pa", STRENGTHS, USUAL_STRENGTHS, OF_STRESS
