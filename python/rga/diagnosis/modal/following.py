"""What of a structure follows the temperature, and makes frequencies follow it.

What the weather does to each mode is free to the search for causes, so that it is taken for none.
Where one part of the structure that follows the temperature explains it in all modes together,
nearly nothing is left for them to have of their own: that part is a cause.
"""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.modal.fit import ModalFit, fitted
from rga.diagnosis.modal.likelihood import PLACES, WEATHER, bent_lines
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.search import MODES_A_CAUSE, ModalFound, Progress
from rga.diagnosis.modal.trials import ModalTrials
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.findings.criteria import Criteria
from rga.model.effects.members.stiffness_temperature import (
    StiffnessTemperature,
    contexts_of_temperature,
    driven_temperatures,
)
from rga.model.parameter import listed

#: shares of a frequency that the weather may do to each mode of its own
OWN = tuple(4.0 * WEATHER / 2.0**k for k in range(7))
#: part of what frequencies follow the weather by that may be left beside a cause: what leaves more
#: is another's doing; so much of the squares, and as a guess of the share
LEFT, ABOUT = 0.2, 0.3
#: places that are fitted, of those that would explain most by slopes
FITTED = 6
#: kinks that are tried by slopes [prior sd]
KINKS = (-1.5, -0.75, 0.0, 0.75, 1.5)


def following_hypotheses(
    trials: ModalTrials[ModalReadings],
) -> tuple[list[Hypothesis], list[Hypothesis]]:
    """Hypotheses of what follows a measured temperature; none where none was.

    Something does: it is one kind, whatever else could be wrong.

    Returns:
        That parts of the structure do, and that all of it does.
    """
    kind, model = StiffnessTemperature, trials.model
    measured = contexts_of_temperature(model) & set(trials.readings.weather)
    if not trials.follows_contexts or not measured:
        return [], []
    places, forms = list(kind.places(model)), kind.forms_on_modes()
    count = len(places) * len(forms)
    parts, whole = (
        [Hypothesis(kind, place, form, count, 1) for place in some for form in forms]
        for some in (places, [{"group": list(model.groups)}])
    )
    return parts, whole


def with_what_follows(found: ModalFound, criteria: Criteria, progress: Progress) -> ModalFound:
    """Causes with one that follows the temperature, where there is one.

    It must be worth its evidence, what is left of the weather in each mode unknown, leave little of
    it, and explain it better than that all of the structure follows alike.

    Args:
        found: causes that act whatever the weather.
        criteria: what decides a verdict.
        progress: called with what is done and the share of it.
    """
    likelihood = found.fit.likelihood
    full = len(found.fit.hypotheses) == criteria.naming.most_causes
    if full or len(likelihood.readings.modes) < MODES_A_CAUSE:
        return found
    parts, whole = following_hypotheses(likelihood.trials)
    if not parts:
        return found
    usual = max((_at(found.fit, own) for own in OWN), key=_density)
    if usual.likelihood.weather == OWN[-1]:
        return found
    fits = []
    for number, (hypothesis, z) in enumerate(_promising(usual, parts)):
        progress("looking for what follows the temperature", number / FITTED)
        fits.append(_fitted_beside(usual, hypothesis, z))
    progress("looking for what follows the temperature", 1.0)
    fits.sort(key=lambda one: -_density(one))
    best = fits[0]
    gain = _density(best) - _density(usual)
    little = best.likelihood.explains_weather
    little &= _weather_left(best) < LEFT * _weather_left(usual)
    if gain < criteria.naming.log_odds or not little:
        return found
    # Modes that follow alike, or bend at the same place, each by its own share, show no part yet.
    alike = [_density(_fitted_beside(usual, *one)) for one in _promising(usual, whole)]
    if _density(best) - max(*alike, _bending(usual)) < criteria.rivals.log_odds:
        return found

    def beside(one: ModalFit) -> ModalFit:
        """A fit with its evidence as that of the causes is counted."""
        against = found.fit.log_evidence + _density(one) - _density(usual)
        return replace(one, log_evidence=against)

    follower, size = best.hypotheses[-1], best.z[best.of(len(best.hypotheses) - 1)]
    rivals = [
        (beside(one), _density(best) - _density(one))
        for one in fits[1:]
        if not follower.same_place(one.hypotheses[-1])
    ]
    others = [
        tuple(
            (beside(fitted(best.likelihood, [follower, *one.hypotheses], [*size, *one.z])), behind)
            for one, behind in ranked
        )
        for ranked in found.rivals
    ]
    return ModalFound(beside(best), (*found.log_odds, gain), (*others, tuple(rivals)), found.first)


def _at(fit: ModalFit, own: float) -> ModalFit:
    """The causes anew, where the weather may do so much to each mode of its own."""
    return fitted(fit.likelihood.with_weather(own), fit.hypotheses, fit.z)


def _density(fit: ModalFit) -> float:
    """Log evidence that compares whatever the weather may do to each mode of its own."""
    return fit.log_evidence + fit.likelihood.of_nothing


def _bending(usual: ModalFit) -> float:
    """Log evidence of causes where all modes bend at one place as they follow the weather."""
    several = [
        _density(
            fitted(usual.likelihood.with_weather(own).bending(bend), usual.hypotheses, usual.z)
        )
        for own in OWN
        for bend in PLACES.tolist()
    ]
    return max(several) - float(np.log(len(PLACES)))


def _weather_left(fit: ModalFit) -> float:
    """By how much frequencies follow the weather beside causes: squares, by those of the noise."""
    likelihood = fit.likelihood
    readings = likelihood.readings
    off = likelihood.frequencies_off(fit.prediction or likelihood.trials.predict({}))
    courses = bent_lines(readings.weather, len(readings.time)).T
    total = 0.0
    for mode, scatter in enumerate(readings.scatter):
        seen = np.isfinite(readings.log_f[:, mode])
        columns = courses[seen] - courses[seen].mean(axis=0)
        followed = columns @ (np.linalg.pinv(columns) @ off[seen, mode])
        total += float(followed @ followed) / scatter**2
    return total


def _fitted_beside(usual: ModalFit, hypothesis: Hypothesis, z: FloatArray) -> ModalFit:
    """Causes with one more, and the likeliest share that the weather does beside it."""
    several, start = [*usual.hypotheses, hypothesis], np.array([*usual.z, *z])
    best = fitted(usual.likelihood, several, start)
    for own in OWN:
        if own < best.likelihood.weather:
            one = fitted(usual.likelihood.with_weather(own), several, best.z)
            if _density(one) < _density(best):
                break
            best = one
    return best


def _promising(
    usual: ModalFit, candidates: Sequence[Hypothesis]
) -> list[tuple[Hypothesis, FloatArray]]:
    """Hypotheses that would explain most by slopes, with where a fit of each begins."""
    likelihood = usual.likelihood.with_weather(ABOUT * usual.likelihood.weather)
    trials = likelihood.trials
    strain, _ = trials.slopes()
    groups = trials.model.groups
    members = {name: number for number, name in enumerate(trials.model.members)}
    (context,) = contexts_of_temperature(trials.model)
    temperature = trials.readings.contexts[context]
    (delta, *_) = driven_temperatures(trials.model)
    left = likelihood.residual(usual.prediction or trials.predict({}))
    scored = []
    for one in candidates:
        chosen = {name for group in listed(one.place["group"]) for name in groups[group]}
        own = strain[:, [members[name] for name in sorted(chosen)]].sum(axis=1)
        for kink in KINKS if "kink" in one.priors else (None,):
            courses = _courses(one, temperature, delta.minus, kink)
            columns = np.concatenate(
                [
                    share * white
                    for share, white in zip(own, likelihood.steps(courses), strict=True)
                ],
                axis=1,
            )
            along = columns @ left[: columns.shape[1]]
            information = columns @ columns.T + np.eye(len(columns))
            z = np.linalg.solve(information, along)
            score = 0.5 * float(along @ z - np.linalg.slogdet(information)[1])
            scored.append((score, one, z if kink is None else np.array([*z, kink])))
    best: dict[int, tuple[float, Hypothesis, FloatArray]] = {}
    for entry in sorted(scored, key=lambda entry: -entry[0]):
        best.setdefault(id(entry[1]), entry)
    return [(one, z) for _, one, z in list(best.values())[:FITTED]]


def _courses(
    one: Hypothesis, temperature: FloatArray, reference: float, kink: float | None
) -> FloatArray:
    """Of ln of a stiffness over the windows by each slope at one prior sd, float[k, windows]."""
    spreads = [prior.value(1.0) for name, prior in one.priors.items() if name != "kink"]
    if kink is None:
        return np.array([spreads[0] * (temperature - reference)])
    warmer = temperature - one.priors["kink"].value(kink)
    return np.array([spreads[0] * np.maximum(warmer, 0.0), spreads[1] * np.minimum(warmer, 0.0)])
