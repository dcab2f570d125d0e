"""What must hold of any findings, however broken the record: see `check_invariants`."""

from rga import Findings
from rga.diagnosis.checks.support import gaps_left_out, worsens
from rga.diagnosis.search.stepwise import without_cause
from rga.model.effect import Effect

#: gap on rows that no step saw above which nothing is not all that is wrong
NEAR_ONE = 2.0


def check_invariants(findings: Findings) -> None:
    """A structural cause stands on readings that were not fitted, and `nothing_wrong` on all."""
    held = findings.gap.held_out
    kinds = [cause.effect["kind"] for cause in findings.causes]
    if any(not Effect.vocabulary[kind].on_sensors for kind in kinds):
        assert held.gain_ci90[0] > 0
        assert held.after < held.before
        _check_channels_left_out(findings)
    if findings.verdict in ("named", "ambiguous") and set(kinds) - {"sensor_fault"}:
        assert held.after < held.before
        assert held.after <= NEAR_ONE
        found = findings.account.found
        unseen = None if found is None else gaps_left_out(found)
        assert unseen is None or unseen[1] <= 1.5 * unseen[0]
    if findings.verdict in ("nothing_wrong", "unknown"):
        assert not kinds
        assert findings.account.extended.effects == findings.account.model.effects
    if findings.verdict == "nothing_wrong":
        assert held.after <= NEAR_ONE
        assert not findings.misfits
    broken = [cause.effect["sensor"] for cause in findings.causes if _is_fault(cause.effect)]
    if 2 * len(broken) >= len(findings.account.record.sensors):
        assert findings.verdict in ("partial", "unknown")
    if findings.misfits:
        assert findings.verdict in ("partial", "unknown")
        reported = " ".join([findings.unexplained.looks_like, *findings.warnings])
        groups = [one.sensors for one in findings.groups if one.group in reported]
        within = {name for sensors in groups for name in sensors}
        unreported = [
            name for name in findings.misfits if name not in reported and name not in within
        ]
        assert not unreported or "more channels or groups" in reported


def _check_channels_left_out(findings: Findings) -> None:
    found = findings.account.found
    assert found is not None
    for number, one in enumerate(found.fit.hypotheses):
        if not one.kind.on_sensors:
            without = without_cause(found.problem, found.base, found.fit, number)
            assert not worsens(found, without)


def _is_fault(effect: dict[str, object]) -> bool:
    return effect["kind"] == "sensor_fault"
