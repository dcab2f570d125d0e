"""The diagnosis of a past, of the rows of it that tell most."""

from collections.abc import Callable

import rga.diagnosis
from rga.arrays import IntArray
from rga.findings import Findings
from rga.findings.criteria import Criteria
from rga.model import Model
from rga.records import Record
from rga.twin.archive import Archive
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.changes import diagnose_change, in_doubt
from rga.twin.hardware.interface import HardwareInterface
from rga.twin.hardware.recorded import Recorded
from rga.twin.past.chosen_past import chosen_past, with_choice
from rga.twin.restore import chosen_record, times_and_contexts
from rga.twin.run_state import Standing


class PastDiagnosis:
    """Diagnoses the rows so far.

    Args:
        model: as it was given.
        hardware: where rows come from.
        archive: keeps them, and what happened.
        criteria: of the diagnosis.
        seed: of everything random.
        progress: called with a stage and the share of it that is done.
    """

    def __init__(
        self,
        model: Model,
        hardware: HardwareInterface,
        archive: Archive,
        criteria: Criteria,
        seed: int,
        progress: Callable[[str, float], None],
    ) -> None:
        self._model, self._hardware, self._archive = model, hardware, archive
        self._criteria, self._seed, self._progress = criteria, seed, progress

    def ask(self, standing: Standing, changed: bool, given: ContextEstimator | None) -> Findings:
        """What has changed since the calibration, if it has; else what was wrong all along.

        Args:
            standing: where the run stands.
            changed: whether something seems to have changed since.
            given: what the calibration learned about the model as it was given.

        Raises:
            InputError: the rows cannot be diagnosed.
        """
        rows, calibrated = standing.row, standing.calibrated
        model, criteria, past = self._model, self._criteria, self._past(rows)
        events, most = self._archive.run.events(), criteria.record.most_rows
        choice = chosen_past(
            model, past, events, calibrated, most, self._seed, standing.forgotten_rows
        )
        record = self._archive.used(self._chosen(past, choice.rows))
        words = [choice.words] * bool(choice.words) + self._unused(standing)
        if changed and given is not None and given.found is not None:
            assert given.correction is not None
            found = diagnose_change(
                model,
                record,
                given.found,
                given.correction,
                since=past.origin + float(past.time[calibrated - 1]),
                criteria=criteria,
                seed=self._seed,
                progress=self._progress,
            )
            if found is not None:
                return with_choice(found, words, rows)
        findings = rga.diagnosis.diagnose(
            model, record, criteria=criteria, seed=self._seed, progress=self._progress
        )
        findings = with_choice(findings, words, rows)
        return in_doubt(findings) if changed and not findings.causes else findings

    def _unused(self, standing: Standing) -> list[str]:
        """What somebody took out of use, in words."""
        label, origin = self._hardware.station.time_label, self._hardware.station.origin
        return [
            f"no reading of {sensor} is used from {label(since - origin)} "
            f"{'on' if until is None else f'to {label(until - origin)}'}, as was asked for"
            for sensor, since, until in standing.excluded
        ]

    def _past(self, rows: int) -> Record:
        """The rows so far; their readings may be left out."""
        if isinstance(self._hardware, Recorded):
            return self._hardware.record.rows(slice(0, rows))
        return times_and_contexts(self._archive.run, rows)

    def _chosen(self, past: Record, rows: IntArray) -> Record:
        """Chosen rows with their readings."""
        if isinstance(self._hardware, Recorded):
            return past if len(rows) == len(past) else past.rows(rows)
        return chosen_record(self._archive.run, rows)
