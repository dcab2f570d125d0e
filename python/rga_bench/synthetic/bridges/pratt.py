"""Through Pratt bridge: ten panels, 48 m, two trusses, simply supported."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge, Draft, section, steel

_PANELS, _PANEL, _HEIGHT, _WIDTH = 10, 4.8, 5.6, 5.2


def pratt(rng: np.random.Generator) -> Bridge:
    """Sizes and sensor quality vary with ``rng``, the layout does not."""
    size, stout = rng.uniform(0.85, 1.25), rng.uniform(0.8, 2.5)
    draft = Draft(
        "Mill Lane through bridge",
        {"steel": steel()},
        {
            "C1": section(0.014 * size, 6.0e-4 * stout, 3e-6),
            "W1": section(0.007 * size, 1.5e-4 * stout, 8e-7),
            "F1": section(0.011, 1.6e-4, 1e-6),
            "B1": section(0.0022, 9e-7, 9e-8),
        },
    )
    half = _WIDTH / 2
    for side, y in (("a", -half), ("b", half)):
        for i in range(_PANELS + 1):
            draft.node(f"{i}{side}", i * _PANEL, y, 0.0)
        for i in range(1, _PANELS):
            draft.node(f"{i}{side}t", i * _PANEL, y, _HEIGHT)
    for side in "ab":
        _truss(draft, side)
    _bracing(draft)
    last = str(_PANELS)
    draft.support("A1", "0a", "ux", "uy", "uz")
    draft.support("A2", "0b", "ux", "uz")
    draft.support("B1", f"{last}a", "uy", "uz")
    draft.support("B2", f"{last}b", "uz")
    _loads(draft)
    _sensors(draft, float(rng.uniform(0.1, 0.25)), float(rng.uniform(0.7, 1.4)))
    return Bridge(
        name="pratt",
        model=draft.model,
        roles={
            "temperature": "temperature",
            "area": "crowd",
            "position": "cart_x",
            "weight": "cart_w",
            "idle": "wind",
        },
        peaks={
            "area": 4.0,
            "position": _PANELS * _PANEL,
            "weight": float(rng.uniform(4e4, 9e4)),
            "idle": 250.0,
        },
        bearings=[("B1", "ux"), ("B2", "ux")],
        floor=["lower chord"],
        jointed=["lower chord", "upper chord", "end diagonal", "post", "diagonal"],
        area_load="people",
        carts=["cart a", "cart b"],
    )


def _truss(draft: Draft, side: str) -> None:
    truss = f"truss {side}"
    for i in range(_PANELS):
        draft.member((f"{i}{side}", f"{i + 1}{side}"), "C1", ["lower chord", truss])
    for i in range(1, _PANELS - 1):
        draft.member((f"{i}{side}t", f"{i + 1}{side}t"), "C1", ["upper chord", truss])
    draft.member((f"0{side}", f"1{side}t"), "C1", ["end diagonal", truss])
    end = (f"{_PANELS - 1}{side}t", f"{_PANELS}{side}")
    draft.member(end, "C1", ["end diagonal", truss])
    for i in range(1, _PANELS):
        draft.member((f"{i}{side}", f"{i}{side}t"), "W1", ["post", truss])
    for i in range(1, _PANELS - 1):
        rising = (f"{i}{side}t", f"{i + 1}{side}")
        falling = (f"{i}{side}", f"{i + 1}{side}t")
        draft.member(rising if i < _PANELS // 2 else falling, "W1", ["diagonal", truss])


def _bracing(draft: Draft) -> None:
    for i in range(_PANELS + 1):
        draft.member((f"{i}a", f"{i}b"), "F1", ["cross girder"])
    for i in range(_PANELS):
        for one, other in (("a", "b"), ("b", "a")):
            draft.member((f"{i}{one}", f"{i + 1}{other}"), "B1", ["wind bracing low"])
    for i in range(1, _PANELS):
        draft.member((f"{i}at", f"{i}bt"), "B1", ["strut"])
        draft.member((f"{i}a", f"{i}bt"), "B1", ["portal"])
        draft.member((f"{i}b", f"{i}at"), "B1", ["portal"])
    for i in range(1, _PANELS - 1):
        for one, other in (("a", "b"), ("b", "a")):
            draft.member((f"{i}{one}t", f"{i + 1}{other}t"), "B1", ["wind bracing high"])


def _loads(draft: Draft) -> None:
    span = _PANELS * _PANEL
    draft.context("temperature", "degC", -25, 45)
    draft.context("crowd", "kN/m2", 0, 6)
    draft.context("cart_x", "m", 0, span)
    draft.context("cart_w", "N", 0, 120000)
    draft.context("wind", "Pa", 0, 800)
    groups = {m["groups"][0]: 1.0 for m in draft.model["members"].values()}
    draft.warmth("season", "temperature", 12.0, groups)
    tributary = 1e3 * _PANEL * _WIDTH / 2
    down = {
        f"{i}{side}": tributary * (0.5 if i in (0, _PANELS) else 1.0)
        for i in range(_PANELS + 1)
        for side in "ab"
    }
    draft.area("people", "crowd", down)
    for side in "ab":
        path = [f"{i}{side}" for i in range(_PANELS + 1)]
        draft.cart(f"cart {side}", path, 0.5, "cart_x", "cart_w")


def _sensors(draft: Draft, mm: float, strain: float) -> None:
    number = 0
    for side in "ab":
        for i in (1, 3, 4, 5, 6, 7, 9):
            number += 1
            draft.moves(f"LVDT{number:02d}", f"{i}{side}", [0, 0, 1], round(mm, 3))
        number += 1
        draft.moves(f"LVDT{number:02d}", f"{_PANELS}{side}", [1, 0, 0], round(mm, 3))
    for i in (3, 5, 7):
        number += 1
        draft.moves(f"LVDT{number:02d}", f"{i}b", [0, 1, 0], round(mm, 3))
    gauges = ["2{s}-3{s}", "4{s}-5{s}", "7{s}-8{s}", "4{s}t-5{s}t", "1{s}t-2{s}", "7{s}-8{s}t"]
    names = [g.format(s=s) for s in "ab" for g in gauges]
    for k, member in enumerate(names, 1):
        draft.strains(f"SG{k:02d}", member, round(strain, 3))
