"""The evidence for one cause: how sure its values are, how its rival fits, what would change it."""

from dataclasses import dataclass
from typing import Any

from markupsafe import Markup

from rga.diagnosis.assemble.effects import last_effect
from rga.diagnosis.checks.detectability import Least, least_seen
from rga.diagnosis.checks.leave_one_out import Contrast, Hold, contrast, hold
from rga.diagnosis.checks.profiles import onset_profile, profiles
from rga.diagnosis.search.stepwise import Found
from rga.findings.arrays import DiagnosisArrays
from rga.findings.criteria import Criteria
from rga.findings.phrases import effect_words
from rga.findings.schema import Cause, Findings
from rga.model.effect import Effect
from rga.model.schema import Model
from rga.quantities import number, percent, quantity
from rga.report.figures.contrast import draw_contrast
from rga.report.figures.profiles import draw_profiles
from rga.report.figures.series import runs_on
from rga.report.pages.cards import moment, own_unit, plain
from rga.report.pages.fault_tolerant_parts import Lost, part

#: times its noise by which a channel plainly tells two explanations apart
PLAIN = 3.0


def evidence(findings: Findings, cause: Cause) -> dict[str, Any] | None:
    """Variables of the template for one cause; None where nothing was searched."""
    account = findings.account
    found = account.found
    if found is None:
        return None
    # Faults of channels were reported before what the search found.
    place = findings.causes.index(cause)
    place -= len(findings.causes) - len(found.fit.hypotheses)
    if findings.modes is not None:
        return {
            "profiles": None,
            "onset": False,
            "rivalry": None,
            "caveats": _leads(found, place, cause),
        }
    rivalry = part("The rival's fit", _rivalry, account, found, place)
    return {
        "profiles": part("The profiles", _profiles, account, found, place, cause),
        "onset": cause.onset is not None,
        "rivalry": rivalry,
        "caveats": caveats(found, place, cause, account.model, rivalry.lead if rivalry else ""),
    }


def _leads(found: Found, place: int, cause: Cause) -> list[str]:
    """What would change the verdict of a record with modes: no channel decides it alone."""
    words = [_alone(found, cause)]
    apart = found.problem.criteria.rivals.log_odds
    if found.alternatives[place]:
        behind = number(found.alternatives[place][0].behind)
        words.append(
            f"It leads by {behind} log-odds over its nearest rival; below {apart:g} the two cannot "
            "be separated."
        )
    if cause.separated_by:
        words.append(f"To separate it from its rivals: {cause.separated_by}.")
    return words


@dataclass(frozen=True)
class Rivalry:
    """A cause against its nearest rival.

    Attributes:
        rival: in words.
        lead: of the cause over it, in words.
        figure: of the channels on which they differ most.
    """

    rival: str
    lead: str
    figure: Markup


def _profiles(account: DiagnosisArrays, found: Found, place: int, cause: Cause) -> Markup:
    shown = profiles(found, place)
    units = [own_unit(one.unit, cause.effect, account.model) for one in shown]
    record = account.record
    onset = onset_profile(found, place, record.origin + float(record.time[0]))
    likeliest = "" if cause.onset is None else moment(cause.onset)
    return draw_profiles(shown, units, onset, likeliest, f"profiles-{place}")


def _rivalry(account: DiagnosisArrays, found: Found, place: int) -> Rivalry | None:
    """The cause against its nearest rival; None where it has none."""
    against = contrast(found, place)
    if against is None:
        return None
    rival = effect_words(last_effect(against.against, account.record))
    apart = found.problem.criteria.rivals.log_odds
    lead = (
        f"It leads by {number(against.lead)} log-odds over its nearest rival, {rival}; below "
        f"{apart:g} the two cannot be separated. {_difference(against)} times its noise (root mean "
        "square)."
    )
    figure = draw_contrast(against, account.model, runs_on(account), f"contrast-{place}")
    return Rivalry(rival, lead, figure)


def _difference(against: Contrast) -> str:
    """How far a cause and its rival part, up to the number: much or little."""
    most = number(float(against.size[0]), 2)
    if against.size[0] < PLAIN:
        return f"On no channel do they differ by more than {most}"
    return f"They differ most on {against.channels[0]}, by {most}"


def caveats(found: Found, place: int, cause: Cause, model: Model, lead: str) -> list[str]:
    """What would change the verdict, in words and numbers.

    Args:
        found, place: the end of a search, and the number of the cause in it.
        cause: as it is reported.
        model: as it was given.
        lead: of the cause over its nearest rival, in words; empty where it has none.
    """
    criteria = found.problem.criteria
    words = [_alone(found, cause)]
    if lead:
        words.append(lead)
    hangs = part("What its lead hangs on", hold, found, place)
    least = part("The smallest effect that would have been named", least_seen, found, place)
    if hangs is not None:
        words.append(hangs.words if isinstance(hangs, Lost) else _hold_words(hangs, criteria))
    if least is not None:
        words.append(least.words if isinstance(least, Lost) else _least_words(least, cause, model))
    if cause.separated_by:
        words.append(f"To separate it from its rivals: {cause.separated_by}.")
    return words


def _alone(found: Found, cause: Cause) -> str:
    least = found.problem.criteria.naming.log_odds
    return (
        f"It leads by {number(cause.log_odds)} log-odds over leaving it out; below {least:g} it "
        "would not be named."
    )


def _hold_words(one: Hold, criteria: Criteria) -> str:
    over = "leaving it out" if one.alone else "its nearest rival"
    least = criteria.naming.log_odds if one.alone else criteria.rivals.log_odds
    then = (
        "the verdict does not hang on any one channel"
        if one.left >= least
        else "the verdict hangs on this channel: check it first"
    )
    return (
        f"Its lead hangs most on channel {one.channel}: without it {number(one.left)} log-odds "
        f"over {over} would be left; {then}."
    )


def _least_words(one: Least, cause: Cause, model: Model) -> str:
    share = percent(100 * one.share, sign=False)
    if one.value is None:
        return f"An effect of less than {share} of its size would not have been named."
    name = next(key for key, value in cause.effect.items() if isinstance(value, dict))
    unit = Effect.vocabulary[cause.effect["kind"]].unit(name, cause.effect)
    shown = quantity(one.value, own_unit(unit, cause.effect, model))
    return (
        f"At {_one(plain(name))} of {shown} its effect would be {share} as large, and would "
        "not have been named."
    )


def _one(words: str) -> str:
    """Words behind their article.

    >>> _one("offset"), _one("factor")
    ('an offset', 'a factor')
    """
    return f"{'an' if words[0] in 'aeiou' else 'a'} {words}"
