"""Sections that do not go with the lengths of their members, or with themselves."""

from collections.abc import Iterator

import numpy as np

from rga.arrays import FloatArray
from rga.checking.finding import Finding
from rga.checking.of_model.materials import meant
from rga.checking.over_ranges import OverRanges
from rga.model.schema import Model, Section

#: side of a section (the root of its area) over the length of its longest member: a bar is no cube
THICKEST_BAR, THICKEST_BEAM = 0.4, 1.0
#: the thinnest: a wire of 7 mm over 100 m has 6e-5
THINNEST = 5e-6
#: radius of gyration over the length of the longest member
WIDEST = 0.5
#: I over A squared: a plate about its weak axis, and a lattice of thin walls
FLATTEST, HOLLOWEST = 1e-4, 100.0
#: room for rounding of tables
ROUNDING = 1.05
#: outermost fibre over radius of gyration: a T has 3
OUTERMOST = 5.0
AREAS = {"cm2": 1e-4, "mm2": 1e-6, "in2": 6.4516e-4}
INERTIAS = {"cm4": 1e-8, "mm4": 1e-12, "in4": 4.162314e-7}


def sections(over: OverRanges) -> Iterator[Finding]:
    """A, Iy, Iz, J and shear areas that look as if they were given in other units."""
    model = over.model
    longest = _longest(model)
    for name, one in model.sections.items():
        where = f"section {name!r}"
        if name in longest:
            yield from _beside_length(where, one, *longest[name])
        yield from _by_itself(where, one)


def _longest(model: Model) -> dict[str, tuple[float, bool]]:
    """Length of the longest member of each section [m], and whether one of them bends."""
    found: dict[str, tuple[float, bool]] = {}
    for member in model.members.values():
        ends = (np.array(model.nodes[node]) for node in member.nodes)
        length = float(np.linalg.norm(next(ends) - next(ends)))
        known, bends = found.get(member.section, (0.0, False))
        found[member.section] = max(known, length), bends or member.kind == "frame"
    return found


def _beside_length(where: str, one: Section, length: float, bends: bool) -> Iterator[Finding]:
    side, length = np.sqrt(one.A), np.float64(length)
    if side > (THICKEST_BEAM if bends else THICKEST_BAR) * length:
        # A side of a hundredth to a tenth of the length is usual.
        usual = ((1e-3 * length) ** 2, (0.2 * length) ** 2)
        what = f"A is {one.A:g} m2, of members of {length:.3g} m at most"
        yield Finding("warning", where, what, meant(one.A, "m2", usual, AREAS))
    if side < THINNEST * length:
        what = f"A is {one.A:g} m2, a thread of members of up to {length:.3g} m"
        yield Finding("warning", where, what, "give it in m2")
    for key, inertia in (("Iy", one.Iy), ("Iz", one.Iz)):
        if np.sqrt(inertia / one.A) > WIDEST * length and not _hollow(inertia, one.A):
            what = f"{key} is {inertia:g} m4: its radius of gyration is longer than the member"
            usual = (1e-3 * (5e-3 * length) ** 4, 0.1 * (0.2 * length) ** 4)
            yield Finding("warning", where, what, meant(inertia, "m4", usual, INERTIAS))


def _hollow(inertia: float, area: float) -> bool:
    return inertia > HOLLOWEST * area * area


def _by_itself(where: str, one: Section) -> Iterator[Finding]:
    square = one.A * one.A
    usual = (0.01 * square, 20 * square)
    for key, inertia in (("Iy", one.Iy), ("Iz", one.Iz)):
        if _hollow(inertia, one.A):
            what = f"{key} is {inertia:g} m4, which no section of A = {one.A:g} m2 has"
            remedy = meant(inertia, "m4", usual, INERTIAS)
            yield Finding("warning", where, what, remedy)
        elif 0 < inertia < FLATTEST * square:
            what = f"{key} is {inertia:g} m4, less than of the thinnest plate of A = {one.A:g} m2"
            yield Finding("warning", where, what, "check both: A in m2, I in m4")
    polar = one.Iy + one.Iz
    if one.Iy and one.Iz and ROUNDING * polar < one.J:
        what = f"J is {one.J:g} m4, more than Iy + Iz = {polar:g} m4: no section twists so hard"
        usual = (1e-4 * polar, polar)
        yield Finding("warning", where, what, meant(one.J, "m4", usual, INERTIAS))
    for key, area in (("Asy", one.Asy), ("Asz", one.Asz)):
        if area is not None and area > ROUNDING * one.A:
            what = f"the shear area {key} is {area:g} m2, more than A = {one.A:g} m2"
            yield Finding("warning", where, what, "give the part of A that takes shear")
    yield from _fibres(where, one)


def _fibres(where: str, one: Section) -> Iterator[Finding]:
    for fibre, place in one.fibres.items():
        beyond = outside(one, np.array(place))
        if beyond is not None:
            yield Finding("warning", where, f"the fibre {fibre!r} {beyond}", "give y and z in m")


def outside(section: Section, place: FloatArray) -> str | None:
    """In words, that a fibre lies outside of a section; None where it may lie within.

    Args:
        section: its second moments tell how far it reaches.
        place: local y and z [m].

    >>> outside(Section(A=0.01, Iy=1e-4, Iz=1e-4), np.array([0.0, 100.0]))
    'lies 100 m from the axis along z; the radius of gyration is 0.1 m'
    """
    for axis, along, inertia in (("y", place[0], section.Iz), ("z", place[1], section.Iy)):
        radius = np.sqrt(inertia / section.A)
        if inertia and abs(along) > OUTERMOST * radius:
            return (
                f"lies {abs(along):g} m from the axis along {axis}; the radius of gyration is "
                f"{radius:.3g} m"
            )
    return None
