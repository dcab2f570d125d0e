"""What a sample costs: the paths of the simulation beside NumPy, on one structure, in one run."""

import platform
import time
from collections.abc import Callable
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np
from threadpoolctl import threadpool_limits

from rga import __version__, _core
from rga.benchmark.box_bridge import Arrays, Bridge, box_bridge
from rga.benchmark.data_set import data_set_cost
from rga.benchmark.truth.case_study import case_study_bridge
from rga.model import Model
from rga.model.parameter import FloatArray
from rga.simulation import Simulator
from rga.simulation.condensation import Condensation
from rga.simulation.factorisation import Factorisation

#: samples of a batch: large enough to leave the caches, as a data set does
ROWS = 262_144
#: sensors and contexts of the Jacobian
SENSORS, DIRECTIONS = 84, 8
#: rows of the data set
DATA_SET = 10_000_000
#: agreement that is asked for before anything is timed, relative to the largest output
AGREEMENT = 1e-9
#: seconds that each figure is measured for
SECONDS = 1.0


@dataclass(frozen=True)
class Figure:
    """One line of the table.

    Attributes:
        name: what is measured.
        value: ours, in `unit`.
        unit: of the value.
        peer: what it is compared with, or nothing.
        peer_value: that of the peer in the same run.
        ratio: how many times better than the peer.
    """

    name: str
    value: float
    unit: str
    peer: str | None = None
    peer_value: float | None = None
    ratio: float | None = None


def measure(quick: bool = False, progress: Callable[[float], None] | None = None) -> dict[str, Any]:
    """All figures on one core, after all paths agree with a plain solve.

    Args:
        quick: a sixteenth of the rows and of the time.
        progress: told the share that is done.

    Raises:
        ArithmeticError: two paths disagree.
    """
    rows, seconds = (ROWS // 16, SECONDS / 16) if quick else (ROWS, SECONDS)
    tasks = [
        _loads_vary,
        _few_stiffnesses_vary,
        _all_stiffnesses_vary,
        _one_sample,
        _large_displacements,
        _whole_model,
        _derivatives,
        _data_set,
    ]
    figures = []
    with threadpool_limits(1):
        roof = _bandwidth(rows, seconds)
        for number, task in enumerate(tasks):
            figures += task(rows, seconds, roof)
            if progress is not None:
                progress((number + 1) / len(tasks))
    return {
        "machine": {"processor": _processor(), "python": platform.python_version()},
        "versions": {"rga": __version__, "numpy": np.__version__},
        "rows": rows,
        "bandwidth_GB_s": roof / 1e9,
        "figures": [asdict(figure) for figure in figures],
    }


def _loads_vary(rows: int, seconds: float, roof: float) -> list[Figure]:
    bridge, nothing = box_bridge(), np.zeros(0, np.int64)
    ours = Condensation(bridge.structure, bridge.loads, bridge.outputs, nothing, nothing)
    matrix = _core.respond(bridge.structure, bridge.loads, bridge.outputs)
    q, still = _draw(rows, len(matrix)), np.zeros((rows, 0))
    found, expected = np.empty((rows, matrix.shape[1])), np.empty((rows, matrix.shape[1]))
    _agree("C1", ours.respond(q, still), q @ matrix)
    own = rows / _shortest(lambda: ours.respond(q, still, 1, found), seconds)
    peer = rows / _shortest(lambda: np.matmul(q, matrix, out=expected), seconds)
    traffic = 8 * (q.shape[1] + matrix.shape[1])
    return [
        _against("C1, loads vary", own / 1e6, "million samples/s", "NumPy GEMM", peer / 1e6),
        Figure("C1, of memory bandwidth", own * traffic / roof, "-"),
    ]


def _few_stiffnesses_vary(rows: int, seconds: float, roof: float) -> list[Figure]:
    bridge = box_bridge()
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    q = _draw(rows, len(bridge.loads["forces"]))
    factors = 1.0 + 0.5 * _draw(rows, len(ours.stiffness))
    stiffness = factors * ours.stiffness
    few = slice(0, min(rows, 64))
    plain = np.array([_plain(bridge, *sample) for sample in zip(q[few], factors[few], strict=True)])
    found = np.empty((rows, plain.shape[1]))
    _agree("C2", ours.respond(q[few], stiffness[few]), plain)
    _agree("NumPy Woodbury", woodbury(ours, q[few], stiffness[few]), plain)
    own = rows / _shortest(lambda: ours.respond(q, stiffness, 1, found), seconds)
    # Batches of this size suit NumPy best: its temporary arrays stay in the cache.
    part = slice(0, min(rows, 4096))
    of_part = len(q[part])
    others = of_part / _shortest(lambda: woodbury(ours, q[part], stiffness[part]), seconds)
    name, unit = "C2, ten stiffnesses vary", "million samples/s"
    return [_against(name, own / 1e6, unit, "NumPy Woodbury", others / 1e6)]


def _all_stiffnesses_vary(rows: int, seconds: float, roof: float) -> list[Figure]:
    bridge = box_bridge()
    ours = _core.Refactored(bridge.structure, bridge.loads, bridge.outputs)
    count = min(rows, 2048)
    q = _draw(count, len(bridge.loads["forces"]))
    terms = len(bridge.structure["ends"]) + len(bridge.structure["spring_stiffness"])
    factors = 1.0 + 0.5 * _draw(count, terms)
    few = slice(0, 16)
    plain = np.array([_plain_all(bridge, *one) for one in zip(q[few], factors[few], strict=True)])
    _agree("C3", ours.respond(factors[few], q[few]), plain)
    own = count / _shortest(lambda: ours.respond(factors, q), seconds)
    anew = _shortest(lambda: _plain_all(bridge, q[0], factors[0]), seconds)
    peer = "the structure anew for each"
    return [_against("C3, every stiffness varies", own, "samples/s", peer, 1.0 / anew)]


def _one_sample(rows: int, seconds: float, roof: float) -> list[Figure]:
    bridge = box_bridge()
    ours = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    many = 1024
    q, stiffness = _draw(many, len(bridge.loads["forces"])), np.tile(ours.stiffness, (many, 1))
    inside = _shortest(lambda: ours.respond(q, stiffness), seconds) / many
    alone = _shortest(lambda: ours.respond(q[:1], stiffness[:1]), seconds)
    return [Figure("one sample from Python, over the time inside", (alone - inside) * 1e6, "us")]


def _large_displacements(rows: int, seconds: float, roof: float) -> list[Figure]:
    bridge = box_bridge()
    q = 0.1 * _draw(64, len(bridge.loads["forces"]))
    arrays = bridge.structure, bridge.loads, bridge.outputs
    taken = _shortest(lambda: _core.respond_nonlinear(*arrays, q), seconds)
    return [Figure("C4, large displacements", len(q) / taken, "samples/s")]


def _whole_model(rows: int, seconds: float, roof: float) -> list[Figure]:
    """The case study through `Simulator.predict`: parameters of all effects, then the response."""
    model = Model.model_validate(case_study_bridge().model)
    simulator, many = Simulator(model), min(rows, 4096)
    ranges = {name: variable.range for name, variable in model.context.items()}
    contexts = {name: np.linspace(low, high, many) for name, (low, high) in ranges.items()}
    one = {name: column[:1] for name, column in contexts.items()}
    alone = _shortest(lambda: simulator.predict(one), seconds)
    together = _shortest(lambda: simulator.predict(contexts), seconds)
    return [
        Figure("case study, one row", alone * 1e6, "us"),
        Figure(f"case study, a row of {many}", together / many * 1e6, "us"),
    ]


def _derivatives(rows: int, seconds: float, roof: float) -> list[Figure]:
    """84 sensors by 8 contexts: loads in six of them, and ten stiffnesses in two."""
    bridge = box_bridge(sensors=SENSORS)
    few = Condensation(
        bridge.structure, bridge.loads, bridge.outputs, bridge.members, bridge.springs
    )
    varied = np.concatenate([bridge.members, bridge.springs])
    every = Factorisation(
        bridge.structure,
        bridge.loads,
        bridge.outputs,
        bridge.members,
        bridge.springs,
        few.stiffness,
    )
    count = min(rows, 4096)
    q = _draw(count, len(bridge.loads["forces"]))
    stiffness = (1.0 + 0.5 * _draw(count, len(varied))) * few.stiffness
    rates = np.zeros((count, q.shape[1], DIRECTIONS))
    of_terms = np.zeros((count, len(varied), DIRECTIONS))
    for direction in range(6):
        rates[:, 2 * direction : 2 * direction + 2, direction] = 1.0
    of_terms[:, : len(bridge.members), 6] = few.stiffness[: len(bridge.members)]
    of_terms[:, len(bridge.members) :, 7] = few.stiffness[len(bridge.members) :]
    figures = []
    for name, path, size in (("C2", few, count), ("C3", every, 256)):
        given = (q[:size], stiffness[:size])
        along = (rates[:size], of_terms[:size])
        checked = _check_derivatives(path, q[:16], stiffness[:16], rates[:16], of_terms[:16])
        gradients = np.tile(checked, (size // 16, 1))
        sample = _shortest(partial(path.respond, *given), seconds)
        whole = _shortest(partial(path.differentiate, *given, *along), seconds)
        back = _shortest(partial(path.pull_back, *given, gradients), seconds)
        figures += [
            Figure(f"{name}, Jacobian of {SENSORS} by {DIRECTIONS}", whole / sample, "samples"),
            Figure(f"{name}, gradient of all by the adjoint", back / sample, "samples"),
        ]
    return figures


def _check_derivatives(
    path: Condensation | Factorisation,
    q: FloatArray,
    stiffness: FloatArray,
    rates: FloatArray,
    of_terms: FloatArray,
) -> FloatArray:
    """Both derivatives against differences; gradients for the adjoint, float[rows, sensors]."""
    found = path.differentiate(q, stiffness, rates, of_terms)
    ahead, behind = (
        np.stack(
            [
                path.respond(
                    np.ascontiguousarray(q + step * rates[:, :, k]),
                    stiffness + step * of_terms[:, :, k],
                )
                for k in range(DIRECTIONS)
            ],
            axis=2,
        )
        for step in (1e-4, -1e-4)
    )
    _agree("Jacobian", found, (ahead - behind) / 2e-4, 1e-7)
    gradients = _draw(len(q), SENSORS)
    pulled = path.pull_back(q, stiffness, gradients)
    both = np.concatenate([rates, of_terms], axis=1)
    back = np.einsum("tp,tpc->tc", pulled, both)
    _agree("adjoint", back, np.einsum("ts,tsc->tc", gradients, found))
    return gradients


def _data_set(rows: int, seconds: float, roof: float) -> list[Figure]:
    samples = DATA_SET if rows == ROWS else DATA_SET // 100
    memory, taken = data_set_cost(samples)
    return [
        Figure(f"data set of {samples / 1e6:g} million rows, memory", memory, "MiB"),
        Figure("data set, written", samples / taken / 1e6, "million rows/s"),
    ]


def woodbury(ours: Condensation, q: FloatArray, stiffness: FloatArray) -> FloatArray:
    """The condensation in NumPy, as one would write it: a batch of small solves."""
    change = stiffness - ours.stiffness
    matrix = np.eye(len(ours.unit)) + ours.unit * change[:, None, :]
    stretch = np.linalg.solve(matrix, (q @ ours.stretched)[:, :, None])[:, :, 0]
    return np.asarray(q @ ours.loaded - (change * stretch) @ ours.influence)


def _plain(bridge: Bridge, q: FloatArray, factors: FloatArray) -> FloatArray:
    whole = np.ones(len(bridge.structure["ends"]) + len(bridge.springs))
    whole[bridge.members] = factors[: len(bridge.members)]
    whole[len(bridge.structure["ends"]) + bridge.springs] = factors[len(bridge.members) :]
    return _plain_all(bridge, q, whole)


def _plain_all(bridge: Bridge, q: FloatArray, factors: FloatArray) -> FloatArray:
    """The structure built anew and solved for one sample."""
    structure: Arrays = dict(bridge.structure)
    count = len(structure["ends"])
    structure["A"] = structure["A"] * factors[:count]
    structure["spring_stiffness"] = structure["spring_stiffness"] * factors[count:]
    loads = dict(bridge.loads)
    for name in ("forces", "strain", "prescribed", "prescribed_inclined"):
        loads[name] = np.tensordot(q, loads[name], 1)[None]
    return np.asarray(_core.respond(structure, loads, bridge.outputs)[0])


def _draw(rows: int, columns: int) -> FloatArray:
    return np.random.default_rng(columns).uniform(-1.0, 1.0, (rows, columns))


def _against(name: str, value: float, unit: str, peer: str, of_peer: float) -> Figure:
    return Figure(name, value, unit, peer, of_peer, value / of_peer)


def _agree(name: str, one: FloatArray, other: FloatArray, within: float = AGREEMENT) -> None:
    off = float(np.abs(one - other).max() / np.abs(other).max())
    if not off <= within:
        raise ArithmeticError(f"{name} is off by {off:.1e} of the largest output")


def _shortest(task: Callable[[], object], seconds: float) -> float:
    """Shortest time of a task [s], over the seconds given and five runs at least."""
    times: list[float] = []
    task()
    while sum(times) < seconds or len(times) < 5:
        begin = time.perf_counter()
        task()
        times.append(time.perf_counter() - begin)
    return min(times)


def _bandwidth(rows: int, seconds: float) -> float:
    """Bytes read and written by a copy between arrays beyond the caches [1/s]."""
    source = np.ones(max(rows, ROWS // 4) * 64)
    target = np.empty_like(source)
    return 2 * source.nbytes / _shortest(lambda: np.copyto(target, source), seconds)


def _processor() -> str:
    told = Path("/proc/cpuinfo")
    if told.exists():
        for line in told.read_text(encoding="utf-8").splitlines():
            if line.startswith("model name"):
                return line.split(":", 1)[1].strip()
    return platform.processor() or platform.machine()
