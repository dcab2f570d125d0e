"""The bridge of the case study at full fidelity: 20 panels, 84 displacement sensors, 8 contexts.

None of its contexts is measured: the twin has to infer them all.
"""

from __future__ import annotations

from rga_bench.synthetic.bridges.case_study import (
    SIDES,
    SPAN,
    actions,
    drafted,
    low,
    steelwork,
    top,
)
from rga_bench.synthetic.bridges.model_draft import Draft, ModelDict

PANELS = 20
#: sides of the six panels of the bottom chord that may have lost area
WEAKENED = "middle bottom chord"
_WORN = range(PANELS // 2 - 3, PANELS // 2 + 3)
_MM = 0.3  # noise of the sensors


def full_case_study() -> ModelDict:
    """The twin's model of the bridge; the same every time."""
    draft = drafted("footbridge, full case study")
    steelwork(draft, PANELS)
    for side in SIDES:
        for i in _WORN:
            member = draft.model["members"][f"{side}.L{i}-L{i + 1}"]
            member["groups"].append(WEAKENED)
    draft.context("temperature", "K", -30.0, 30.0)
    draft.context("gradient", "K", -5.0, 15.0)
    draft.context("crowd", "kPa", 0.3, 5.0)
    draft.context("position", "m", 0.2 * SPAN, 0.8 * SPAN)
    draft.context("eccentricity", "-", -0.6, 0.6)
    draft.context("bearing", "log10 N/mm", 3.0, 5.5)
    draft.context("loss", "-", 0.0, 0.3)
    draft.context("wind", "kPa", -1.0, 1.0)
    actions(draft, PANELS)
    draft.model["effects"]["bearings"] = {
        "kind": "support_spring",
        "support": [f"east {side}" for side in SIDES],
        "dof": "ux",
        "stiffness": {"context": "bearing", "minus": -3.0, "log10": True},
    }
    draft.model["effects"]["section loss"] = {
        "kind": "member_stiffness",
        "group": WEAKENED,
        "factor": {"context": "loss", "times": -1.0, "minus": 1.0},
    }
    for side in SIDES:
        _sensors(draft, side)
    return draft.model


def _sensors(draft: Draft, side: str) -> None:
    for i in range(1, PANELS):
        draft.moves(f"{side} z{i}", low(side, i), [0, 0, 1], _MM)
    for i in range(1, PANELS, 2):
        draft.moves(f"{side} y top {i}", top(side, i), [0, 1, 0], _MM)
    for i in range(PANELS // 4, PANELS, PANELS // 4):
        draft.moves(f"{side} y{i}", low(side, i), [0, 1, 0], _MM)
    for i in range(2, PANELS + 1, 2):
        draft.moves(f"{side} x{i}", low(side, i), [1, 0, 0], _MM)
