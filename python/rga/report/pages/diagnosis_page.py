"""What stands on the page, made ready for the template."""

import re
from typing import Any

import numpy as np

from rga.diagnosis.checks.leave_one_out import unseen_groups
from rga.diagnosis.member_forces import member_forces
from rga.diagnosis.member_stresses import member_stresses
from rga.drawing.figure_style import FONTS
from rga.findings import Findings
from rga.findings.arrays import DiagnosisArrays
from rga.findings.phrases import effect_words, kind_words, not_ruled_out, undecided
from rga.findings.schema import Cause
from rga.model import Model
from rga.model.effects.loads.axle_load import AxleLoad
from rga.model.effects.sensors.sensor_fault import is_fault
from rga.model.parameter import listed
from rga.quantities import DASH, duration, number, percent, short
from rga.report.figures.bridge import draw_bridge, draw_residuals
from rga.report.figures.channels import all_channels
from rga.report.figures.deviation import percent_off, runs
from rga.report.figures.explanations import draw_explanations, kept, ranked
from rga.report.figures.gain import draw_gain
from rga.report.figures.member_forces import draw_forces, force_table, restraint_words
from rga.report.figures.member_stresses import consequence, stress_table
from rga.report.figures.series import draw_series
from rga.report.figures.unexplained import unexplained
from rga.report.figures.unseen import draw_unseen
from rga.report.pages.cards import card, generic, moment, plain
from rga.report.pages.evidence import evidence
from rga.report.pages.fault_tolerant_parts import part
from rga.report.pages.modes_section import modes_section
from rga.report.text.actions import BY_VERDICT, NOT_RULED_OUT, actions

VERDICTS = {
    "nothing_wrong": "Nothing wrong found",
    "named": "Cause named",
    "ambiguous": "More than one cause fits",
    "partial": "Cause named, structure left",
    "unknown": "Cause not known",
    "unidentifiable": "These data cannot show it",
}
#: the words where structure is left beside causes that have rivals
OPEN = "More than one cause fits, structure left"
#: the words in place of those of `unknown`, where nothing speaks against the model
UNDECIDED = "These data cannot decide"
#: longer lists are folded
LONG_LIST = 12


def verdict_words(findings: Findings) -> str:
    """The verdict as a reader is told."""
    if undecided(findings):
        return UNDECIDED
    states = {one.status for one in findings.causes}
    if findings.verdict == "partial" and states == {"ambiguous"}:
        return OPEN
    return VERDICTS[findings.verdict]


def page(findings: Findings) -> dict[str, Any]:
    """The variables of the template."""
    account = findings.account
    model, record = account.model, account.record
    effects = [cause for cause in findings.causes if not is_fault(cause.effect)]
    series = part("The readings", draw_series, findings)
    # The first sentence is the headline; what follows is read below it, and the gain only once.
    headline, *rest = re.split(r"(?<=\.) (?=[A-Z])", findings.sentence())
    if not any("no step saw" in sentence for sentence in rest):
        rest.insert(0, gain(findings))
    return {
        "fonts": FONTS,
        "model_name": model.name,
        "about": [(what, said) for what, said in model.about.model_dump().items() if said],
        "verdict": verdict_words(findings),
        "verdict_key": findings.verdict,
        "headline": headline,
        "rest": " ".join(rest),
        "period": period(findings),
        "gain": gain(findings),
        "since": _since(findings.account),
        "warnings": list(dict.fromkeys([*findings.warnings, *record.warnings])),
        "next": NOT_RULED_OUT if not_ruled_out(findings) else BY_VERDICT[findings.verdict],
        "tasks": part("What to do first", tasks, findings),
        "cards": [
            {
                "said": card(
                    cause,
                    model,
                    effect_words(cause.effect),
                    [effect_words(rival) for rival in cause.rivals],
                ),
                "actions": part("What to do about it", calls_for, findings, cause),
                "evidence": part("The evidence", evidence, findings, cause),
            }
            for cause in effects
        ],
        "rival_log_odds": f"{findings.criteria.rivals.log_odds:g}",
        "rejected": rejected(findings),
        "bridge": part("The map of percentages", draw_bridge, findings) if len(record) else None,
        "residuals": part("The map of residuals", draw_residuals, findings)
        if len(record)
        else None,
        "modes": None if findings.modes is None else part("Modes", modes_section, findings.modes),
        "forces": part("The forces of the members", forces, findings),
        "groups": [
            (
                group.group,
                ", ".join(group.sensors),
                percent(group.before_percent),
                percent(group.after_percent),
            )
            for group in findings.groups
        ],
        "sensors": part("The table of the sensors", sensors, findings),
        "channels": part("Every channel", all_channels, findings) if len(record) else None,
        "series": series[0] if series else series,
        "over_time": bool(series and series[1]),
        "explanations": part("The table of explanations", explanations, findings),
        "explanations_figure": part("The figure of explanations", draw_explanations, findings),
        "unseen": part("The channels left out", unseen, findings)
        if findings.modes is None
        else None,
        "gain_figure": part("The figure of the gain", draw_gain, findings),
        "contexts": part("The table of contexts", contexts, findings),
        "share": percent(100 * findings.unexplained.share, sign=False),
        "looks_like": findings.unexplained.looks_like,
        "unexplained": part("The patterns that are left", unexplained, account),
        "unidentifiable": [
            (kind_words(one.kind), one.place, number(one.d_prime_at_largest))
            for one in sorted(findings.unidentifiable, key=lambda one: (one.kind, one.place))
        ],
        "fold": len(findings.unidentifiable) > LONG_LIST,
        "unused": sorted(record.unused.items()),
        "provenance": provenance(findings, model, record.zero),
    }


def period(findings: Findings) -> str:
    """Which time the record spans, its rows, and how many of them no step saw."""
    account = findings.account
    record = account.record
    if not len(record):
        return "a record without rows"
    first, last = (moment(record.time_label(float(record.time[row]))) for row in (0, -1))
    if len(record) == 1:
        return f"{first}, one row"
    length, unit = duration(float(record.time[-1] - record.time[0]))
    step, step_unit = duration(float(np.median(np.diff(record.time))))
    pieces = len(runs(account.held_out))
    of = f" of {account.recorded}" if account.recorded > len(record) else ""
    held = f"{int(account.held_out.sum())} of them held out in {pieces} block"
    return (
        f"{first} to {last} ({short(length)} {unit}), {len(record)}{of} rows every "
        f"{short(step)} {step_unit}, {held}{'s' if pieces != 1 else ''}"
    )


def gain(findings: Findings) -> str:
    """The gain by held-out readings in one line."""
    held = findings.gap.held_out
    low, high = held.gain_ci90
    went = "fell" if held.after <= held.before else "rose"
    said = "By readings that no step saw the gap "
    if not findings.causes:
        return (
            f"{said}is {number(held.before)}; noise alone gives {short(findings.gap.noise_floor)}."
        )
    return (
        f"{said}{went} from {number(held.before)} to {number(held.after)}; noise alone gives "
        f"{short(findings.gap.noise_floor)}. Gain {number(held.gain)}, 90\u00a0% interval "
        f"{number(low)} to {number(high)}."
    )


def rejected(findings: Findings) -> list[dict[str, str]]:
    """Channels that do not work, with the reason."""
    account = findings.account
    faults = {
        str(cause.effect.get("sensor")): cause
        for cause in findings.causes
        if is_fault(cause.effect)
    }
    names = [n for n, out in zip(account.record.sensors, account.rejected, strict=True) if out]
    found = []
    for name in dict.fromkeys([*faults, *names]):
        cause = faults.get(name)
        since = "" if cause is None or cause.onset is None else f" from {moment(cause.onset)}"
        found.append(
            {
                "sensor": name,
                "mode": str(cause.effect.get("mode", "faulty")) + since if cause else "rejected",
                "why": cause.why if cause else "",
            }
        )
    return found


def tasks(findings: Findings) -> list[tuple[str, str, str]]:
    """The first thing that every cause calls for: its kind, what sort of action, in words."""
    return [
        (kind_words(str(cause.effect.get("kind"))), *calls_for(findings, cause)[0])
        for cause in findings.causes
    ]


def calls_for(findings: Findings, cause: Cause) -> list[tuple[str, str]]:
    """What a cause calls for on the structure at hand: what sort of action, in words."""
    effects = findings.account.model.effects.values()
    return actions(cause.effect, crossed=any(isinstance(one, AxleLoad) for one in effects))


def forces(findings: Findings) -> dict[str, Any] | None:
    """What the causes mean for the members; None where no cause changes a force."""
    account = findings.account
    found = member_forces(account)
    if found is None:
        return None
    named = _members_of(findings)
    table = force_table(found, account.model, named)
    if not table.lines:
        return None
    record = account.record
    names = [line[0] for line in table.lines]
    stresses = member_stresses(account, names, found.row)
    return {
        "table": table,
        "stresses": None if stresses is None else stress_table(stresses),
        "consequence": "" if stresses is None else consequence(stresses),
        "row": moment(record.time_label(float(record.time[found.row]))),
        "restraint": restraint_words(found, [str(c.effect["kind"]) for c in findings.causes]),
        "figure": draw_forces(found, account.model),
    }


def _members_of(findings: Findings) -> set[str]:
    """Members that causes name, by themselves or by their groups."""
    account = findings.account
    found: set[str] = set()
    for name, effect in account.extended.effects.items():
        if name not in account.model.effects:
            found.update(listed(effect.place.get("member")))
            for group in listed(effect.place.get("group")):
                found.update(account.model.groups.get(group, []))
    return found


def unseen(findings: Findings) -> dict[str, Any] | None:
    """Groups of channels that were left out and predicted; None where there are none."""
    account = findings.account
    groups = unseen_groups(account.found) if account.found is not None else []
    figure = draw_unseen(groups, account.model)
    if figure is None:
        return None
    lines = [
        (one.group, len(one.channels), number(one.gap_without), number(one.gap_with))
        for one in groups
    ]
    return {"figure": figure, "lines": lines}


def explanations(findings: Findings) -> list[dict[str, Any]]:
    """The explanations that were tried, the likeliest first."""
    best = kept(findings)
    return [
        {
            "words": one.words or "no effect at all",
            "log_odds": number(one.log_odds),
            "gap": number(one.gap),
            "unseen": DASH if one.gap_unseen_channels is None else number(one.gap_unseen_channels),
            "remark": one.remark,
            "best": one is best,
        }
        for one in ranked(findings.explanations)
    ]


def _since(account: DiagnosisArrays) -> str | None:
    """The time of the first row in which a cause acts, where all causes begin late."""
    if not account.since:
        return None
    label = account.record.time_label(float(account.record.time[account.since]))
    return label if isinstance(label, str) else f"{label:g} s"


def sensors(findings: Findings) -> list[dict[str, str]]:
    """Every channel: percent off and gap, before and after."""
    account = findings.account
    off = [percent_off(account, simulated) for simulated in (account.before, account.after)]
    found = []
    for column, name in enumerate(account.record.sensors):
        gap = findings.gap.by_sensor.get(name)
        sensor = account.model.sensors.get(name)
        place = "" if sensor is None else sensor.member or f"node {sensor.node}"
        found.append(
            {
                "name": name,
                "what": "" if sensor is None else sensor.kind,
                "place": place,
                "off_before": percent(float(off[0][column])),
                "off_after": percent(float(off[1][column])),
                "before": number(gap.before) if gap else DASH,
                "after": number(gap.after) if gap else DASH,
                "note": "rejected" if account.rejected[column] else "",
            }
        )
    return found


def contexts(findings: Findings) -> list[tuple[str, str, list[tuple[str, str]]]]:
    """Context, its unit, and what was inferred of it."""
    known = findings.account.model.context
    found = []
    for name, inferred in findings.contexts.items():
        unit = known[name].unit if name in known else ""
        shown = f" [{unit}]" if unit and "unit" not in inferred else ""
        items = [(plain(str(key)), generic(value)) for key, value in inferred.items()]
        found.append((name, shown, items))
    return found


def provenance(
    findings: Findings, model: Model, zero: tuple[float, float] | None = None
) -> list[tuple[str, str]]:
    """What made this report, of a model, and over which times channels were set to zero [s]."""
    found = [("seed", str(findings.seed))]
    if model.path is not None:
        found.append(("model file", model.path.name))
    found.append(("model SHA-256", findings.model_sha256 or DASH))
    found.append(("record SHA-256", findings.record_sha256 or DASH))
    if findings.modal_sha256 is not None:
        found.append(("modes SHA-256", findings.modal_sha256 or DASH))
    if zero is not None:
        first, last = zero
        found.append(("channels zeroed over", f"{number(first)} to {number(last)} s of the record"))
    differing = findings.criteria.differing().items()
    found += [(f"criterion {name}", f"{value:g}") for name, value in differing]
    found += [(f"{name} version", version) for name, version in sorted(findings.versions.items())]
    return found
