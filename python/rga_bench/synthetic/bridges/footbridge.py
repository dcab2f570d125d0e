"""Plane footbridge: a pony Warren truss on a continuous bottom chord, no cart."""

from __future__ import annotations

import numpy as np

from rga_bench.synthetic.bridges.model_draft import Bridge, Draft, section, steel

_PANELS, _PANEL, _HEIGHT = 9, 2.6, 2.0


def footbridge(rng: np.random.Generator) -> Bridge:
    """Sizes and sensor quality vary with ``rng``, the layout does not."""
    size, stout = rng.uniform(0.85, 1.2), rng.uniform(0.6, 1.6)
    draft = Draft(
        "park footbridge",
        {"tube steel": steel(2.1e11), "aluminium": {**steel(7.0e10), "alpha": 2.3e-5}},
        {
            "lower": section(0.0055 * size, 3.2e-5 * stout, 1.6e-5),
            "upper": section(0.0065 * size, 4.0e-5 * stout, 2e-5),
            "web": section(0.0045 * size, 1.6e-5 * stout, 8e-6),
        },
    )
    draft.model["plane"] = "xz"
    for i in range(_PANELS + 1):
        draft.node(f"b{i}", i * _PANEL, 0.0, 0.0)
    for i in range(_PANELS):
        draft.node(f"t{i}", (i + 0.5) * _PANEL, 0.0, _HEIGHT)
    for i in range(_PANELS):
        half = "left half" if 2 * i < _PANELS else "right half"
        draft.member(
            (f"b{i}", f"b{i + 1}"),
            "lower",
            ["deck chord", half],
            name=f"deck{i + 1}",
            material="tube steel",
            kind="frame",
        )
        for k, end in enumerate((i, i + 1)):
            draft.member(
                (f"t{i}", f"b{end}"),
                "web",
                ["bracing", half],
                name=f"brace{2 * i + k + 1}",
                material="aluminium",
            )
    for i in range(_PANELS - 1):
        half = "left half" if 2 * i + 1 < _PANELS else "right half"
        draft.member(
            (f"t{i}", f"t{i + 1}"),
            "upper",
            ["rail chord", half],
            name=f"rail{i + 1}",
            material="tube steel",
        )
    draft.support("abutment", "b0", "ux", "uz")
    draft.support("rocker", f"b{_PANELS}", "uz")
    draft.context("air", "degC", -15, 45)
    draft.context("people", "kN/m", 0, 12)
    draft.context("snow", "kN/m2", 0, 3)
    draft.warmth("heating", "air", 14.0, {"deck chord": 0.85, "bracing": 1.0, "rail chord": 1.0})
    inner = {f"b{i}": 1e3 * _PANEL for i in range(1, _PANELS)}
    ends = {f"b{i}": 5e2 * _PANEL for i in (0, _PANELS)}
    draft.area("walkers", "people", {**inner, **ends})
    _sensors(draft, float(rng.uniform(0.06, 0.15)), float(rng.uniform(0.8, 1.6)))
    return Bridge(
        name="footbridge",
        model=draft.model,
        roles={"temperature": "air", "area": "people", "idle": "snow"},
        peaks={"area": 7.0, "idle": 1.5},
        bearings=[("rocker", "ux")],
        floor=["deck chord"],
        jointed=["bracing", "rail chord"],
        area_load="walkers",
        push=(0.0, 0.0, -1.0),
    )


def _sensors(draft: Draft, mm: float, strain: float) -> None:
    for i in range(1, _PANELS):
        draft.moves(f"w{i}", f"b{i}", [0, 0, 1], round(mm, 3))
    draft.moves("joint", f"b{_PANELS}", [1, 0, 0], round(mm, 3))
    draft.tilts("tiltL", "b0", [0, 1, 0], round(0.3 * mm, 4))
    draft.tilts("tiltR", f"b{_PANELS}", [0, 1, 0], round(0.3 * mm, 4))
    gauged = ["deck2", "deck4", "deck5", "deck7", "rail2", "rail4", "rail5", "rail7"]
    for name in [*gauged, "brace2", "brace3", "brace7", "brace12", "brace15", "brace16"]:
        draft.strains(f"g_{name}", name, round(strain, 3))
