"""The measured railway bridge in space: both trusses, floor, laterals, portals and sway frames.

What `examples/rdso45m` states of the trusses, with joints that are stiff and all that is between
them. Sections, axles and sensors are read from the shared data; masses are those of the owner of
the record (Civ3d, RDSO45mTruss): 9946 kg/m3 with gussets, fittings and what lies on the members,
and 216 kg/m of rails on each stringer. Stringers slip along the bridge in their seats, as a floor
does that carries no force of the chord.
"""

import csv
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np

from rga.building import ModelBuilder
from rga.model import Model, model_content, read_model

PANEL, HIGH, WIDE, PANELS = 5.905, 7.315, 5.28, 8
#: stringers from the middle of the bridge, and how far below and within the corner braces begin
STRINGER, BELOW, WITHIN = 0.95, 1.53, 1.5
DENSITY, RAILS = 9946.0, 216.0
#: cross beams and braces between the stringers of a panel: number and length [m]
BETWEEN_STRINGERS = {"StringerCross": (2, 1.9), "StringerLateral": (3, 2.8)}
#: sections of the members of a truss, by panel from the end
BOTTOM, TOP = "BottomChord L0-L2,L6-L8", "TopChord U1-U3,U5-U7"
BOTTOM_MIDDLE, TOP_MIDDLE = "BottomChord L2-L6", "TopChord U3-U5"
RAKER, VERTICAL = "EndRaker L0-U1,L8-U7", "Vertical Li-Ui"
OUTER, INNER = "Diagonal U1-L2,U7-L6", "Diagonal L2-U3,U3-L4,L4-U5,U5-L6"
#: a member of the trusses whose parts a brace divides
DIVIDED = " top"
#: where the shape of a mode is measured: displacement channels, along what they count as positive
POINTS = {
    "d5": {"node": "1.L4", "direction": [0.0, 0.0, -1.0]},
    "d6": {"node": "2.L4", "direction": [0.0, 0.0, -1.0]},
    "d7": {"node": "2.L4", "direction": [0.0, -1.0, 0.0]},
}
#: how they swing is looked for about what the free vibration shows, like modes of the model
MODES = {
    "lateral": {"near": 2.66, "within": 0.2, "computed": 1},
    "vertical": {"near": 5.46, "within": 0.1, "computed": 2},
}


def railway_truss(data: Path, plane: Model) -> Model:
    """The bridge in space.

    Args:
        data: folder with `sections.csv` and `train_axles.csv`.
        plane: the two trusses each in its plane, of which train and sensors are taken.
    """
    bridge = ModelBuilder("railway truss").add_material(
        "steel", E=2e11, nu=0.3, alpha=1.2e-5, density=DENSITY
    )
    areas = _add_sections(bridge, data)
    for side in (1, 2):
        _add_truss(bridge, side)
    _add_floor(bridge, areas)
    _add_laterals(bridge, "L", range(PANELS), "bottom laterals", "BottomLateral")
    _add_laterals(bridge, "U", range(1, PANELS - 1), "top laterals", "TopLateral")
    for at in range(1, PANELS):
        _add_frame(bridge, at)
    content = model_content(bridge.build())
    flat = model_content(plane)
    content |= {name: flat[name] for name in ("context", "effects", "sensors")}
    for effect in content["effects"].values():
        # Stringers and cross girders bring the axles to the nodes.
        effect["carried_by"] = "nodes"
    return read_model(content | {"points": POINTS, "modes": MODES}, "the railway truss")


def _add_sections(bridge: ModelBuilder, data: Path) -> dict[str, float]:
    """Sections of the table, and their areas [m2]."""
    areas = {}
    with (data / "sections.csv").open(encoding="utf-8") as lines:
        for row in csv.DictReader(lines):
            own = {"A": row["A_m2"], "J": row["J_m4"]}
            own |= {"Iy": row["I_strong_m4"], "Iz": row["I_weak_m4"]}
            bridge.add_section(row["member_group"], **{k: float(v) for k, v in own.items()})
            areas[row["member_group"]] = float(row["A_m2"])
    return areas


def _node(side: int, chord: str, at: int) -> str:
    return f"{side}.{chord}{at}"


def _add_truss(bridge: ModelBuilder, side: int) -> None:
    y = (side - 1) * WIDE
    for at in range(PANELS + 1):
        bridge.add_node(_node(side, "L", at), at * PANEL, y)
    for at in range(1, PANELS):
        bridge.add_node(_node(side, "U", at), at * PANEL, y, HIGH)

    def add(first: str, last: str, section: str, group: str) -> None:
        ends = (f"{side}.{first}", f"{side}.{last}")
        groups = [group, f"truss {side}", f"{group} of truss {side}"]
        keys: dict[str, Any] = {"kind": "frame", "groups": groups, "local_y": "y"}
        name = f"{side}.{first}-{last}"
        divided = _divided(bridge, ends)
        if divided is None:
            bridge.add_member(*ends, section, name=name, **keys)
        else:
            low, high = sorted(ends, key=lambda node: bridge.nodes[node][2])
            bridge.add_member(low, divided, section, name=name, **keys)
            bridge.add_member(divided, high, section, name=name + DIVIDED, **keys)

    for at in range(PANELS):
        middle = 2 <= at < PANELS - 2
        add(f"L{at}", f"L{at + 1}", BOTTOM_MIDDLE if middle else BOTTOM, "bottom chord")
    for at in range(1, PANELS - 1):
        middle = 3 <= at < PANELS - 3
        add(f"U{at}", f"U{at + 1}", TOP_MIDDLE if middle else TOP, "top chord")
        first, last = (f"U{at}", f"L{at + 1}") if at % 2 else (f"L{at}", f"U{at + 1}")
        add(first, last, OUTER if at in (1, PANELS - 2) else INNER, "diagonal")
    add("L0", "U1", RAKER, "end raker")
    add(f"L{PANELS}", f"U{PANELS - 1}", RAKER, "end raker")
    for at in range(1, PANELS):
        add(f"L{at}", f"U{at}", VERTICAL, "vertical")
    bridge.support(f"{side}.L0", "uy", "uz", name=f"rollers {side}")
    bridge.support(f"{side}.L{PANELS}", "ux", "uy", "uz", name=f"pin {side}")


def _divided(bridge: ModelBuilder, ends: tuple[str, str]) -> str | None:
    """The node at which a corner brace meets a raker or a vertical, added; None elsewhere."""
    low, high = sorted(ends, key=lambda node: bridge.nodes[node][2])
    bottom, top = (np.array(bridge.nodes[node]) for node in (low, high))
    at = int(high.partition("U")[2] or 0)
    braced = low.partition("L")[2] == str(at) if 1 < at < PANELS - 1 else low[-1] in "08"
    if bottom[2] == top[2] or not braced:
        return None
    name = f"{high} below"
    bridge.add_node(name, *(top + (bottom - top) * BELOW / HIGH))
    return name


def _add_floor(bridge: ModelBuilder, areas: dict[str, float]) -> None:
    for at in range(PANELS + 1):
        along = [f"1.L{at}", f"S1.{at}", f"S2.{at}", f"2.L{at}"]
        for node, off in zip(along[1:3], (-STRINGER, STRINGER), strict=True):
            bridge.add_node(node, at * PANEL, WIDE / 2 + off)
        for first, last in pairwise(along):
            bridge.add_member(first, last, "CrossGirder", kind="frame", groups="cross girders")
    for at in range(PANELS):
        for stringer in ("S1", "S2"):
            bridge.add_member(
                f"{stringer}.{at}", f"{stringer}.{at + 1}", "StringerMain", kind="frame",
                groups="stringers", releases={"j": ["ux"]},
            )  # fmt: skip
    between = sum(areas[name] * count * long for name, (count, long) in BETWEEN_STRINGERS.items())
    bridge.mass_along("stringers", RAILS, name="rails")
    bridge.mass_along("stringers", DENSITY * between / (2 * PANEL), name="stringer bracing")


def _add_laterals(
    bridge: ModelBuilder, chord: str, panels: range, group: str, section: str
) -> None:
    for at in panels:
        for side in (1, 2):
            ends = _node(side, chord, at), _node(3 - side, chord, at + 1)
            bridge.add_member(*ends, section, groups=[group, "laterals"])


def _add_frame(bridge: ModelBuilder, at: int) -> None:
    """A girder between the top chords, and its corner braces."""
    portal = at in (1, PANELS - 1)
    groups = ["portals" if portal else "sway frames", "portals and sway frames"]
    ends = [_node(side, "U", at) for side in (1, 2)]
    inner = [f"{end} within" for end in ends]
    for node, y in zip(inner, (WITHIN, WIDE - WITHIN), strict=True):
        bridge.add_node(node, at * PANEL, y, HIGH)
    section = "PortalGirder" if portal else "SwayGirder"
    for first, last in pairwise([ends[0], *inner, ends[1]]):
        bridge.add_member(first, last, section, kind="frame", groups=groups)
    for end, node in zip(ends, inner, strict=True):
        bridge.add_member(f"{end} below", node, "KneeBracing", groups=groups)
