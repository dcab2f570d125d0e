"""Large models: one factorisation of a double-layer grid."""

import time
from collections.abc import Callable
from functools import partial

import numpy as np

from rga import _core
from rga.arrays import FloatArray
from rga_bench.installed import present
from rga_bench.measurement import Measurement
from rga_bench.solver.agreement import agree
from rga_bench.solver.double_layer_grid import double_layer_grid
from rga_bench.solver.from_scratch import FromScratch
from rga_bench.solver.peers.cholmod import Cholmod
from rga_bench.solver.peers.linear_system import LinearSystem
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.timing import shortest

#: orderings of CHOLMOD that are tried; supernodal is its best mode by far
ORDERINGS = ("amd", "metis", "nesdis", "default", "best")
#: times as fast as CHOLMOD's factorisation, the target of grids by their panels
LEAST = {64: 1 / 1.5, 204: 1 / 2}
#: of displacements: roofs without columns are soft, so that rounding shows
AGREEMENT = 1e-8
TURNS = 3
#: ways to solve a grid: for other stiffnesses, or as if it had never been seen
WAYS = ("factorisation and solve", "from scratch")
Solve = Callable[[], FloatArray]


def grid(panels: int, setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """All displacements of a grid for one set of stiffnesses, beside CHOLMOD.

    CHOLMOD is handed its matrix where it begins from scratch; ours assembles it in its time.
    """
    truss = double_layer_grid(panels, setting.seed)
    system = LinearSystem(truss)
    factors, q = 1.0 + 0.5 * setting.draw(1, len(truss.structure["ends"])), np.ones((1, 1))
    solver = _core.Refactored(truss.structure, truss.loads, truss.outputs)
    ours: list[Solve] = [
        partial(solver.respond, factors, q),
        partial(FromScratch(truss).respond, factors, q),
    ]
    known_as, theirs = _cholmod(system, factors, q)
    solved = [task() for task in (*ours, *theirs)]
    apart = max(agree("the grid", one, solved[0], AGREEMENT) for one in solved[1:])
    taken = shortest([*ours, *theirs], 4 * setting.seconds, TURNS)
    their_times = taken[2:] if theirs else [None, None]

    free = ~truss.structure["fixed"][:, :3]
    values, forces = system.values(factors)[0], system.forces(factors, q)[0]
    left = [system.residual(values, one.reshape(free.shape)[free], forces) for one in solved]
    case = f"double-layer grid, {system.size} DOFs"
    return [
        *(
            Measurement(case, way, own, "s").beside(peer, their, least)
            for way, own, peer, their, least in zip(
                WAYS, taken[:2], known_as, their_times, (LEAST.get(panels), None), strict=True
            )
        ),
        Measurement(
            case,
            "residual of K u = f, relative",
            left[0],
            "",
            known_as[0],
            left[2] if theirs else None,
        ),
        Measurement(case, "displacements apart, of the largest", apart),
    ]


def _cholmod(
    system: LinearSystem, factors: FloatArray, q: FloatArray
) -> tuple[list[str], list[Solve]]:
    """CHOLMOD in both ways, each in its fastest ordering; no way where it is not installed."""
    times: dict[str, tuple[float, float]] = {}
    for ordering in ORDERINGS:
        begin = time.perf_counter()
        trial = present(partial(Cholmod, system, ("supernodal", ordering)))
        if trial is None:
            return ["CHOLMOD"] * 2, []
        trial.respond(factors, q)
        analysed = time.perf_counter()
        trial.respond(factors, q)
        times[ordering] = time.perf_counter() - analysed, analysed - begin
    again, scratch = (min(times, key=lambda one: times[one][way]) for way in (0, 1))
    kept = Cholmod(system, ("supernodal", again))
    return [f"CHOLMOD (supernodal, {ordering})" for ordering in (again, scratch)], [
        partial(kept.respond, factors, q),
        lambda: Cholmod(system, ("supernodal", scratch)).respond(factors, q),
    ]
