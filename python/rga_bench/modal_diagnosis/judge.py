"""What became of a draw with modes: diagnosed as a user would, then held against the truth."""

import tempfile
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from rga.arrays import FloatArray
from rga.diagnosis import diagnose, diagnose_modes
from rga.findings import Findings
from rga.findings.modal_arrays import ModalArrays
from rga.findings.schema import Cause
from rga.model import load_model
from rga.records.modal.read import load_modal_record
from rga_bench.diagnosis.hidden import Truth
from rga_bench.diagnosis.judge import FEW_RIVALS, kind_and_place
from rga_bench.diagnosis.permitted_causes import PermittedCauses
from rga_bench.modal_diagnosis.design import ModalDraw
from rga_bench.modal_diagnosis.size import modal_size
from rga_bench.swinging.case import ModalCase

#: kinds that move all frequencies alike; they are true where these are off together by so much
TOGETHER = ("elastic_modulus", "mass_factor", "clock_rate", "added_mass", "member_stiffness")
OFF_TOGETHER = 0.008
#: of a frequency, within which it is the one that was written
SAME = 1e-7


@dataclass(frozen=True)
class ModalOutcome:
    """What became of a draw; what stands in a line of the ledger.

    Attributes:
        id: of the draw.
        campaign: how its modes were measured.
        structure, reality: the case stands on.
        hidden: what is: kind, place, value, onset [s], `d_prime` by the generator, `d_perp` and
            `nearest` rival of the modes alone (None beside a record); None in a null twin.
        verdict: of the diagnosis.
        found: kind and place right, as a cause or among at most three rivals.
        among: the same however many rivals there are.
        inside: whether the 90 % interval of the cause at the true place has the true value; None:
            there is none.
        named: causes that are not true otherwise, each with kind, place, onset, log-odds, number
            of `rivals`, and whether something `hidden` is among these.
        paired: entries of the record that were given their true names.
        mispaired: that were given other names.
        doubtful: whether pairings are told to be in doubt.
        seconds: that the diagnosis took.
    """

    id: str
    campaign: str
    structure: str
    reality: str
    hidden: dict[str, Any] | None
    verdict: str
    found: bool
    among: bool
    inside: bool | None
    named: list[dict[str, Any]]
    paired: int
    mispaired: int
    doubtful: bool
    seconds: float

    @property
    def draw(self) -> ModalDraw:
        """The draw that it came of."""
        return ModalDraw.parse(self.id)


def judge_modes(draw: ModalDraw) -> ModalOutcome:
    """Draw a case, diagnose it from its files, and score."""
    case = draw.case()
    with tempfile.TemporaryDirectory() as folder:
        case.write(folder)
        model_file, modes = Path(folder) / "model.json", Path(folder) / "modes.csv"
        model = load_model(model_file)
        modal = load_modal_record(modes, model)
        begun = time.perf_counter()
        if draw.stratum == "mixed":
            record = Path(folder) / "record.csv"
            findings = diagnose(model_file, record, modal=modes, seed=draw.seed)
        else:
            findings = diagnose_modes(model_file, modes, seed=draw.seed)
        seconds = time.perf_counter() - begun
        truths = Truth.of(case)
        hidden = None
        if truths:
            (truth,) = truths
            hidden = {
                "kind": truth.kind,
                "place": dict(truth.place),
                "value": case.truth["value"],
                "onset": truth.onset,
                "d_prime": truth.d_prime,
                "d_perp": None,
                "nearest": None,
            }
            if draw.stratum == "modal":
                replace(draw, null=True).case().write(folder)
                size = modal_size(model, modal, load_modal_record(modes, model), truth)
                if size is not None:
                    hidden |= {"d_perp": size.d_perp, "nearest": size.nearest}
    true = [one for one in findings.causes if _has(truths, one)]
    causes = [one for one in findings.causes if one in true or not _permitted(case, one)]
    paired, mispaired = _pairs(case, findings.modes)
    return ModalOutcome(
        id=draw.id,
        campaign=draw.measured.name,
        structure=draw.structure,
        reality=case.truth["reality"],
        hidden=hidden,
        verdict=findings.verdict,
        found=any(len(one.rivals) <= FEW_RIVALS for one in true),
        among=bool(true),
        inside=_inside(case, truths, findings),
        named=[
            {
                **kind_and_place(one.effect),
                "onset": one.onset,
                "log_odds": one.log_odds,
                "rivals": len(one.rivals) + one.rivals_omitted,
                "hidden": one in true,
            }
            for one in causes
        ],
        paired=paired,
        mispaired=mispaired,
        doubtful="pairing" in findings.unexplained.looks_like,
        seconds=seconds,
    )


def _has(truths: Sequence[Truth], cause: Cause) -> bool:
    """Whether something hidden is a cause, or among its rivals."""
    return any(truth.is_at(one) for truth in truths for one in (cause.effect, *cause.rivals))


def _permitted(case: ModalCase, cause: Cause) -> bool:
    """Whether a cause is true of the case though it is not hidden.

    Stiff joints of a welded reality, what rolling mills put there, and what moves all frequencies
    alike where masses and moduli as they are do so: as what is hidden is found, as the cause itself
    or among at most three rivals.
    """
    permitted = PermittedCauses.of(case)
    near = cause.rivals if len(cause.rivals) <= FEW_RIVALS else []
    if any(permitted.has(one) for one in (cause.effect, *near)):
        return True
    common = float(case.truth["common"])
    if abs(common) < OFF_TOGETHER or cause.onset is not None:
        return False
    alike = {cause.effect["kind"], *(one["kind"] for one in cause.rivals)}
    return cause.effect["kind"] in TOGETHER and len(alike & set(TOGETHER)) > 1


def _inside(case: ModalCase, truths: Sequence[Truth], findings: Findings) -> bool | None:
    parameter = case.truth["parameter"]
    for truth in truths:
        for cause in findings.causes:
            estimate = cause.effect.get(parameter)
            if truth.is_at(cause.effect) and isinstance(estimate, Mapping):
                low, high = estimate["ci90"]
                return bool(low <= case.truth["value"] <= high)
    return None


def _pairs(case: ModalCase, modes: ModalArrays | None) -> tuple[int, int]:
    """Entries that have their true names, and that have others."""
    right = wrong = 0
    known = {name: number for number, name in enumerate(case.model["modes"])}
    for mode in modes.modes if modes is not None else ():
        true = case.frequency[:, known[mode.name]]
        given = _on_all_windows(np.exp(mode.log_f), case.frequency)
        seen = np.isfinite(given)
        same = np.abs(given / true - 1.0) < SAME
        right += int((seen & same).sum())
        wrong += int((seen & ~same).sum())
    return right, wrong


def _on_all_windows(frequency: FloatArray, written: FloatArray) -> FloatArray:
    """A mode's frequencies by windows in which anything was found, on all windows."""
    given = np.full(len(written), np.nan)
    given[np.isfinite(written).any(axis=1)] = frequency
    return given
