"""What stands on the page of a diagnosis by modes, made ready for the template."""

import re
from typing import Any

from rga.drawing.figure_style import FONTS
from rga.findings import Findings
from rga.findings.modal_arrays import ModalArrays
from rga.findings.phrases import effect_words
from rga.quantities import number
from rga.report.pages.diagnosis_page import provenance, verdict_words
from rga.report.pages.modes_section import modes_section
from rga.report.text.actions import actions


def modal_page(findings: Findings, account: ModalArrays) -> dict[str, Any]:
    """The variables of the template."""
    headline, *rest = re.split(r"(?<=\.) (?=[A-Z])", findings.sentence())
    return {
        "fonts": FONTS,
        "model_name": account.model.name,
        "headline": headline,
        "rest": " ".join(rest),
        "verdict": findings.verdict,
        "verdict_words": verdict_words(findings),
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
        "modes": modes_section(account),
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
    """The first thing that a cause calls for."""
    return actions(effect)[0][1]
