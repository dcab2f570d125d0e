"""Values of materials that cannot be meant."""

from collections.abc import Iterator, Mapping

#: range of E [GPa] and density [kg/m3] of materials by words in their types: handbook values
RANGES = {
    "steel": ((150, 250), (7000, 8500)),
    "stainless": ((150, 250), (7000, 8500)),
    "concrete": ((3, 80), (300, 4000)),
    "aluminium": ((50, 90), (2400, 3000)),
    "timber": ((0.1, 30), (200, 1400)),
    "masonry": ((0.1, 40), (300, 4000)),
}
#: of all others
WIDEST = ((0.01, 500), (1, 25000))


def doubts(values: Mapping[str, float], kind: str) -> Iterator[str]:
    """What cannot be meant about a material, in words.

    Args:
        values: E [Pa], nu, density [kg/m3], alpha [1/K], and G [Pa] where it is stated.
        kind: the type of the material as the file has it.
    """
    words = kind.lower()
    own, range_density = next((r for word, r in RANGES.items() if word in words), WIDEST)
    modulus = values["E"]
    of = f" for {kind.lower()}" if (own, range_density) != WIDEST else ""
    if not own[0] * 1e9 <= modulus <= own[1] * 1e9:
        yield f"E of {modulus / 1e9:g} GPa{of}"
    if not -1 < values.get("nu", 0.3) < 0.5:
        yield f"Poisson's ratio of {values['nu']:g}"
    shear = values.get("G")
    if shear and not modulus / 3.2 <= shear <= modulus and words != "timber":
        yield f"G of {shear / 1e9:g} GPa with E of {modulus / 1e9:g} GPa"
    density = values.get("density", 0.0)
    if density and not range_density[0] <= density <= range_density[1]:
        yield f"density of {density:g} kg/m3{of}"
    if not 0 <= values.get("alpha", 0.0) <= 1e-3:
        yield f"thermal expansion of {values['alpha']:g} 1/K"
