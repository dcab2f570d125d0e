"""Models to draw."""

from collections.abc import Callable
from typing import Any

import pytest

from rga.model import Model, read_model

#: E I of the beam [N m2] and its span [m]
STIFFNESS, SPAN = 2e11 * 1e-5, 3.0


@pytest.fixture
def beam() -> Callable[..., Model]:
    """Makes a model of one frame member along x, loaded at its second node; keys replace parts."""

    def made(member: dict[str, Any] | None = None, **parts: Any) -> Model:
        own = {"nodes": ["a", "b"], "section": "s", "material": "m", "kind": "frame"}
        content: dict[str, Any] = {
            "rga_model": 1,
            "name": "beam",
            "plane": "xz",
            "materials": {"m": {"E": 2e11}},
            "sections": {"s": {"A": 1e-2, "Iy": 1e-5, "Iz": 1e-5, "J": 1e-5}},
            "nodes": {"a": [0, 0, 0], "b": [SPAN, 0, 0]},
            "members": {"ab": {**own, **(member or {})}},
            "supports": {"wall": {"node": "a", "fixed": ["ux", "uz", "ry"]}},
            "context": {"crane": {"unit": "kN", "range": [0, 10]}},
            "effects": {
                "crane": {
                    "kind": "nodal_load",
                    "forces": {"b": [0, 0, -1000]},
                    "factor": {"context": "crane"},
                }
            },
            **parts,
        }
        return read_model(content, "beam")

    return made


@pytest.fixture
def hostile(beam: Callable[..., Model]) -> Model:
    """A model whose names are markup, formulas, long or in scripts that few fonts have."""
    node = "桁" * 40
    member = {"nodes": ["<b>", node], "groups": ["</script>", "$\\frac{1}{2}$"]}
    return beam(
        name="</script><script>alert(1)</script> \"'& " + "x" * 150,
        nodes={"<b>": [0, 0, 0], node: [SPAN, 0, 0]},
        members={"<img src=x onerror=alert(1)>": {**member, "section": "s", "material": "m",
                                                  "kind": "frame"}},
        supports={"<s>": {"node": "<b>", "fixed": ["ux", "uz", "ry"]}},
        effects={"<load>": {"kind": "nodal_load", "forces": {node: [0, 0, -1e3]}}},
        sensors={"<i>": {"kind": "displacement", "node": node, "direction": [0, 0, 1],
                               "unit": "mm"}},
    )  # fmt: skip
