"""Sensors as the parts of a model file."""

from collections.abc import Mapping
from typing import Any, Literal

from rga.building.directions import direction
from rga.building.quantities import amount, difference
from rga.errors import InputError

SensorKind = Literal["displacement", "rotation", "strain", "force", "reaction"]
#: unit and first letter of a sensor that has none of its own
USUAL: dict[str, tuple[str, str]] = {
    "displacement": ("mm", "D"),
    "rotation": ("mrad", "T"),
    "strain": ("microstrain", "S"),
    "force": ("kN", "N"),
    "reaction": ("kN", "R"),
}


def sensor_part(
    name: str, kind: str, keys: Mapping[str, Any], content: Mapping[str, Any]
) -> dict[str, Any]:
    """A sensor's keys and values in a model file, from those that `ModelBuilder.sensor` takes.

    Args:
        content: of the model so far.
    """
    where = f"sensor {name!r}"
    if kind not in USUAL:
        raise InputError(f"{kind!r} is no kind of sensor", where, "use " + ", ".join(USUAL))
    part: dict[str, Any] = {"kind": kind, "unit": USUAL[kind][0], **keys}
    if part.get("noise") is not None:
        part["noise"] = difference(part["noise"], str(part["unit"]), f"noise of {where}")
    if part.get("direction") is not None:
        part["direction"] = direction(part["direction"], where)
    fibre = part.pop("fibre", None)
    if fibre is not None:
        part["y"], part["z"] = _fibre(fibre, part.get("member"), content, where)
    for axis in ("y", "z"):
        if axis in part:
            part[axis] = amount(part[axis], "m", f"{axis} of {where}")
    return part


def sensor_name(kind: str, pattern: str | None, place: str) -> str:
    """Name of a sensor among alike ones.

    >>> sensor_name("strain", None, "L0-L1"), sensor_name("displacement", "dial {place}", "L3")
    ('S L0-L1', 'dial L3')
    """
    if pattern is None:
        pattern = f"{USUAL.get(kind, ('', kind))[1]} {{place}}"
    if "{place}" not in pattern:
        raise InputError(f"the names {pattern!r} are all alike", "sensors", "write {place} in it")
    return pattern.replace("{place}", place)


def _fibre(
    fibre: str, member: str | None, content: Mapping[str, Any], where: str
) -> tuple[float, float]:
    if member not in content["members"]:
        raise InputError(f"there is no member {member!r} yet", where, "add it before")
    section = content["members"][member]["section"]
    fibres = content["sections"].get(section, {}).get("fibres", {})
    if fibre not in fibres:
        known = ", ".join(fibres) or "none"
        what = f"the section {section!r} has no fibre {fibre!r}"
        raise InputError(what, where, f"use one of its fibres ({known}), or y and z")
    y, z = fibres[fibre]
    return y, z
