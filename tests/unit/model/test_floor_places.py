"""Where a floor may carry a share of a chord's force."""

import pytest

from rga.model import read_model
from rga.model.effects.members.floor_participation import FloorParticipation

LOW = {f"L{k}": [4.0 * k, 0.0, 0.0] for k in range(4)}


def places(height: float) -> list[str]:
    """Groups of a truss whose top chord rises by so much from one node to the next."""
    high = {f"U{k}": [4.0 * k, 0.0, 3.0 + height * k] for k in range(1, 4)}
    groups = {
        "bottom": [("L0", "L1"), ("L1", "L2"), ("L2", "L3")],
        "top": [("U1", "U2"), ("U2", "U3")],
        "web": [("L0", "U1"), ("U1", "L2"), ("L2", "U3")],
        "posts": [("L1", "U1"), ("L2", "U2"), ("L3", "U3")],
    }
    content = {
        "rga_model": 1,
        "name": "truss",
        "materials": {"steel": {"E": 2e11}},
        "sections": {"bar": {"A": 0.002}},
        "nodes": LOW | high,
        "members": {
            f"{i}-{j}": {"nodes": [i, j], "section": "bar", "material": "steel", "groups": [group]}
            for group, pairs in groups.items()
            for i, j in pairs
        },
        "supports": {"west": {"node": "L0", "fixed": ["ux", "uy", "uz"]}},
    }
    model = read_model(content, "test")
    return [place["group"] for place in FloorParticipation.places(model)]


@pytest.mark.parametrize(
    ("height", "chords"), [(0.0, ["bottom", "top"]), (0.4, ["bottom", "top"]), (2.5, ["bottom"])]
)
def test_a_floor_runs_along_chords_and_not_along_webs_or_rakers(
    height: float, chords: list[str]
) -> None:
    assert places(height) == chords
