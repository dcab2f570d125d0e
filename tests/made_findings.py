"""Findings written by hand, for tests of what is made of them."""

from typing import Any

from rga.findings import Findings


def cause(
    effect: dict[str, Any], *rivals: dict[str, Any], separated_by: str = ""
) -> dict[str, Any]:
    return {
        "effect": effect,
        "status": "ambiguous" if rivals else "named",
        "log_odds": 20.0,
        "d_prime": 8.0,
        "d_perp": 4.0,
        "rivals": list(rivals),
        "separated_by": separated_by,
    }


def tried(*effects: dict[str, Any]) -> dict[str, Any]:
    return {"words": "tried", "effects": list(effects), "log_odds": 1.0, "gap": 1.0}


def findings(*causes: dict[str, Any], explanations: tuple[dict[str, Any], ...] = ()) -> Findings:
    held_out = {"before": 2.0, "after": 1.0, "gain": 1.0, "gain_ci90": [0.5, 1.5]}
    return Findings.model_validate(
        {
            "verdict": "named",
            "gap": {"before": 2.0, "after": 1.0, "held_out": held_out, "by_sensor": {}},
            "causes": list(causes),
            "unexplained": {"share": 0.0, "looks_like": ""},
            "explanations": list(explanations),
            "seed": 0,
            "model_sha256": "",
            "record_sha256": "",
        }
    )
