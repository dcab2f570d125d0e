"""Gauges that stand outside of their section, or where a bar knows no fibre."""

from collections.abc import Iterator

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.of_model.sections import outside
from rga.checking.over_ranges import OverRanges

#: room beyond the outermost fibre that the section states: the thickness of a gauge
BEYOND = 1.02


def gauges(over: OverRanges) -> Iterator[Finding]:
    """Strain gauges at y and z beyond the section, and on truss members away from the axis."""
    model = over.model
    on_bars = []
    for name, sensor in model.sensors.items():
        if sensor.kind != "strain" or sensor.member is None or not (sensor.y or sensor.z):
            continue
        member = model.members[sensor.member]
        if member.kind == "truss":
            on_bars.append(name)
            continue
        section, place = model.sections[member.section], np.array([sensor.y, sensor.z])
        beyond = outside(section, place)
        if beyond is None and section.fibres:
            far = np.abs(np.array(list(section.fibres.values()))).max(axis=0)
            if (np.abs(place) > BEYOND * far + 1e-9).any():
                beyond = f"lies beyond the fibres of its section, {far[0]:g} and {far[1]:g} m"
        if beyond is not None:
            yield Finding(
                "warning", parts("sensor", [name]), f"its fibre {beyond}", "give y and z in m"
            )
    if on_bars:
        yield Finding(
            "note",
            parts("sensor", on_bars),
            "its y and z change nothing: a truss member has the same strain at every fibre",
            "make its member a frame member where it bends",
        )
