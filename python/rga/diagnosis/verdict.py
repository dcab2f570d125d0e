"""The verdict, and in words what speaks against calling a record explained."""

from collections.abc import Sequence

import numpy as np

from rga.diagnosis.data.held_out import Gain
from rga.diagnosis.preparation.sensor_faults.own_readings import BrokenChannel
from rga.diagnosis.residuals.lack_of_fit import Misfit
from rga.diagnosis.search.hypothesis import Hypothesis
from rga.diagnosis.search.stepwise import Found
from rga.findings.phrases import place_words
from rga.findings.schema import Verdict

#: misfits that are reported in words: a sentence of more is not read; all stand in the findings
MOST_MISFITS = 5
#: rows within which causes begin together: of a jump the onset is known to a few
TOGETHER = 10


def verdict(found: Found, faults: bool, structure: bool) -> Verdict:
    """The verdict; `partial` goes before `ambiguous` before `named`."""
    causes = bool(found.fit.hypotheses)
    if not causes and not faults:
        return "unknown" if structure else "nothing_wrong"
    if structure:
        return "partial" if causes or faults else "unknown"
    apart = found.problem.criteria.rivals.log_odds
    rivals = any(one.behind < apart for ranked in found.alternatives for one in ranked)
    return "ambiguous" if rivals else "named"


def reasons_for_doubt(
    channels: Sequence[str],
    faults: Sequence[BrokenChannel],
    found: Found,
    dropped: Sequence[Hypothesis],
    off: Sequence[Misfit],
    gained: Gain,
    unseen: tuple[float, float] | None,
    by_modes: bool = False,
) -> list[str]:
    """In words: why neither the model nor the causes account for the record.

    Args:
        channels: of the record.
        faults: channels that do not work.
        found: the end of the search.
        dropped: causes that only the readings fitted spoke for.
        off: channels and groups that do not fit.
        gained: gap of the held-out rows.
        unseen: gap of channels left out that speak against the causes of the structure, without
            these and with them.
        by_modes: modes name a cause, which the record need not show.
    """
    fallen = [
        f"{place_words([one.kind.title, *one.place.values()])}"
        f"{', from another row on as well,' if _named(one, found) else ''} would explain the "
        "readings fitted, and rows and channels left out do not confirm it"
        for one in dropped
    ]
    # A kind with two parameters, or from another row on, is reported once.
    reasons = list(dict.fromkeys(fallen))
    reasons += [one.words for one in off[:MOST_MISFITS]]
    if len(off) > MOST_MISFITS:
        reasons.append(f"{len(off) - MOST_MISFITS} more channels or groups are off")
    broken = {fault.sensor for fault in faults}
    criteria = found.problem.criteria.fit
    if len(broken) >= criteria.broken_share * len(channels):
        reasons.append(f"{len(broken)} of {len(channels)} channels do not work")
    least = gained.before * (criteria.unseen_rise if by_modes else 1.0)
    if found.fit.hypotheses and gained.after >= least:
        reasons.append(
            "rows that no step saw come no closer by the causes: their gap is "
            f"{gained.before:.3g} times the noise without and {gained.after:.3g} with them"
        )
    if unseen is not None and unseen[1] > criteria.unseen_rise * unseen[0]:
        reasons.append(
            "channels left out of the fit that speak against the causes are predicted worse with "
            f"them: their gap is {unseen[0]:.3g} times the noise without and {unseen[1]:.3g} with"
        )
    if gained.after > criteria.held_out_gap:
        members, gains = found.problem.levels[:2]
        reasons.append(
            f"the gap on rows that no step saw is {gained.after:.2g} times the noise: members that "
            f"are off by {members:.1%} and gauges by {gains:.1%}, as they may be as built, would "
            "explain it, and so might something that no kind of effect says"
        )
    together = _begun_together(found)
    if together >= criteria.begun_together:
        reasons.append(
            f"{together} channels are off from about the same moment on: a logger that was started "
            "or set to zero anew may show this as well"
        )
    plausible = np.array(criteria.plausible)
    if (found.problem.levels > criteria.implausible * plausible).any():
        worst = int(np.argmax(found.problem.levels / plausible))
        of = ("the stiffness of members", "gains of channels", "responses to the loads")[worst]
        reasons.append(
            f"{of} would have to scatter by {found.problem.levels[worst]:.1%}, and "
            f"{plausible[worst]:.0%} is plausible"
        )
    return reasons


def _begun_together(found: Found) -> int:
    """The largest number of causes at sensors that begin within some rows of each other."""
    moments = [one.onset for one in found.fit.hypotheses if one.kind.on_sensors]
    begun = np.array([moment for moment in moments if moment is not None])
    rows = np.searchsorted(found.problem.data.time, begun)
    return int((np.abs(rows[:, None] - rows) <= TOGETHER).sum(1).max(initial=0))


def _named(one: Hypothesis, found: Found) -> bool:
    """Whether the same kind at the same place is among the causes."""
    return any(one.same_place(cause) for cause in found.fit.hypotheses)
