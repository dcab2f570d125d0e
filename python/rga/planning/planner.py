"""The plan: a model and its findings in, the measurements that separate the rivals out."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.experiments.defaults import strain_share, usual_truck
from rga.experiments.separation import Pair
from rga.experiments.site import Site
from rga.experiments.truck import Lane, Truck, given_lane, lane_of, lane_of_masses, read_truck
from rga.findings import Findings
from rga.findings.load import as_findings, findings_sha256
from rga.findings.phrases import effect_words
from rga.model import Model, as_model
from rga.numerics.seeds import as_seed
from rga.planning.advised import advised
from rga.planning.modal.candidates import PARKED_MASS
from rga.planning.modal.practical import impractical
from rga.planning.monte_carlo import Checked, checked
from rga.planning.predictions import planned_sensor, planned_test
from rga.planning.result import Advised, Plan, PlannedTruck, Ranked, Separation, SimulatedTrials
from rga.planning.rivals import rival_pairs, told_apart
from rga.planning.scope import Scope, scope_of
from rga.planning.selection import Choice, Chooser
from rga.provenance import versions

#: what may be measured where the user says nothing
SENSORS, POSITIONS = 2, 3
Progress = Callable[[str, float], None]


def plan(
    model: Model | str | Path,
    findings: Findings | str | Path,
    *,
    sensors: int = SENSORS,
    positions: int = POSITIONS,
    truck: str | None = None,
    paths: Sequence[Sequence[str]] = (),
    seed: int = 0,
    progress: Progress | None = None,
) -> Plan:
    """Choose the sensors and load tests that best separate what findings cannot separate.

    Args:
        model: the model that was diagnosed, or its file.
        findings: of its diagnosis, or their file, or the directory that holds it.
        sensors: sensors that may be added.
        positions: tests that may be made: places of a truck, settings of contexts, and windows of
            modes where the findings are of such.
        truck: axle loads [kN] @ spacings [m], such as "60,100@3.5"; None: a truck that strains the
            structure as its own loads do.
        paths: of nodes that share the truck alike; none: those that the model's loads show.
        seed: of the drawn readings.
        progress: called with a stage and the share of it that is done.

    Returns:
        The plan, with the separation that it gives and a check of it by simulation.

    Raises:
        InputError: findings of another model, a budget below zero, a truck that is none or does
            not stand on its path, a seed that is none, or explanations that cannot be simulated.
    """
    model, findings, seed = as_model(model), as_findings(findings), as_seed(seed)
    for value, option in ((sensors, "sensors"), (positions, "positions")):
        if value < 0:
            raise InputError(f"{option} are {value}", f"--{option}", "give 0 or more")
    if findings.model_sha256 != model.sha256:
        raise InputError(
            "these findings are of another model",
            f"findings of {findings.model_sha256[:12] or 'a model made in memory'}, "
            f"model {model.sha256[:12] or 'made in memory'}",
            "give the model file that was diagnosed, unchanged",
        )
    vehicle = None if truck is None else read_truck(truck)
    with threadpool_limits(1):
        return _planned(
            model, findings, (sensors, positions), vehicle, paths, seed, progress or _silent
        )


def _planned(
    model: Model,
    findings: Findings,
    budget: tuple[int, int],
    truck: Truck | None,
    paths: Sequence[Sequence[str]],
    seed: int,
    progress: Progress,
) -> Plan:
    lane = given_lane(model, paths) if paths else lane_of(model)
    if lane is None and findings.windows is not None:
        lane = lane_of_masses(model)
    warnings: list[str] = []
    given = truck is not None
    if lane is None and truck is not None:
        raise InputError(
            "the model shows no path for a truck", "--truck", "name the nodes of it with --path"
        )
    if lane is not None:
        share = strain_share(model, lane, truck) if truck is not None else 0.0
        truck = truck or usual_truck(model, lane)
        if share > findings.criteria.advice.heavy_truck:
            warnings.append(
                f"the truck strains the structure {share:.2g} times as much as its loads at most"
            )
    stated: dict[str, Any] = {
        "budget": {"sensors": budget[0], "positions": budget[1]},
        "seed": seed,
        "model_sha256": model.sha256,
        "findings_sha256": findings_sha256(findings),
        "versions": versions(),
    }
    rivalries = rival_pairs(model, findings)
    if not rivalries:
        return Plan(
            sentence="The findings name no cause: there is nothing to tell apart.", **stated
        )
    progress("simulating what could be measured", 0.0)
    scope = scope_of(model, findings, rivalries, lane, truck, warnings)
    parking = any(test.kind == PARKED_MASS for test in scope.site.tests)
    too_much = impractical(model, truck, given) if parking and truck is not None else None
    warnings += [too_much] if too_much is not None else []
    progress("choosing measurements", 0.0)
    chooser = scope.chooser(_separable(scope))
    sensors, tests = advised(findings, scope.site.added, scope.site.tests)
    columns = [scope.site.standing + one for one in sensors]
    choice = chooser.best(*budget, (columns, tests))
    beside = _beside(chooser, scope.site, choice, columns, tests)
    least = min(choice.separation, default=0.0)
    everything = scope.chooser(range(len(scope.pairs)))
    choice = Choice(
        choice.sensors, choice.tests, everything.separation(choice.sensors, choice.tests)
    )
    separations = []
    for number, pair in enumerate(scope.pairs):
        progress("simulating the plan", number / len(scope.pairs))
        found = _checked(scope, choice, pair, lane, truck, seed + number)
        distance, best = float(choice.separation[number]), float(scope.best[number])
        separations.append(
            Separation(
                one=pair.cause.words,
                other=pair.rival.words,
                log_odds=told_apart(findings, pair.cause.words, pair.rival.words),
                d_perp=distance,
                expected=scope.success(distance),
                d_perp_at_best=best,
                separated=found.clearly >= scope.criteria.advice.success,
                simulated=SimulatedTrials(draws=found.draws, won=found.won, clearly=found.clearly),
            )
        )
    site, pairs = scope.site, scope.pairs
    made = [planned_test(site, scope.errors, pairs, choice, one) for one in choice.tests]
    driven = any(test.position is not None for test in made)
    parked = any(site.tests[one].kind == PARKED_MASS for one in choice.tests)
    return Plan(
        sentence=" ".join(
            [
                _sentence(separations, scope, choice),
                *([f"Of this plan, {too_much}."] if too_much is not None and parked else []),
                *_compared(beside, least),
                *_by_modes(model, findings),
            ]
        ),
        sensors=[planned_sensor(site, scope.errors, pairs, choice, one) for one in choice.sensors],
        tests=made,
        truck=_truck(truck, lane) if driven and truck and lane else None,
        separations=separations,
        ranked=_ranked(scope, everything),
        advised=beside,
        cost=chooser.cost(choice),
        warnings=warnings,
        **stated,
    )


def _beside(
    chooser: Chooser,
    site: Site,
    choice: Choice,
    sensors: Sequence[int],
    tests: Sequence[int],
) -> list[Advised]:
    """What the findings advise, beside what was chosen."""

    def one(words: str, planned: bool, alone: FloatArray) -> Advised:
        return Advised(words=words, planned=planned, d_perp=min(alone.tolist(), default=0.0))

    return [
        *(
            one(
                site.added[k - site.standing].words,
                k in choice.sensors,
                chooser.separation([k], ()),
            )
            for k in sensors
        ),
        *(one(site.tests[k].words, k in choice.tests, chooser.separation((), [k])) for k in tests),
    ]


def _ranked(scope: Scope, everything: Chooser) -> list[Ranked]:
    """The best measurement of each kind by itself."""
    site = scope.site
    best: dict[str, Ranked] = {}
    for choice in everything.alone():
        one = (
            site.added[choice.sensors[0] - site.standing]
            if choice.sensors
            else site.tests[choice.tests[0]]
        )
        if one.kind not in best:
            found = choice.separation.tolist()
            best[one.kind] = Ranked(
                kind=one.kind,
                words=one.words,
                cost=one.cost,
                d_perp=found,
                expected=[scope.success(distance) for distance in found],
            )
    return list(best.values())


def _compared(beside: Sequence[Advised], least: float) -> list[str]:
    """What the findings advise and the plan leaves out, in words."""
    return [
        f"The findings advise {one.words}: by itself that gives d_perp {one.d_perp:.2g} or more, "
        f"this plan {least:.2g}."
        for one in beside
        if not one.planned
    ]


def _by_modes(model: Model, findings: Findings) -> list[str]:
    """That no natural frequency is planned where none is, and what the findings advise of modes."""
    if not model.modes:
        return []
    plain = (
        "Only sensors and load tests are planned, natural frequencies and shapes are not: the "
        "findings hold no windows of modes. Diagnose the modes (--modal), and plan again."
    )
    told = (
        f"Of {effect_words(one.effect)} the findings advise, {one.separated_by}."
        for one in findings.causes
        if one.separated_by
    )
    return [*([plain] if findings.windows is None else []), *told]


def _separable(scope: Scope) -> list[int]:
    """Pairs that something could separate."""
    least = scope.criteria.advice.success
    return [k for k, best in enumerate(scope.best) if scope.success(float(best)) >= least]


def _checked(
    scope: Scope,
    choice: Choice,
    pair: Pair,
    lane: Lane | None,
    truck: Truck | None,
    seed: int,
) -> Checked:
    """The check of a choice on a site that has nothing but what was chosen."""
    small = scope.chosen(choice, lane, truck)
    present = np.zeros((small.operating + len(small.tests), len(small.sensors)))
    present[: small.operating, small.standing :] = 1.0
    present[small.operating :] = 1.0
    odds = scope.criteria.rivals.log_odds
    return checked(small, pair.cause, pair.rival, present, odds, seed)


def _sentence(separations: Sequence[Separation], scope: Scope, choice: Choice) -> str:
    site, criteria = scope.site, scope.criteria
    sentences = [site.added[one - site.standing].deed for one in choice.sensors]
    sentences += [f"test: {site.tests[one].words}" for one in choice.tests]
    words = "; ".join(sentences)
    sentences = [f"{words[0].upper()}{words[1:]}."] if sentences else []
    done = [one for one in separations if one.separated]
    if done:
        worst = min(one.simulated.clearly for one in done)
        whom = "each explanation" if len(done) == len(separations) else "what it tells apart"
        sentences.append(
            f"With readings drawn, {whom} then wins by {criteria.rivals.log_odds:g} log-odds in "
            f"{100 * worst:.0f} % of the draws in which it is true, or more."
        )
    for one in separations:
        limit = f"everything that was thought of gives d_perp {one.d_perp_at_best:.2g}"
        both = f"{one.one} from {one.other}"
        hopeless = scope.success(one.d_perp_at_best) < criteria.advice.success
        if one.separated:
            continue
        share = f"d_perp {one.d_perp:.2g}, won in {100 * one.simulated.clearly:.0f} %"
        if one.log_odds is not None and one.log_odds >= criteria.rivals.log_odds:
            again = (
                "no sensor and no load test does so again"
                if hopeless
                else (f"this budget does not do so again ({share})")
            )
            sentences.append(f"The record tells {both} by {one.log_odds:.0f} log-odds; {again}.")
        elif hopeless:
            sentences.append(f"Nothing affordable tells {both}: {limit}.")
        else:
            sentences.append(f"This budget does not tell {both} ({share}): {limit}.")
    return " ".join(sentences)


def _truck(truck: Truck, lane: Lane) -> PlannedTruck:
    paths = [list(path) for path in lane.paths]
    return PlannedTruck(
        loads=list(truck.loads), spacings=list(truck.spacings), paths=paths, driven=lane.driven
    )


def _silent(stage: str, done: float) -> None:
    return None
