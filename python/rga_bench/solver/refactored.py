"""C3: every stiffness varies, on bridges of one span and of ten."""

from collections.abc import Mapping
from functools import partial

from rga import _core
from rga_bench.installed import present
from rga_bench.measurement import Measurement
from rga_bench.solver.agreement import agree
from rga_bench.solver.box_bridge import BoxBridge, box_bridge, samples
from rga_bench.solver.from_scratch import FromScratch
from rga_bench.solver.peers import Peer
from rga_bench.solver.peers.cholmod import Cholmod, fastest_cholmod, least_operations
from rga_bench.solver.peers.linear_system import LinearSystem
from rga_bench.solver.peers.pynite import PyNite
from rga_bench.solver.peers.superlu import SuperLU
from rga_bench.solver.roofs import Roofs
from rga_bench.solver.setting import SolverSetting
from rga_bench.solver.simd_batch import SimdBatch
from rga_bench.timing import shortest

#: samples that are compared before anything is timed
COMPARED = 8
#: times as fast as CHOLMOD, the target of each instruction set
LEAST = {"avx512": 17.0, "avx2": 9.0}
LEAST_TEN_SPANS = 10.0


def one_span(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """The bridge of 84 nodes, by instruction set; the best beside all peers and the roof."""
    bridge = box_bridge(setting.seed)
    system = LinearSystem(bridge)
    by_instructions = {name: SimdBatch(bridge, name) for name in _core.instructions()}
    best = next(iter(by_instructions))
    cholmod, known_as = _cholmod(system, setting)
    fast = rates(
        bridge, {**by_instructions, known_as: cholmod, "SciPy splu": SuperLU(system)}, setting
    )
    slow = rates(
        bridge,
        {
            best: by_instructions[best],
            "PyNite": present(lambda: PyNite(bridge, system)),
            "rga, the structure anew": FromScratch(bridge),
        },
        setting,
    )
    case = f"C3, every stiffness varies, {system.size} DOFs"

    def ours(name: str) -> Measurement:
        return Measurement(case, name, fast[name], "/s")

    figures = [
        ours(name).beside(known_as, fast.get(known_as), LEAST.get(name)) for name in by_instructions
    ]
    figures.append(ours(best).beside("SciPy splu", fast["SciPy splu"]))
    again = Measurement(case, best, slow[best], "/s")
    figures += [
        again.beside(peer, slow.get(peer)) for peer in ("PyNite", "rga, the structure anew")
    ]
    if cholmod is not None:
        factor, solves = least_operations(system)
        for work, which in (
            (factor, "least factorisation"),
            (factor + solves, "and two triangular solves"),
        ):
            name = f"share of the dgemm roof, {which}: {work / 1e3:.1f} kflop"
            figures.append(Measurement(case, name, fast[best] * work / roofs.arithmetic))
    return figures


def ten_spans(setting: SolverSetting, roofs: Roofs) -> list[Measurement]:
    """Ten such spans one behind the other, as a continuous bridge."""
    bridge = box_bridge(setting.seed, spans=10)
    system = LinearSystem(bridge)
    best = _core.instructions()[0]
    cholmod, known_as = _cholmod(system, setting)
    solvers = {best: SimdBatch(bridge, best, 256), known_as: cholmod, "SciPy splu": SuperLU(system)}
    found = rates(bridge, solvers, setting)
    ours = Measurement(f"C3, ten spans, {system.size} DOFs", best, found[best], "/s")
    return [
        ours.beside(known_as, found.get(known_as), LEAST_TEN_SPANS),
        ours.beside("SciPy splu", found["SciPy splu"]),
    ]


def rates(
    bridge: BoxBridge, solvers: Mapping[str, Peer | None], setting: SolverSetting
) -> dict[str, float]:
    """Samples of each solver [1/s], but of those that are not installed.

    Raises:
        ArithmeticError: one of them disagrees with the structure solved anew.
    """
    there = {name: solver for name, solver in solvers.items() if solver is not None}
    factors, q = samples(bridge, max(one.rows for one in there.values()), setting.seed)
    plain = FromScratch(bridge).respond(factors[:COMPARED], q[:COMPARED])
    for name, solver in there.items():
        few = min(COMPARED, solver.rows)
        agree(name, solver.respond(factors[:few], q[:few]), plain[:few])
    tasks = [partial(one.respond, factors[: one.rows], q[: one.rows]) for one in there.values()]
    taken = zip(there.items(), shortest(tasks, setting.seconds * len(tasks)), strict=True)
    return {name: solver.rows / time for (name, solver), time in taken}


def _cholmod(system: LinearSystem, setting: SolverSetting) -> tuple[Cholmod | None, str]:
    """CHOLMOD at its best, with how it was set."""
    found = present(lambda: fastest_cholmod(system, setting.seconds / 8))
    return found, "CHOLMOD" if found is None else f"CHOLMOD ({', '.join(found.settings)})"
