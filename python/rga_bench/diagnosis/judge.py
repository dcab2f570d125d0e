"""What became of a draw: diagnosed as a user would, then held against the truth."""

import tempfile
import time
from collections.abc import Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from rga.diagnosis import diagnose
from rga.findings import Findings
from rga.findings.schema import Cause
from rga.model import load_model
from rga.model.effect import Effect
from rga.records import load_record
from rga_bench.diagnosis.design import Draw
from rga_bench.diagnosis.field_design import draw_of
from rga_bench.diagnosis.hidden import Truth
from rga_bench.diagnosis.permitted_causes import STIFF_JOINTS, PermittedCauses
from rga_bench.diagnosis.reference_fit import ReferenceFit
from rga_bench.diagnosis.unseen import unseen_gaps
from rga_bench.synthetic import Case

#: rivals that a cause may have and still say where to look
FEW_RIVALS = 3
#: explanations whose chances are kept
KEPT = 8


@dataclass(frozen=True)
class DrawOutcome:
    """What became of a draw; what stands in a line of the ledger.

    Attributes:
        id: of the draw.
        null: name of the null record that its twin is.
        contexts: how they were known: known, measured, off, latent.
        bridge, reality: the case stands on.
        hidden: effects, each with kind, place, value, onset, end [s], `d_prime`, `d_perp` and
            the `nearest` rival, whether it was `found`: kind and place right, as a cause or
            among at most three rivals; `cause`: number of the cause that names it, or None.
        verdict: of the diagnosis.
        named: causes, each with kind, place, `onset`, `log_odds`, `d_perp` and `rivals`, and
            whether something `hidden` is among these; the true stiffness of joints left out.
        deviations: by kind and parameter, the truth from the estimate in standard deviations.
        onsets: of effects named that begin late: `inside` their 90 % interval, `error` as a
            share of the record, and whether it is a `ramp`.
        gaps: where the record shows nothing, of the model as given, as found, and true.
        gain_covered: whether the 90 % interval of the gain holds the true gain; None: no cause.
        chances: of the likeliest explanations, with whether each is the truth.
        seconds: that the diagnosis took.
        model_sha256: of the model file.
        broken_told: whether a broken channel is a cause or a rival; None: no channel is broken.
    """

    id: str
    null: str
    contexts: str
    bridge: str
    reality: str
    hidden: list[dict[str, Any]]
    verdict: str
    named: list[dict[str, Any]]
    deviations: dict[str, dict[str, float]]
    onsets: list[dict[str, Any]]
    gaps: dict[str, float] | None
    gain_covered: bool | None
    chances: list[tuple[float, bool]]
    seconds: float
    model_sha256: str
    advice: list[bool] = field(default_factory=list)
    broken_told: bool | None = None

    @property
    def draw(self) -> Draw:
        """The draw that it came of."""
        return draw_of(self.id)

    @property
    def found(self) -> bool:
        """All that is hidden was found."""
        return all(one["found"] for one in self.hidden)


def judge(draw: Draw) -> DrawOutcome:
    """Draw a case, diagnose it from its files, and score."""
    case = draw.case()
    with tempfile.TemporaryDirectory() as folder:
        case.write(folder)
        model = load_model(Path(folder) / "model.json")
        record = load_record(Path(folder) / "record.csv", model)
    begun = time.perf_counter()
    findings = diagnose(model, record, seed=draw.seed)
    seconds = time.perf_counter() - begun

    truths = Truth.of(case)
    permitted = PermittedCauses.of(case)
    causes = [cause for cause in findings.causes if not permitted.has(cause.effect)]
    hidden, deviations, gaps = [], {}, None
    if truths:
        with threadpool_limits(1):
            reference = ReferenceFit(case, model, record)
            sizes = reference.sizes()
            joints = any(cause.effect["kind"] in STIFF_JOINTS for cause in findings.causes)
            deviations = reference.deviations(joints)
            gaps = unseen_gaps(case, _added(findings))
        for truth, size in zip(truths, sizes, strict=True):
            number = _cause_of(truth, causes)
            if number is not None:
                off = reference.deviations_reported(truth, causes[number].effect)
                deviations |= {truth.kind: off} if off else {}
            hidden.append(
                {
                    "kind": truth.kind,
                    "place": dict(truth.place),
                    "values": truth.values,
                    "onset": truth.onset,
                    "end": truth.end,
                    "d_prime": size.d_prime,
                    "d_perp": size.d_perp,
                    "nearest": size.nearest,
                    "found": any(_among(truth, cause) for cause in causes),
                    "cause": number,
                }
            )
    return DrawOutcome(
        id=draw.id,
        null=draw.null_name,
        contexts=draw.contexts,
        bridge=case.truth["bridge"],
        reality=case.truth["reality"],
        hidden=hidden,
        verdict=findings.verdict,
        named=[_named(cause, truths) for cause in causes],
        deviations=deviations,
        onsets=_onsets(case, truths, causes),
        gaps=None if gaps is None else vars(gaps).copy(),
        gain_covered=_gain_covered(case, findings) if findings.causes else None,
        chances=_chances(findings, truths, permitted),
        seconds=seconds,
        model_sha256=findings.model_sha256,
        broken_told=permitted.broken_reported(findings),
    )


def _added(findings: Findings) -> dict[str, Effect]:
    model, extended = findings.account.model, findings.account.extended
    return {name: one for name, one in extended.effects.items() if name not in model.effects}


def _named(cause: Cause, truths: list[Truth]) -> dict[str, Any]:
    candidates = [cause.effect, *cause.rivals]
    return {
        **kind_and_place(cause.effect),
        "hidden": any(truth.is_at(one) for truth in truths for one in candidates),
        "onset": cause.onset,
        "log_odds": cause.log_odds,
        "d_perp": cause.d_perp,
        "rivals": [kind_and_place(rival) for rival in cause.rivals],
    }


def kind_and_place(effect: dict[str, Any]) -> dict[str, Any]:
    """What an effect is, without its parameters."""
    fields = Effect.vocabulary[effect["kind"]].place_fields()
    return {"kind": effect["kind"], **{name: effect[name] for name in fields if name in effect}}


def _cause_of(truth: Truth, causes: Sequence[Cause]) -> int | None:
    return next((k for k, cause in enumerate(causes) if truth.is_at(cause.effect)), None)


def _among(truth: Truth, cause: Cause) -> bool:
    candidates = [cause.effect, *cause.rivals]
    return len(cause.rivals) <= FEW_RIVALS and any(truth.is_at(one) for one in candidates)


def _onsets(case: Case, truths: list[Truth], causes: list[Cause]) -> list[dict[str, Any]]:
    length = float(case.time[-1] - case.time[0])
    out = []
    for truth in truths:
        number = _cause_of(truth, causes)
        if truth.onset is None or number is None or truth.kind == "sensor_fault":
            continue
        onset, interval = causes[number].onset, causes[number].onset_ci90
        late = onset is not None and interval is not None
        low, high = map(float, interval) if late and interval else (np.nan, np.nan)
        estimate = float(onset) if late and onset is not None else float(case.time[0])
        out.append(
            {
                "kind": truth.kind,
                "inside": bool(low <= truth.onset <= high),
                "error": abs(estimate - truth.onset) / length,
                "ramp": truth.end is not None,
            }
        )
    return out


def _gain_covered(case: Case, findings: Findings) -> bool:
    """Whether the interval of the gain holds that over the whole record, were there no noise."""
    assert case.beyond is not None
    account = findings.account
    order = {name: number for number, name in enumerate(case.beyond.sensors)}
    columns = np.array([order[name] for name in account.record.sensors], dtype=np.int64)
    rows = np.searchsorted(case.time, account.record.time + account.record.origin)
    clean = case.beyond.clean[np.ix_(rows, columns)]
    off = [((clean - one) / account.noise) ** 2 for one in (account.before, account.after)]
    seen = np.isfinite(account.record.readings) & np.isfinite(off[0]) & np.isfinite(off[1])
    low, high = findings.gap.held_out.gain_ci90
    return bool(low <= float((off[0] - off[1])[seen].mean()) <= high)


def _chances(
    findings: Findings, truths: list[Truth], permitted: PermittedCauses
) -> list[tuple[float, bool]]:
    """Chances of the explanations that were tried, the likeliest first, and which are the truth."""
    tried: dict[str, tuple[float, bool]] = {}
    for one in findings.explanations:
        effects = [effect for effect in one.effects if not permitted.has(effect)]
        right = len(effects) == len(truths) and all(
            any(truth.is_at(effect) for effect in effects) for truth in truths
        )
        tried.setdefault(
            repr([kind_and_place(each) for each in one.effects]), (one.log_odds, right)
        )
    odds = np.array([one for one, _ in tried.values()])
    shares = np.exp(odds - odds.max())
    shares /= shares.sum()
    pairs = sorted(zip(shares, (right for _, right in tried.values()), strict=True), reverse=True)
    return [(float(share), bool(right)) for share, right in pairs[:KEPT]]
