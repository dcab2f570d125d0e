"""Causes: what diagnoses propose, why, and what would tell it from its rivals."""

from dataclasses import dataclass
from datetime import datetime
from typing import Any

from rga.dashboard.pages.heading import heading
from rga.dashboard.surroundings import SeenTwin
from rga.dashboard.svg.gap_level import GapLevel, gap_level
from rga.dashboard.svg.structure import Elevation, elevations
from rga.findings import Findings
from rga.findings.phrases import effect_words
from rga.model.schema import Model
from rga.operation.reading.twin_now import moment
from rga.quantities import number
from rga.report.drawing.places import named_parts
from rga.report.pages.cards import Card, card
from rga.report.text.actions import actions
from rga.twin.repository import Proposal, RunView

#: decisions of people, and the word for what became of a proposal
DECIDED = {"accept": "accepted", "reject": "rejected"}


@dataclass(frozen=True)
class Decision:
    """What somebody decided about a proposal: accepted or rejected, by whom, why and when."""

    word: str
    who: str
    why: str
    time: datetime


@dataclass(frozen=True)
class ProposedCause:
    """A cause of a proposal: what is known of it, and what it calls for."""

    card: Card
    actions: list[tuple[str, str]]


@dataclass(frozen=True)
class GainOfSensor:
    """The gap of a sensor without and with what is proposed; the drawing shows it without."""

    name: str
    before: str
    after: str
    level: GapLevel
    level_after: GapLevel

    @property
    def words(self) -> str:
        """All this in a line."""
        return f"{self.name}: gap {self.before} without, {self.after} with what is proposed"


@dataclass(frozen=True)
class Proposed:
    """A proposal.

    Attributes:
        number: of it.
        words: what the model would have then.
        time: of the last row that the diagnosis looked at.
        decision: None: it waits for one.
        superseded: a later proposal stands in its place.
        sentence: the verdict of the diagnosis.
        gain: on rows that no step of the diagnosis saw, in words.
        causes: of the proposal, in detail.
        sensors: those that gain most first; sensor_of: the same by number in the model.
        drawings: of the structure, with what the causes name marked.
        warnings: of the diagnosis.
    """

    number: int
    words: str
    time: datetime
    decision: Decision | None
    superseded: bool
    sentence: str
    gain: str
    causes: list[ProposedCause]
    sensors: list[GainOfSensor]
    sensor_of: dict[int, GainOfSensor]
    drawings: list[Elevation]
    warnings: list[str]


@dataclass(frozen=True)
class WithoutCause:
    """Diagnoses that ended in "unknown": how many, when the last did, and what it said."""

    count: int
    time: datetime
    sentence: str


def causes_page(seen: SeenTwin) -> dict[str, Any]:
    """What the page of causes shows.

    Raises:
        InputError: the repository of the twin cannot be read.
    """
    now, view, twin = seen.reading.now(), seen.reading.view(), seen.reading.twin
    found: dict[str, Any] = {
        "heading": heading(seen, now),
        "tab": "/causes",
        "version": 0,
        "unexplained": None,
        "proposals": [],
    }
    if now is None or view is None or twin is None:
        return found
    start = twin.station.start
    proposals = view.proposals()
    return found | {
        "version": now.version,
        "unexplained": _unexplained(view, start),
        "proposals": [
            _proposed(one, one is proposals[-1], view, twin.given, start)
            for one in reversed(proposals)
        ],
    }


def findings_of(view: RunView, number: int) -> str:
    """Findings behind a proposal, as JSON text.

    Raises:
        KeyError: there is no such proposal, or nothing is left of its findings.
    """
    proposal = next((one for one in view.proposals() if one.number == number), None)
    text = None if proposal is None else _stored(view, proposal)
    if text is None:
        raise KeyError(number)
    return text


def _unexplained(view: RunView, start: str | float) -> WithoutCause | None:
    """What came of diagnoses that named nothing they know; None: none ended so."""
    ended = [(one.row, Findings.model_validate_json(one.findings)) for one in view.findings()]
    unknown = [(row, found) for row, found in ended if found.verdict == "unknown"]
    if not unknown:
        return None
    row, last = unknown[-1]
    time = view.measured_at([row]).time
    return WithoutCause(
        len(unknown), moment(start, float(time[0]) if len(time) else 0.0), last.sentence()
    )


def _stored(view: RunView, proposal: Proposal) -> str | None:
    """Of the diagnoses at its row the last: a diagnosis proposes in the step that ends it."""
    found = [one.findings for one in view.findings() if one.row == proposal.row]
    return found[-1] if found else None


def _proposed(
    one: Proposal, is_last: bool, view: RunView, model: Model, start: str | float
) -> Proposed:
    time = view.measured(one.row, one.row + 1).time
    text = _stored(view, one)
    findings = None if text is None else Findings.model_validate_json(text)
    marked = named_parts(one.effects.values(), model)
    sensors = [] if findings is None else _gains(findings)
    numbers = {name: number for number, name in enumerate(model.sensors)}
    return Proposed(
        number=one.number,
        words=one.words,
        time=moment(start, float(time[0]) if len(time) else 0.0),
        decision=_decision(view, one),
        superseded=not is_last,
        sentence="" if findings is None else findings.sentence(),
        gain=_gain_words(one, findings),
        causes=[] if findings is None else _causes(findings, model),
        sensors=sensors,
        sensor_of={numbers[one.name]: one for one in sensors},
        drawings=elevations(model, marked, {name.name: 1.0 for name in sensors}),
        warnings=[] if findings is None else findings.warnings,
    )


def _decision(view: RunView, proposal: Proposal) -> Decision | None:
    for one in view.commands():
        if one.kind in DECIDED and one.body == {"proposal": proposal.number}:
            given = datetime.fromisoformat(one.given_at)
            return Decision(DECIDED[one.kind], one.who, one.why, given)
    return None


def _gain_words(proposal: Proposal, findings: Findings | None) -> str:
    if findings is None:
        return "" if proposal.gain is None else number(proposal.gain)
    held = findings.gap.held_out
    low, high = held.gain_ci90
    return (
        f"On rows that no step of the diagnosis saw, the gap goes from {number(held.before)} to "
        f"{number(held.after)} times the noise: a gain of {number(held.gain)}, 90 % interval "
        f"{number(low)} to {number(high)}."
    )


def _causes(findings: Findings, model: Model) -> list[ProposedCause]:
    found = []
    for cause in findings.causes:
        rivals = [effect_words(rival) for rival in cause.rivals]
        words = effect_words(cause.effect)
        found.append(ProposedCause(card(cause, model, words, rivals), actions(cause.effect)))
    return found


def _gains(findings: Findings) -> list[GainOfSensor]:
    """Sensors, those that gain most first."""
    by_gain = sorted(findings.gap.by_sensor.items(), key=lambda one: one[1].after - one[1].before)
    return [
        GainOfSensor(
            name,
            number(one.before, 2),
            number(one.after, 2),
            gap_level(one.before),
            gap_level(one.after),
        )
        for name, one in by_gain
    ]
