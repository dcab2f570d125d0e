"""Effects that make no sense are refused, with the words of what is wrong."""

from typing import Any

import pytest

from every_kind_bridge import bridge
from rga.errors import InputError

REFUSED: list[tuple[dict[str, Any], str]] = [
    ({"kind": "member_stiffness", "factor": 0.9}, "needs a place"),
    ({"kind": "joint_slip", "slip": 1e-3}, "needs a place"),
    ({"kind": "support_flexibility", "support": "D", "dof": "ux", "stiffness": 1e8}, "leaves ux"),
    ({"kind": "bearing_friction", "support": "A", "dof": "ux", "mu": 0.1}, "holds ux"),
    ({"kind": "added_axial_area", "group": "webs", "area": -0.1}, "below 0"),
    ({"kind": "floor_participation", "group": "webs", "area": 0.1}, "connector_stiffness"),
    ({"kind": "load_scale", "effect": "own stiffness", "factor": 1.1}, "name a load"),
    ({"kind": "load_eccentricity", "effect": "warmth", "share": 0.1}, "name a load"),
    (
        {
            "kind": "unmodelled_load",
            "group": "webs",
            "direction": [0, 0, 0],
            "context": "wind",
            "rate": 1.0,
        },
        "points nowhere",
    ),
    ({"kind": "sensor_swap", "sensors": ["D1", "D1"]}, "two that differ"),
]


@pytest.mark.parametrize(("effect", "words"), REFUSED, ids=lambda part: str(part)[:40])
def test_what_makes_no_sense_is_refused(effect: dict[str, Any], words: str) -> None:
    with pytest.raises(InputError, match=words):
        bridge(
            **{
                "own stiffness": {"kind": "member_stiffness", "group": "webs", "factor": 0.9},
                "own": effect,
            }
        )


def test_a_stiffness_needs_one_temperature_to_follow() -> None:
    own = {"kind": "stiffness_temperature", "group": "webs", "rate": 0.01}
    sun = {"kind": "temperature", "groups": {"webs": 1.0}}
    with pytest.raises(InputError, match="temperature and wind"):
        bridge(own=own, sun={**sun, "delta": {"context": "wind"}})
    with pytest.raises(InputError, match="no member of the group bends"):
        bridge(own={**own, "of": "EI"})
    with pytest.raises(InputError, match="holds below a kink: give kink"):
        bridge(own={**own, "below": -0.01})
    with pytest.raises(InputError, match="-10 1/K, by which the stiffness changes by 1000 %"):
        bridge(own={**own, "kink": 0.0, "below": -10.0})
    with pytest.raises(InputError, match="kink"):
        bridge(own=own, sun={**sun, "delta": {"context": "temperature"}})
