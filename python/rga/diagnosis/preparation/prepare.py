"""From a record to the data that a diagnosis works on: rows, channels, contexts."""

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace
from math import prod

import numpy as np

from rga.arrays import BoolArray, FloatArray
from rga.diagnosis.data.observations import Data, first_belief
from rga.diagnosis.data.tare import Tare
from rga.diagnosis.preparation.bad_contexts import (
    denied_rows,
    without_impossible,
    without_limits,
)
from rga.diagnosis.preparation.context_search import guess_lines, guess_rows
from rga.diagnosis.preparation.context_steps import shown_by_steps
from rga.diagnosis.preparation.logger_faults import ended_channels, without_repeated, without_silent
from rga.diagnosis.preparation.missing_codes import missing_codes
from rga.diagnosis.preparation.sensor_faults.beside_other_channels import (
    broken_channels,
    lone_spikes,
)
from rga.diagnosis.preparation.sensor_faults.own_readings import (
    BrokenChannel,
    lost_zeros,
    stuck_channels,
)
from rga.diagnosis.preparation.suspicious import suspicious_contexts, suspicious_units
from rga.diagnosis.preparation.zeros.undeclared_zeros import with_own_zeros
from rga.diagnosis.search.hypothesis import Hypothesis, hypotheses
from rga.diagnosis.search.linearised import load_basis
from rga.diagnosis.search.signatures import signatures
from rga.errors import InputError
from rga.findings.criteria import Criteria
from rga.model.schema import Model
from rga.quantities import counted
from rga.records import Record
from rga.records.zero import zeros_of
from rga.simulation import Simulator

#: numbers in the signatures of all candidates, which are held together [4 bytes each]
MOST_VALUES = 400_000_000
#: times that broken channels are looked for: the worst may hide others
GOES = 3
#: share of a signature that courses of the loads must leave, to be no sum of them
BEYOND = 1e-4
#: places of a kind that show only such sums, before the kind is taken as linear
LINEAR = 4


@dataclass(frozen=True)
class PreparedRecord:
    """A record made ready.

    Attributes:
        data: of all rows that are analysed.
        record: the same rows of the record, its working and its rejected channels.
        chosen: bool[rows of the record], the rows that are analysed.
        faults: channels that do not work; the data leave them out.
        warnings: in words.
        doubts: why the record cannot be called explained, whatever is found, in words.
        apart: channels that work, and that no cause is looked for in; the data leave them out.
    """

    data: Data
    record: Record
    chosen: BoolArray
    faults: list[BrokenChannel]
    warnings: list[str]
    doubts: list[str] = field(default_factory=list)
    apart: tuple[str, ...] = ()

    def leaving_out(self, sensor: str, simulator: Simulator) -> "PreparedRecord":
        """The same without a further channel that works."""
        kept = [k for k, name in enumerate(self.data.sensors) if name != sensor]
        data = _with_contexts_anew(simulator, _of_channels(self.data, kept))
        return replace(self, data=data, apart=(*self.apart, sensor))


def prepare(
    model: Model,
    record: Record,
    progress: Callable[[float], None],
    criteria: Criteria | None = None,
) -> PreparedRecord:
    """Choose rows, reject channels that do not work, and guess the latent contexts.

    Args:
        model: as it was given.
        record: as it was measured.
        progress: called with the share that is done.
        criteria: what decides a verdict; None: the default ones.

    Raises:
        InputError: too few rows, or no channel that works.
    """
    criteria = criteria or Criteria()
    criteria.record.check_length(len(record))
    record, limits = without_limits(record, criteria.record)
    record, impossible = without_impossible(model, record, criteria.record)
    record, silent = without_silent(record, criteria.record)
    ended = ended_channels(record, criteria.record)
    record, repeated = without_repeated(record, criteria.record)
    faults_of_rows = {**impossible, **ended, **repeated}
    serious = [w for w, share in faults_of_rows.items() if share >= criteria.record.faulty_share]
    serious += [w for w, share in silent.items() if share >= criteria.record.silent_share]
    as_measured = record
    simulator = Simulator(model.without_zeros())
    given = data_of(model, record, criteria)
    zeros = with_own_zeros(model, simulator, record, given)
    record = zeros.record
    data = _that_read(data_of(model, record, criteria))
    faults = stuck_channels(data.sensors, data.readings, data.observed, criteria.channels)
    found = {fault.sensor: fault for fault in faults}
    data = _without(data, faults)
    data = guess_lines(simulator, data, progress)
    if data.belief.passing:
        loaded = _acting(simulator.load_coefficients(data.belief.table))
        lost = lost_zeros(data.sensors, data.readings, data.observed, loaded, criteria.channels)
        found |= {fault.sensor: fault for fault in lost}
        data = _without(data, lost)
    most, few = _most_rows(simulator, data, record)
    chosen = _loaded_rows(simulator, data, most)
    if few is not None and chosen.sum() < len(chosen):
        limits = [*limits, few]
    data = guess_rows(simulator, data.rows(chosen))
    simulated = data.predict(simulator)
    suspicious = [
        *suspicious_units(model, data, simulated),
        *suspicious_contexts(model, data, record),
        *missing_codes(as_measured.channels(data.sensors), simulated),
    ]
    for _ in range(GOES):
        broken = _broken(simulator, data, record)
        if not broken:
            break
        found |= {fault.sensor: fault for fault in broken}
        data = _without_faults(simulator, data, broken)
    if not data.sensors:
        fault = next(iter(found.values()))
        raise InputError(
            "none of the channels works",
            f"record; of {fault.sensor!r}, {fault.why}",
            "check the record and the mapping",
        )
    basis = load_basis(simulator, data)
    spikes = lone_spikes(data.readings, data.observed, basis, criteria.channels)
    slight = [words for words in {**silent, **faults_of_rows} if words not in serious]
    warnings = [*record.warnings, *limits, *slight, *zeros.warnings, *suspicious]
    if chosen.sum() < criteria.record.few_rows:
        warnings.append(
            f"only {counted(int(chosen.sum()), 'row')}: noise and intervals are rough estimates"
        )
    if passing := data.belief.passing:
        warnings.append(
            f"onsets were not looked for: {', '.join(passing)} passes once, and what depends on it "
            "cannot be told from what begins on the way"
        )
    empty = int((~data.observed.any(1)).sum())
    if empty:
        warnings.append(f"{empty} rows without a context or without any reading were left aside")
    denied = denied_rows(spikes, data.observed, criteria.record)
    if denied.any():
        warnings.append(
            f"{int(denied.sum())} rows in which many channels jump at once were left aside: their "
            "contexts are not what acted, or something acted that no context says"
        )
        data = replace(data, observed=data.observed & ~denied[:, None])
        spikes &= ~denied[:, None]
    if spikes.any():
        of = ", ".join(np.array(data.sensors)[spikes.any(0)])
        warnings.append(_spike_words(int(spikes.sum()), of))
        data = replace(data, observed=data.observed & ~spikes)
    return PreparedRecord(
        data,
        record.rows(chosen),
        chosen,
        list(found.values()),
        warnings,
        [*serious, *zeros.doubts],
    )


def _broken(simulator: Simulator, data: Data, record: Record) -> list[BrokenChannel]:
    """Channels that do not work, of those that are left."""
    if not data.sensors:
        return []
    basis = load_basis(simulator, data)

    def effects() -> list[FloatArray]:
        candidates = hypotheses(simulator.model, data.sensors, set(record.contexts))
        structural = [one for one in candidates if not one.kind.on_sensors]
        return _beyond_loads(data, simulator, structural, basis)

    simulated = data.predict(simulator)

    def rounding() -> FloatArray:
        return shown_by_steps(simulator, data, record, simulated)

    return broken_channels(
        simulator.model,
        data.sensors,
        data.readings,
        data.observed,
        simulated,
        basis,
        effects,
        rounding,
        not data.belief.passing,
        data.criteria.channels,
    )


def _beyond_loads(
    data: Data, simulator: Simulator, candidates: Sequence[Hypothesis], basis: FloatArray
) -> list[FloatArray]:
    """The part of signatures that is no sum of courses of the loads, float[rows, sensors] each.

    Kinds that show none at the first places that show anything are linear, and show none at others.
    """
    courses, _ = np.linalg.qr(np.column_stack([np.ones(len(basis)), basis]))
    by_kind: dict[str, list[Hypothesis]] = {}
    for one in candidates:
        by_kind.setdefault(one.name, []).append(one)
    found = []
    for several in by_kind.values():
        linear = 0
        for sign in signatures(data, data.about(simulator), several):
            change = np.zeros((len(basis), len(data.sensors)))
            change[:, slice(None) if sign.channels is None else sign.channels] = sign.values.T
            rest = change - courses @ (courses.T @ change)
            if (rest**2).sum() > BEYOND * (change**2).sum():
                linear = -len(candidates)
                found.append(np.where(data.observed, rest, 0.0))
            else:
                linear += bool(change.any())
            if linear >= LINEAR:
                break
    return found


def _spike_words(count: int, of: str) -> str:
    if count == 1:
        return f"a lone spike of {of} was taken as a missing reading"
    return f"{count} lone spikes of {of} were taken as missing readings"


def data_of(model: Model, record: Record, criteria: Criteria) -> Data:
    """All rows of a record as observations, before anything of it is judged.

    Raises:
        InputError: a channel was zeroed outside the times of the record.
    """
    order = {name: number for number, name in enumerate(model.sensors)}
    belief = first_belief(model, record.origin + record.time, record.contexts)
    # A row whose context is missing cannot be simulated: its readings are left aside.
    known = [np.isfinite(record.contexts[n]) for n in belief.spread if n in record.contexts]
    complete = np.all(known, axis=0) if known else np.ones(len(record.time), dtype=bool)
    columns = np.array([order[name] for name in record.sensors], dtype=np.int64)
    return Data(
        sensors=tuple(record.sensors),
        columns=columns,
        readings=np.nan_to_num(record.readings),
        observed=np.isfinite(record.readings) & complete[:, None],
        belief=belief,
        tare=Tare.of(record, belief.table, columns, zeros_of(model, record)),
        criteria=criteria,
    )


def _without_faults(simulator: Simulator, data: Data, faults: list[BrokenChannel]) -> Data:
    """The data without faults, and their latent contexts without them."""
    return _with_contexts_anew(simulator, _without(data, faults))


def _with_contexts_anew(simulator: Simulator, data: Data) -> Data:
    """The latent contexts by the channels that are left: one that is off spoils them."""
    return guess_rows(simulator, data) if data.belief.latent and data.sensors else data


def _without(data: Data, faults: list[BrokenChannel]) -> Data:
    """The data without channels that never work, and without the readings behind their fault."""
    begun = {fault.sensor: fault.row for fault in faults}
    observed = data.observed.copy()
    for number, name in enumerate(data.sensors):
        row = begun.get(name)
        if row is not None:
            observed[row:, number] = False
    kept = [k for k, name in enumerate(data.sensors) if begun.get(name, 0) is not None]
    return _of_channels(replace(data, observed=observed), kept)


def _that_read(data: Data) -> Data:
    """The data without channels that have no reading.

    Raises:
        InputError: none has one.
    """
    kept = np.flatnonzero(data.observed.any(axis=0))
    if not len(kept):
        raise InputError(
            "no channel has a reading in a row whose contexts are known",
            "record",
            "check the record and the mapping",
        )
    return _of_channels(data, kept.tolist())


def _of_channels(data: Data, kept: list[int]) -> Data:
    return replace(
        data,
        sensors=tuple(data.sensors[number] for number in kept),
        columns=data.columns[kept],
        readings=data.readings[:, kept],
        observed=data.observed[:, kept],
    )


def _most_rows(simulator: Simulator, data: Data, record: Record) -> tuple[int, str | None]:
    """Rows that are analysed at most; why they are fewer than the criterion allows, in words."""
    allowed = data.criteria.record
    candidates = hypotheses(simulator.model, data.sensors, set(record.contexts))
    # One on sensors shows on two at most, another may show on all.
    a_row = sum(
        (2 if one.kind.on_sensors else len(data.sensors))
        * prod(len(prior.trials) for prior in one.priors.values())
        for one in candidates
    )
    most = max(allowed.few_rows, MOST_VALUES // max(1, a_row))
    if most >= allowed.most_rows:
        return allowed.most_rows, None
    return most, (
        f"of {len(data.time)} rows at most {most}, evenly chosen, were analysed: "
        f"{len(data.sensors)} channels and {len(candidates)} possible causes leave no room for more"
    )


def _loaded_rows(simulator: Simulator, data: Data, most: int) -> BoolArray:
    """Rows that are analysed: without long unloaded ends, thinned evenly to at most so many."""
    rows = len(data.time)
    first, last = 0, rows - 1
    if data.belief.lines:
        # Rows before and after a crossing say nothing of the structure; a little of them is kept.
        acting = np.flatnonzero(_acting(simulator.load_coefficients(data.belief.table)))
        if len(acting):
            margin = max(2, len(acting) // 25)
            first, last = max(0, acting[0] - margin), min(rows - 1, acting[-1] + margin)
    step = -(-(last - first + 1) // most)
    chosen = np.zeros(rows, dtype=bool)
    chosen[first : last + 1 : step] = True
    return chosen


def _acting(coefficients: FloatArray) -> BoolArray:
    return np.asarray((np.abs(coefficients) > 0).any(1))
