"""The explanations between which findings leave a choice."""

from collections.abc import Mapping, Sequence
from itertools import combinations
from typing import Any

from pydantic import ValidationError

from rga.errors import InputError
from rga.experiments.explanation import CandidateModel, explanation
from rga.findings.phrases import effect_words, explanation_words
from rga.findings.schema import Cause, Findings
from rga.model import Effect, Model, read_effect
from rga.model.effects.sensors.sensor_fault import is_fault

#: rivals of a cause that are separated, and alternatives against which one without is confirmed
NEAREST = 4


def rival_pairs(model: Model, findings: Findings) -> list[tuple[CandidateModel, CandidateModel]]:
    """Each cause and its nearest rivals two by two, the other causes beside all of them.

    Causes without rivals are put beside the nearest explanations that were tried, and beside no
    effect at all.

    Raises:
        InputError: an effect of the findings is unknown, or does not fit the model.
    """
    causes = [cause for cause in findings.causes if not is_fault(cause.effect)]
    if not causes:
        return []
    named = [cause.effect for cause in causes]
    together = _explained(model, named)
    pairs = []
    for number, cause in enumerate(causes):
        others = [*named[:number], *named[number + 1 :]]
        rivals = [
            _explained(model, _as_fitted(findings, [*others, rival]))
            for rival in sorted(cause.rivals, key=lambda one: not _advised_against(cause, one))[
                :NEAREST
            ]
        ]
        pairs += list(combinations([together, *rivals], 2))
    if pairs:
        return pairs
    return [(together, _explained(model, effects)) for effects in _nearest(findings, causes)]


def told_apart(findings: Findings, one: str, other: str) -> float | None:
    """Log-odds by which the record of findings tells one explanation from another.

    Args:
        findings: that have tried both.
        one, other: in words.

    Returns:
        They, for the first, with what is usual of its parameters counted; None where either was not
        tried as it stands, or where they are rivals by the data alone: what is usual of a modulus,
        a mass or a clock tells nothing apart.
    """
    odds = {tried.words: tried.log_odds for tried in findings.explanations}
    if one not in odds or other not in odds:
        return None
    apart = odds[one] - odds[other]
    rivals = any(cause.rivals for cause in findings.causes)
    return None if rivals and abs(apart) >= findings.criteria.rivals.log_odds else apart


def working_sensors(model: Model, findings: Findings) -> list[str]:
    """Sensors of the model that no finding calls faulty."""
    faulty = {cause.effect.get("sensor") for cause in findings.causes if is_fault(cause.effect)}
    return [name for name in model.sensors if name not in faulty]


def _advised_against(cause: Cause, rival: Mapping[str, Any]) -> bool:
    """Whether it is this rival from which the findings advise how to recognise the cause."""
    return cause.separated_by.startswith(f"against {effect_words(rival)}:")


def _explained(model: Model, effects: Sequence[Mapping[str, Any]]) -> CandidateModel:
    known = [_effect(model, effect) for effect in effects]
    return explanation(explanation_words(effects), model, known)


def _effect(model: Model, content: Mapping[str, Any]) -> Effect:
    where = "findings"
    try:
        effect = read_effect(dict(content), where)
        model.check_effect(effect, where)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        problem = f"{content.get('kind')}, {'.'.join(map(str, first['loc']))}: {first['msg']}"
        raise InputError(problem, where, "give findings as the diagnosis wrote them") from None
    except (ValueError, KeyError) as error:
        raise InputError(
            str(error), where, f"give the findings of the model {model.name!r}"
        ) from None
    return effect


def _as_fitted(
    findings: Findings, effects: Sequence[Mapping[str, Any]]
) -> Sequence[Mapping[str, Any]]:
    """The effects as they were fitted together, where they were."""
    wanted = sorted(map(_place, effects))
    for tried in findings.explanations:
        if sorted(map(_place, tried.effects)) == wanted:
            return tried.effects
    return effects


def _nearest(findings: Findings, causes: Sequence[Cause]) -> list[Sequence[Mapping[str, Any]]]:
    """Explanations near the causes that leave out one of them at least; no effect at all."""
    named = {_place(cause.effect) for cause in causes}
    others: list[Sequence[Mapping[str, Any]]] = [
        tried.effects
        for tried in findings.explanations
        if tried.effects and not named <= set(map(_place, tried.effects))
    ]
    return [*others[:NEAREST], []]


def _place(effect: Mapping[str, Any]) -> str:
    kind = Effect.vocabulary.get(str(effect.get("kind")))
    fields = kind.place_fields() if kind else {}
    return repr((effect.get("kind"), [(name, effect.get(name)) for name in fields]))
