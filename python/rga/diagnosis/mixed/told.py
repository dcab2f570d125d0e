"""What modes add to the findings of a record."""

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis.assemble.effects import content, estimated_effects, last_effect
from rga.diagnosis.checks.explanations import Tried
from rga.diagnosis.mixed.fit import MixedFit
from rga.diagnosis.mixed.search import MixedFound
from rga.diagnosis.modal.account import (
    by_sensor,
    mode_gap,
    mode_groups,
    mode_readings,
    windows_of,
)
from rga.diagnosis.modal.changes import change, moved_modes
from rga.diagnosis.modal.checks import modes_off, pairs_in_doubt, squares
from rga.diagnosis.modal.doubts import (
    apart_in_time,
    doubts_of_windows,
    drifting,
    following_contexts,
    following_doubts,
    lagging,
    thin,
    unlike_modes,
    warnings_of,
    weather,
)
from rga.diagnosis.modal.likelihood import MODEL_ERROR, ModalLikelihood
from rga.diagnosis.modal.prediction import Prediction
from rga.diagnosis.modal.remarks import rival_words
from rga.diagnosis.modal.separating import separating
from rga.diagnosis.noise.covariance import Reduced
from rga.diagnosis.search.laplace import effects_at, extended
from rga.findings import Findings
from rga.findings.modal_arrays import ModalArrays
from rga.findings.phrases import effect_words, explanation_words, place_words
from rga.findings.schema import Cause, Explanation, Unidentifiable
from rga.model import Model
from rga.records import Record

#: d' below which a cause does not show in a kind of data
SHOWS = 1.0
#: decimals of log-odds
DECIMALS = 2


@dataclass(frozen=True)
class ToldModes:
    """Modes beside the findings of a record.

    Args:
        mixed: the end of a search in both.
        record: gives times as they are written.
    """

    mixed: MixedFound
    record: Record

    @property
    def _nothing(self) -> Prediction:
        return self._likelihood.trials.predict({})

    @cached_property
    def _likelihood(self) -> ModalLikelihood:
        """What is told is held against what a model usually misses, whatever this one does."""
        return self.mixed.evidence.likelihood.with_level(MODEL_ERROR)

    @property
    def _after(self) -> Prediction:
        return self.mixed.fit.modal.prediction or self._nothing

    def doubts(self) -> list[str]:
        """In words: why the causes do not account for the modes."""
        likelihood, modal = self._likelihood, self.mixed.fit.modal
        readings = likelihood.readings
        words = modes_off(likelihood, self._after) + pairs_in_doubt(likelihood, self._after)
        shown = [number for number in range(len(modal.hypotheses)) if self._shows(number)]
        if shown:
            before, after = self._left_out
            of_structure = any(not modal.hypotheses[number].at_points for number in shown)
            if of_structure and after.mean() >= before.mean():
                words.append("modes that were left out are predicted no better with the causes")
            words += thin(readings, causes=True)
        words += unlike_modes(readings) + doubts_of_windows(
            likelihood, effects_at(modal.hypotheses, modal.z)
        )
        alone = [modal.hypotheses[number] for number in shown if not self._in_record(number)]
        words += weather(readings, alone, self._after) + lagging(likelihood, alone, self._after)
        words += following_doubts(likelihood, bool(shown), self._after)
        return words + drifting(likelihood, self._after)

    def told(
        self, findings: Findings, model: Model, extended_model: Model, tried: Sequence[Tried]
    ) -> Findings:
        """The findings with what the modes say.

        Args:
            findings: of the record, about the causes of both.
            model: as it was given.
            extended_model: with the causes.
            tried: explanations of the record.
        """
        likelihood = self._likelihood
        ends = self._nothing, self._after
        gap = findings.gap
        if self.by_modes and gap.held_out.gain <= 0:
            gap = mode_gap(model, likelihood, ends, *self._left_out)
        both = {**findings.gap.by_sensor, **by_sensor(model, likelihood, *ends)}
        gap = gap.model_copy(update={"by_sensor": both})
        causes = list(findings.causes)
        # Broken channels stand first.
        first = len(causes) - len(self.mixed.fit.hypotheses)
        for number in range(len(self.mixed.fit.hypotheses)):
            causes[first + number] = self._cause(causes[first + number], number)
        readings, record = likelihood.readings, self.record
        following = following_contexts(likelihood, self._after)
        warnings = warnings_of(model, readings)
        warnings += [one for one in following if one not in findings.unexplained.looks_like]
        warnings += apart_in_time(readings.time, record.origin + record.time)
        told = findings.model_copy(
            update={
                "gap": gap,
                "causes": causes,
                "explanations": self._explanations(tried),
                "modal_sha256": likelihood.readings.record.sha256,
                "windows": windows_of(likelihood),
                "unidentifiable": self._unseen(findings),
                "groups": [*findings.groups, *mode_groups(model, likelihood, *ends)],
                "warnings": [*findings.warnings, *warnings],
            }
        )
        told._account = findings._account
        told._modes = ModalArrays(
            model,
            extended_model,
            mode_readings(likelihood, *ends),
            likelihood.readings.time,
            likelihood.readings.weather,
        )
        return told

    def _unseen(self, findings: Findings) -> list[Unidentifiable]:
        """Kinds and places that neither the record nor the modes can show."""
        least = findings.criteria.explanations.smallest_d_prime
        shown = {
            (one.hypothesis.name, place_words(one.hypothesis.place.values()))
            for one in self.mixed.promising
            if one.largest >= least
        }
        return [one for one in findings.unidentifiable if (one.kind, one.place) not in shown]

    def _shows(self, number: int) -> bool:
        """Whether a cause that modes can show does show in them."""
        own = change(self._likelihood, self.mixed.fit.modal, number)
        return float(np.linalg.norm(own)) >= SHOWS

    def _in_record(self, number: int) -> bool:
        """Whether the record by itself shows a cause that modes show, and so no weather made it."""
        evidence, fit = self.mixed.evidence, self.mixed.fit
        own, _ = self._change(fit, evidence.on_modes(fit.hypotheses)[number])
        size = float(evidence.problem.covariance.product(own, own)[0, 0])
        return size >= evidence.problem.criteria.explanations.smallest_d_prime**2

    @cached_property
    def by_modes(self) -> bool:
        """Whether a cause shows in the modes."""
        return any(self._shows(number) for number in range(len(self.mixed.fit.modal.hypotheses)))

    @cached_property
    def _left_out(self) -> tuple[FloatArray, FloatArray]:
        """Squared deviations of modes that were left out, without causes and with them."""
        evidence, fit = self.mixed.evidence, self.mixed.fit
        before = squares(self._likelihood, self._nothing)
        after = before.copy()
        if len(before) > 1:
            for mode in range(len(before)):
                other = evidence.hiding(mode).beside(fit.alone).modal.prediction
                if other is not None:
                    after[mode] = squares(self._likelihood, other)[mode]
        return before, after

    def _cause(self, cause: Cause, number: int) -> Cause:
        evidence, fit = self.mixed.evidence, self.mixed.fit
        shown = evidence.on_modes(fit.hypotheses)
        size, apart = self._sizes(number)
        static = cause.d_prime
        parts = [cause.why] if static >= SHOWS else []
        separated, onset_within = cause.separated_by, cause.onset_ci90
        if number in shown:
            at = shown.index(number)
            words = moved_modes(self._likelihood, fit.modal, at)
            parts += [words] if words else []
            # When it began is known by the modes, of which the interval of the record says nothing.
            onset_within = None if self._shows(at) else onset_within
            if self._shows(at) and self.mixed.rivals[number]:
                nearest = self.mixed.rivals[number][0][0]
                against = effect_words(last_effect(nearest.static, self.record))
                words = separating(self._likelihood, fit.modal, nearest.modal)
                if not separated:
                    separated = f"against {against}: {words}"
        return cause.model_copy(
            update={
                "d_prime": size,
                "d_perp": apart,
                "why": "; ".join(parts),
                "separated_by": separated,
                "onset_ci90": onset_within,
            }
        )

    def _sizes(self, number: int) -> tuple[float, float]:
        """d' of a cause in both, and d' after projecting off its nearest rival."""
        own = self._change(self.mixed.fit, number)
        size = self._along(own, own)
        if not self.mixed.rivals[number]:
            return float(np.sqrt(size)), float(np.sqrt(size))
        rival, _ = self.mixed.rivals[number][0]
        other = self._change(rival, len(rival.hypotheses) - 1)
        rest = size - self._along(own, other) ** 2 / max(self._along(other, other), 1e-300)
        return float(np.sqrt(size)), float(np.sqrt(max(rest, 0.0)))

    def _change(self, fit: MixedFit, number: int) -> tuple[Reduced, FloatArray]:
        """What a cause changes of the record and of the modes, beside the others."""
        evidence = self.mixed.evidence
        others = [one for k, one in enumerate(fit.hypotheses) if k != number]
        z = np.delete(fit.z, fit.static.slices()[number])
        without = evidence.problem.data.predict(extended(evidence.base, others, z))
        of_record = evidence.problem.covariance.reduce((fit.static.simulated - without).T[None])
        shown = evidence.on_modes(fit.hypotheses)
        if number not in shown:
            return of_record, np.zeros_like(fit.modal.residual)
        return of_record, change(self._likelihood, fit.modal, shown.index(number))

    def _along(self, one: tuple[Reduced, FloatArray], other: tuple[Reduced, FloatArray]) -> float:
        covariance = self.mixed.evidence.problem.covariance
        return float(covariance.product(one[0], other[0])[0, 0]) + float(one[1] @ other[1])

    def _explanations(self, tried: Sequence[Tried]) -> list[Explanation]:
        """No effect at all, what is named, and what could stand in its place.

        Where nothing is named, what comes nearest by the record.
        """
        evidence, criteria = self.mixed.evidence, self.mixed.evidence.problem.criteria
        several = [(evidence.fit([], []), "what every other explanation is measured against")]
        if self.mixed.fit.hypotheses:
            several.append((self.mixed.fit, "what is named"))
        else:
            fits = [one.fit for one in tried if one.fit is not None and one.fit.hypotheses]
            several += [(evidence.beside(one), "tried") for one in fits]
        for ranked in self.mixed.rivals:
            for one, behind in ranked:
                whole = self.mixed.fit.log_evidence - one.log_evidence
                several.append((one, rival_words(behind, whole, criteria)))
        found = [self._explanation(*one) for one in several if np.isfinite(one[0].log_evidence)]
        return sorted(found, key=lambda one: -one.log_odds)

    def _explanation(self, fit: MixedFit, remark: str) -> Explanation:
        problem = self.mixed.evidence.problem
        effects = [content(one) for one in estimated_effects(fit.static, self.record)]
        off = (problem.data.readings - fit.static.simulated) / problem.noise.sigma
        return Explanation(
            words=explanation_words(effects),
            effects=effects,
            log_odds=round(fit.log_evidence, DECIMALS) + 0.0,
            gap=float((off[problem.data.observed] ** 2).mean()),
            remark=remark,
        )
