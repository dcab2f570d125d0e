"""Rolled sections by their names, from tables of standards."""

import csv
import math
import re
from collections.abc import Iterator
from difflib import get_close_matches
from functools import cache
from importlib.resources import files
from typing import NamedTuple

from rga.building.sections.hollow import circular_hollow, rectangular_hollow
from rga.building.sections.profiles import angle, channel, i_section
from rga.errors import InputError
from rga.model.schema import Section

TABLES = (
    "i_sections_european",
    "i_sections_indian",
    "channels_european",
    "channels_indian",
    "angles_european",
    "angles_indian",
    "hollow_european",
)
#: nearest names that are told of a name that is none
NEAREST = 3


class Rolled(NamedTuple):
    """A line of a table: the table's name, and the cells by column (dimensions in mm)."""

    table: str
    cells: dict[str, str]

    def size(self, column: str) -> float:
        """A dimension [m]; 0 where the table has none."""
        return float(self.cells.get(column) or 0.0) / 1000


def rolled_section(name: str) -> Section:
    """A rolled section of a European or an Indian standard.

    Properties are computed from the dimensions in the table, as the helpers of this package do;
    the figures that the standards print agree to their last digit but a few. Webs and depths stand
    upright, so that Iy is that of the strong axis; an angle is about its principal axes.

    Args:
        name: "IPE 200", "HEA 200" (or "HE 200 A"), "UPN 160", "UPE 160", "L 80x80x8",
            "CHS 114.3x5", "SHS 100x5" or "SHS 100x100x5", "RHS 200x100x8", "ISMB 250", "ISMC 200",
            "ISA 75x75x8" and so on: see `rolled_sections`. Blanks and capitals do not matter.

    Raises:
        InputError: there is no such section in the tables; the nearest names are told.

    >>> f"{rolled_section('IPE 200').Iy * 1e8:.0f} cm4"
    '1943 cm4'
    >>> rolled_section("IPE 205")
    Traceback (most recent call last):
    rga.errors.InputError: there is no rolled section 'IPE 205' (rolled sections): did you mean \
IPE 200, IPE 220, IPE 180?
    """
    found = _by_key().get(_key(name)) if isinstance(name, str) else None
    if found is None:
        names = ", ".join(_nearest(_key(str(name))))
        remedy = f"did you mean {names}?" if names else "see rolled_sections()"
        raise InputError(f"there is no rolled section {name!r}", "rolled sections", remedy)
    return _section(_rolled()[found])


def rolled_sections(family: str | None = None) -> list[str]:
    """Names of the rolled sections in the tables.

    Args:
        family: the letters that they begin with: IPE, HEA, HEB, HEM, UPN, UPE, L, CHS, SHS, RHS,
            ISLB, ISMB, ISHB, ISLC, ISMC, ISA; left out, all.

    >>> rolled_sections("HEM")[:3], len(rolled_sections()) > 400
    (['HEM 100', 'HEM 120', 'HEM 140'], True)
    """
    return [name for name in _rolled() if family in (None, name.split()[0])]


def _section(rolled: Rolled) -> Section:
    size = rolled.size
    shape = rolled.table.split("_")[0]
    if shape == "hollow":
        if not size("b"):
            return circular_hollow(size("h"), size("t"))
        return rectangular_hollow(size("h"), size("b"), size("t"))
    if shape == "angles":
        return angle(size("h"), size("b"), size("t"), size("r"), size("r2"))
    slope = float(rolled.cells.get("slope") or 0.0)
    tangent = math.tan(math.radians(slope)) if rolled.table.endswith("indian") else slope / 100
    plates = size("h"), size("b"), size("tw"), size("tf"), size("r")
    if shape == "channels":
        return channel(*plates, size("r2"), tangent, size("at") or None)
    # Some tips of IS 808 are thinner than their radius would have them.
    tip = size("tf") - tangent * (size("b") - size("tw")) / 4
    toe = tip * math.tan(math.pi / 4 + math.atan(tangent) / 2)
    return i_section(*plates, min(size("r2"), toe), tangent)


@cache
def _rolled() -> dict[str, Rolled]:
    """Every line of the tables, by name."""
    return {name: one for table in TABLES for name, one in _lines(table)}


def _lines(table: str) -> Iterator[tuple[str, Rolled]]:
    text = files(__package__).joinpath("tables", f"{table}.csv").read_text(encoding="utf-8")
    for cells in csv.DictReader(line for line in text.splitlines() if not line.startswith("#")):
        if "walls" not in cells:
            yield cells["name"], Rolled(table, cells)
            continue
        sizes = cells["outside"].split()[1].split("x")
        sides = dict(zip("hb", sizes, strict=False))
        for wall in cells["walls"].split():
            yield f"{cells['outside']}x{wall}", Rolled(table, {**sides, "t": wall})


@cache
def _by_key() -> dict[str, str]:
    """Name by how it may be written."""
    found = {_key(name): name for name in _rolled()}
    for name in _rolled():
        family, _, size = name.partition(" ")
        if family in ("HEA", "HEB", "HEM"):
            found[_key(f"HE {size} {family[2]}")] = name
        if family in ("SHS", "L", "ISA") and len(set(size.split("x")[:2])) == 1:
            found.setdefault(_key(f"{family} {size.partition('x')[2]}"), name)
    return found


def _nearest(key: str) -> list[str]:
    """Names of the same family with the nearest sizes, or names that look alike."""
    family, sizes = _letters(key), _sizes(key)
    alike = [own for own in _by_key() if sizes and _letters(own) == family]
    if alike:

        def away(own: str) -> tuple[int, float, str]:
            theirs = _sizes(own)
            apart = sum(abs(a - b) for a, b in zip(theirs, sizes, strict=False))
            return abs(len(theirs) - len(sizes)), apart, own

        return list(dict.fromkeys(_by_key()[own] for own in sorted(alike, key=away)))[:NEAREST]
    near = get_close_matches(key, _by_key(), n=NEAREST, cutoff=0.5)
    return list(dict.fromkeys(_by_key()[one] for one in near))


def _letters(key: str) -> str:
    """Letters of a key, without the signs between its sizes.

    >>> _letters("shs100x100x5"), _letters("he200a")
    ('shs', 'hea')
    """
    return re.sub(r"[0-9.]+(x(?=[0-9]))?", "", key)


def _sizes(key: str) -> list[float]:
    return [float(number) for number in re.findall(r"\d+(?:\.\d+)?", key)]


def _key(name: str) -> str:
    """A name without what people write differently.

    >>> _key("chs 114,3 × 5.0")
    'CHS114.3X5'
    """
    plain = "".join(name.upper().split()).replace("×", "X").replace("*", "X").replace(",", ".")
    parts = plain.split("X")
    return "X".join(part.rstrip("0").rstrip(".") if "." in part else part for part in parts)
