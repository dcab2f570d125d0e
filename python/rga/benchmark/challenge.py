"""The blind challenge: effects hidden by seed, each beside its null twin, diagnosed and scored.

The cases come from `rga.benchmark.truth`, which shares no code with the simulator: reality is a
truss or a frame with scatter in every member, gains in every channel and noise with memory.
"""

import tempfile
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from rga.benchmark.truth import draw_case

#: hidden effects of this size or more must be found
VISIBLE = 15.0
#: the true state of a frame that is modelled as a truss: named or not, it is no mistake
STIFF_JOINTS = ("joint_rigidity", "rigid_end_zone")


@dataclass(frozen=True)
class Outcome:
    """What became of a case.

    Attributes:
        seed, bridge, reality, kind, place, d_prime: of what was hidden.
        verdict: of the diagnosis.
        named: kinds and places of the causes, the true stiffness of joints left out.
        rivals: kinds and places of their rivals.
        found: kind and place right, as a cause or among the rivals.
        seconds: that the diagnosis took.
    """

    seed: int
    bridge: str
    reality: str
    kind: str
    place: dict[str, Any]
    d_prime: float
    verdict: str
    named: list[dict[str, Any]]
    rivals: list[dict[str, Any]]
    found: bool
    seconds: float


def challenge(
    seeds: Sequence[int], workers: int, progress: Callable[[int], None] = lambda done: None
) -> list[Outcome]:
    """Draw cases and their null twins, diagnose all of them, and score.

    Args:
        seeds: one a hidden effect; as many null twins are diagnosed.
        workers: processes at work; the outcome does not depend on their number.
        progress: told how many diagnoses are done.

    Returns:
        Two outcomes a draw: the hidden effect, then its null twin.
    """
    tasks = [(seed, null) for seed in seeds for null in (False, True)]
    if workers == 1:
        return list(_told(map(_one, tasks), progress))
    with ProcessPoolExecutor(workers, mp_context=get_context("spawn")) as pool:
        return list(_told(pool.map(_one, tasks), progress))


def score(outcomes: list[Outcome]) -> dict[str, Any]:
    """Counts of the challenge: hidden effects found by kind, and causes named in null twins."""
    hidden = [one for one in outcomes if one.kind not in ("null", "unknown")]
    large = [one for one in hidden if one.d_prime >= VISIBLE]
    nulls = [one for one in outcomes if one.kind == "null"]
    kinds = sorted({one.kind for one in large})
    return {
        "hidden_at_15": len(large),
        "found_at_15": sum(one.found for one in large),
        "by_kind": {
            kind: [
                sum(o.found for o in large if o.kind == kind),
                sum(o.kind == kind for o in large),
            ]
            for kind in kinds
        },
        "nulls": len(nulls),
        "nulls_with_causes": sum(bool(one.named) for one in nulls),
        "seconds_median": sorted(one.seconds for one in outcomes)[len(outcomes) // 2],
        "cases": [asdict(one) for one in outcomes],
    }


def _told(outcomes: Any, progress: Callable[[int], None]) -> Iterator[Outcome]:
    for done, outcome in enumerate(outcomes, 1):
        progress(done)
        yield outcome


def _one(task: tuple[int, bool]) -> Outcome:
    # The drawing of cases must not need the diagnosis, nor the other way round.
    import time

    from rga.diagnosis import diagnose
    from rga.model import load_model
    from rga.records import load_record

    seed, null = task
    case = draw_case(seed)
    if null or case.truth["kind"] == "null":
        case = draw_case(
            seed, bridge=case.truth["bridge"], kind="null", reality=case.truth["reality"]
        )
    with tempfile.TemporaryDirectory() as folder:
        case.write(folder)
        model = load_model(Path(folder) / "model.json")
        record = load_record(Path(folder) / "record.csv", model)
        begun = time.perf_counter()
        findings = diagnose(model, record, seed=seed)
    truth = case.truth
    true_frame = truth["reality"] == "frame"
    named = [
        cause
        for cause in findings.causes
        if not (
            true_frame
            and truth["kind"] != "joint_rigidity"
            and cause.effect["kind"] in STIFF_JOINTS
        )
    ]
    effects = [_kind_and_place(cause.effect) for cause in named]
    rivals = [_kind_and_place(rival) for cause in named for rival in cause.rivals]
    return Outcome(
        seed=seed,
        bridge=truth["bridge"],
        reality=truth["reality"],
        kind=truth["kind"],
        place=truth["place"],
        d_prime=truth["d_prime"],
        verdict=findings.verdict,
        named=effects,
        rivals=rivals,
        found=any(_same(effect, truth) for effect in [*effects, *rivals]),
        seconds=time.perf_counter() - begun,
    )


def _kind_and_place(effect: dict[str, Any]) -> dict[str, Any]:
    from rga.model import Effect

    fields = Effect.vocabulary[effect["kind"]].place_fields()
    return {"kind": effect["kind"], **{name: effect[name] for name in fields if name in effect}}


def _same(effect: dict[str, Any], truth: dict[str, Any]) -> bool:
    """Kind and place right; the order of a list does not matter."""
    return effect["kind"] == truth["kind"] and all(
        _set(effect.get(name)) == _set(value) for name, value in truth["place"].items()
    )


def _set(place: Any) -> Any:
    if isinstance(place, list | tuple) and all(isinstance(one, str) for one in place):
        return frozenset(place)
    if isinstance(place, list | tuple):
        return tuple(float(one) for one in place)
    return frozenset([place])
