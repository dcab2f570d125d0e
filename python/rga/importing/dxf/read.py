"""Makes a draft of the lines of a drawing: geometry, and what the user says of the rest."""

from pathlib import Path

import numpy as np

from rga.arrays import FloatArray, IntArray
from rga.errors import InputError
from rga.importing.draft import ModelDraft
from rga.importing.dxf.lines import Drawing, Line, read_drawing
from rga.importing.options import Chosen
from rga.importing.units import LENGTHS

#: metres per unit of the codes of $INSUNITS that drawings of structures have
CODES = {1: ("in", 0.0254), 2: ("ft", 0.3048), 4: ("mm", 1e-3), 5: ("cm", 1e-2), 6: ("m", 1.0)}
#: extent of a structure below and above which its unit is asked for [m]
SMALLEST, LARGEST = 0.5, 5000.0
#: tolerance as a share of the extent of the drawing
TOLERANCE = 1e-6
#: lines times nodes up to which ends on other lines are looked for
MOST_PAIRS = 20_000_000
SECTION_REMEDY = (
    'give them: --kind truss --section "A=10cm2" --material "E=210GPa", or --kind frame '
    '--section "A=10cm2, Iy=200cm4, Iz=200cm4, J=300cm4" --material "E=210GPa"'
)


def read_dxf(path: Path, chosen: Chosen) -> ModelDraft:
    """A draft of the lines of a drawing.

    Args:
        path: the drawing.
        chosen: its unit, section, material, kind of members, tolerance.

    Raises:
        InputError: it cannot be read, or has no lines.
    """
    drawing = read_drawing(path)
    if not drawing.lines:
        raise InputError("there is no straight line in it", str(path), "draw members as lines")
    points = np.array([[line.start, line.end] for line in drawing.lines])
    flat = bool(np.ptp(points[:, :, 2]) == 0)
    up = chosen.up or ("y" if flat else "z")
    draft = ModelDraft(path.stem, chosen.accept, up, "xz" if flat and up == "y" else None)
    scale = _scale(drawing, points, chosen, draft)
    if flat:
        points = points - np.array([0.0, 0.0, points[0, 0, 2]])
    nodes = _add_nodes(points, scale, chosen, draft)
    _add_members(drawing, nodes, chosen, draft)
    if len(draft.members) * len(draft.nodes) <= MOST_PAIRS:
        _say_near(draft)
    _say_rest(drawing, draft)
    if flat:
        draft.notes.say(
            "assumed", "axes", "the drawing is the plane x, z of the model, whose z points up"
        )
    draft.notes.say("noticed", "drawing", "lines say nothing of supports and loads: add them")
    return draft


def _scale(drawing: Drawing, points: FloatArray, chosen: Chosen, draft: ModelDraft) -> float:
    """Metres per unit of the drawing."""
    if chosen.units is not None:
        words = [word for word in chosen.units.lower().replace(",", " ").split() if word in LENGTHS]
        if len(words) != 1:
            raise InputError(
                f"{chosen.units!r} is no unit of length", "--units", "write mm, cm, m, in or ft"
            )
        return LENGTHS[words[0]]
    extent = float(np.ptp(points.reshape(-1, 3), axis=0).max())
    if drawing.unit not in CODES:
        draft.notes.say(
            "question", f"$INSUNITS = {drawing.unit}", "the drawing does not say its unit",
            "give it, as --units m",
        )  # fmt: skip
        return 1.0
    name, scale = CODES[drawing.unit]
    if not SMALLEST <= extent * scale <= LARGEST:
        draft.notes.say(
            "question", f"$INSUNITS = {drawing.unit} ({name})",
            f"taken literally the structure would be {extent * scale:.3g} m large",
            "give the unit of its lengths, as --units m",
        )  # fmt: skip
    else:
        draft.notes.say("assumed", f"$INSUNITS = {drawing.unit}", f"lengths are in {name}")
    return scale


def _add_nodes(points: FloatArray, scale: float, chosen: Chosen, draft: ModelDraft) -> IntArray:
    """Add a node for all ends that lie together; numbers of the nodes of lines, int[lines, 2]."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    flat = points.reshape(-1, 3)
    extent = float(np.ptp(flat, axis=0).max()) * scale
    tolerance = chosen.tolerance if chosen.tolerance is not None else TOLERANCE * extent
    pairs = cKDTree(flat * scale).query_pairs(tolerance, output_type="ndarray")
    size = len(flat)
    joined = coo_array((np.ones(len(pairs)), (pairs[:, 0], pairs[:, 1])), shape=(size, size))
    _, labels = connected_components(joined, directed=False)
    first: dict[int, int] = {}
    for place, label in enumerate(labels.tolist()):
        first.setdefault(label, place)
    numbers = {label: number for number, label in enumerate(first, start=1)}
    # What is left of the arithmetic of the drawing's author is no place.
    digits = 12 - int(np.ceil(np.log10(max(extent, 1e-9))))
    placed = np.round(flat * scale, digits) + 0.0
    for label, place in first.items():
        draft.add_node(f"N{numbers[label]}", placed[place].tolist(), "drawing")
    draft.notes.say(
        "assumed", "drawing", f"ends within {tolerance:.3g} m of each other are one node"
    )
    return np.array([numbers[label] for label in labels.tolist()]).reshape(-1, 2)


def _add_members(drawing: Drawing, nodes: IntArray, chosen: Chosen, draft: ModelDraft) -> None:
    section = chosen.sections.get(None)
    material = chosen.materials.get(None)
    names = {
        "the kind of its members": chosen.kind, "their section": section,
        "their material": material,
    }  # fmt: skip
    if missing := [name for name, value in names.items() if value is None]:
        draft.notes.say(
            "question", "drawing", f"lines do not say {', '.join(missing)}", SECTION_REMEDY
        )
    if chosen.kind == "frame" and section is not None:
        needed = ("A", "Iy", "Iz", "J") if draft.plane is None else ("A", "Iy")
        if lacking := [name for name in needed if not section.get(name)]:
            draft.notes.say(
                "question", "--section", f"a frame needs {', '.join(lacking)} as well",
                SECTION_REMEDY,
            )  # fmt: skip
    section_name = draft.section("section", **(section or {"A": 1.0}))
    material_name = draft.material("material", **(material or {"E": 1.0}))
    seen: dict[tuple[int, ...], Line] = {}
    for line, (start, end) in zip(drawing.lines, nodes.tolist(), strict=True):
        if start == end:
            draft.notes.say("dropped", line.where, "a line of no length")
            continue
        key = tuple(sorted((start, end)))
        if key in seen:
            draft.notes.say("dropped", line.where, f"it lies on {seen[key].where}")
            continue
        seen[key] = line
        draft.add_member(
            f"M{len(seen)}", (f"N{start}", f"N{end}"), section_name, material_name, line.where,
            kind=chosen.kind or "truss", groups=[line.layer],
        )  # fmt: skip


def _say_near(draft: ModelDraft) -> None:
    """Name nodes that lie on a member and do not part it."""
    names = list(draft.nodes)
    points = np.array(list(draft.nodes.values()))
    extent = float(np.ptp(points, axis=0).max())
    for name, member in draft.members.items():
        start, end = (np.array(draft.nodes[node]) for node in member["nodes"])
        along = end - start
        shares = (points - start) @ along / (along @ along)
        off = np.linalg.norm(points - start - np.outer(shares, along), axis=1)
        near = (off <= TOLERANCE * extent) & (shares > TOLERANCE) & (shares < 1 - TOLERANCE)
        for k in np.flatnonzero(near):
            if names[k] not in member["nodes"]:
                draft.notes.say(
                    "noticed", f"{names[k]} on {name}",
                    "a node lies on a member that goes on through it: they are not joined",
                )  # fmt: skip


def _say_rest(drawing: Drawing, draft: ModelDraft) -> None:
    for where in drawing.curved:
        draft.notes.refuse(where, "a polyline with an arc", "draw it as lines", "partial")
    for words, where in drawing.texts:
        draft.notes.say("dropped", where, f"the text {words!r}, which is not guessed at")
    for kind, count in drawing.others.items():
        draft.notes.say("dropped", kind, f"{count} of these are in the drawing and no lines")
