"""What stands on the page of a diagnosis by modes, made ready for the template."""

import re
from typing import Any

import numpy as np

from rga.drawing.figure_style import FONTS
from rga.findings import Findings
from rga.findings.modal_arrays import ModalArrays, ModeReading
from rga.findings.phrases import effect_words, place_words
from rga.model import Effect
from rga.quantities import DASH, counted, number, percent
from rga.report.figures.modes import draw_frequencies, draw_shapes
from rga.report.pages.diagnosis_page import VERDICTS, provenance

SHAPES = (
    "Modes on the structure: computed lines, and nodes as they were measured, to the same scale; "
    "left as given, right with the causes."
)
FREQUENCIES = "Natural frequencies in the windows, measured and simulated."


def modal_page(findings: Findings, account: ModalArrays) -> dict[str, Any]:
    """The variables of the template."""
    figures = [{"svg": draw_shapes(account), "words": SHAPES}]
    over_time = draw_frequencies(account)
    if over_time is not None:
        figures.append({"svg": over_time, "words": FREQUENCIES})
    headline, *rest = re.split(r"(?<=\.) (?=[A-Z])", findings.sentence())
    return {
        "fonts": FONTS,
        "model_name": account.model.name,
        "headline": headline,
        "rest": " ".join(rest),
        "verdict": findings.verdict,
        "verdict_words": VERDICTS[findings.verdict],
        "windows": (
            f"{counted(len(account.modes), 'mode')} in {counted(len(account.time), 'window')}"
        ),
        "doubts": [one for one in findings.unexplained.looks_like.split("; ") if one],
        "warnings": findings.warnings,
        "causes": [
            {
                "status": one.status,
                "odds": number(one.log_odds),
                "words": effect_words(one.effect),
                "why": one.why,
                "inspect": _inspect(one.effect),
                "separated_by": one.separated_by,
                "rivals": [effect_words(rival) for rival in one.rivals],
            }
            for one in findings.causes
        ],
        "modes": [_line(one) for one in account.modes],
        "figures": figures,
        "explanations": [
            {
                "words": one.words,
                "odds": f"{one.log_odds:+.1f}",
                "gap": number(one.gap),
                "remark": one.remark,
            }
            for one in findings.explanations
        ],
        "provenance": provenance(findings, account.model),
    }


def _inspect(effect: dict[str, Any]) -> str:
    kind = Effect.vocabulary[effect["kind"]]
    place = place_words(effect[name] for name in kind.place_fields() if effect.get(name))
    return kind.action.inspect.replace("{place}", place)


def _line(mode: ModeReading) -> dict[str, str]:
    off = [100 * float(np.expm1(np.nanmean(mode.log_f - one))) for one in (mode.before, mode.after)]
    return {
        "name": mode.name,
        "found": f"{100 * mode.found:.0f}",
        "frequency": f"{mode.frequency:.4g}",
        "scatter": f"{100 * mode.scatter:.2g}",
        "number": f"{mode.number[0]} → {mode.number[1]}",
        "off": " → ".join(percent(one) for one in off),
        "mac": " → ".join(f"{one:.2f}" if np.isfinite(one) else DASH for one in mode.mac),
    }
