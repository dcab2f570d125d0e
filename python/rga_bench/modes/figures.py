"""What is measured of modes."""

from collections.abc import Callable
from functools import partial
from itertools import product

import numpy as np

from rga import _core
from rga.arrays import FloatArray, IntArray
from rga_bench.installed import present
from rga_bench.measurement import Measurement
from rga_bench.modes.peers import ArpackOnCholmod, Dense, ShiftInvert, hertz
from rga_bench.modes.setting import ModesSetting
from rga_bench.modes.swinging import Swinging
from rga_bench.solver.agreement import agree
from rga_bench.solver.box_bridge import OF_MEMBERS, OF_SPRINGS, box_bridge
from rga_bench.solver.double_layer_grid import double_layer_grid
from rga_bench.solver.peers.cholmod import MODES, ORDERINGS
from rga_bench.timing import shortest

MODES_WANTED, OF_GRID = 8, 20
#: samples that are timed where they are solved one by one: a turn takes about as long as one of all
#: side by side, and other work on the machine disturbs both alike
ONE_BY_ONE = 16
#: of frequencies, relative
AGREEMENT = 1e-9
#: members whose stiffness varies where few do
FEW = 8
#: times as fast as ARPACK on CHOLMOD: where all stiffnesses vary, where few do, one structure at a
#: time, and on the grid
LEAST_ALL, LEAST_FEW, LEAST_ALONE, LEAST_GRID = 8.0, 30.0, 1.0, 1.0
#: a sample over the derivatives
LEAST_DERIVATIVES = 1 / 1.3
Frequencies = Callable[[FloatArray], FloatArray]


def all_vary(setting: ModesSetting) -> list[Measurement]:
    """Frequencies of a bridge of 84 nodes whose stiffnesses all vary."""
    swinging = Swinging.of(box_bridge(setting.seed))
    members, springs = _counts(swinging)
    draw = np.random.default_rng(setting.seed)
    factors = np.hstack(
        [
            draw.uniform(*OF_MEMBERS, (setting.samples, members)),
            draw.uniform(*OF_SPRINGS, (setting.samples, springs)),
        ]
    )
    case = f"84 nodes, {members} members, {MODES_WANTED} modes, every stiffness varies"
    every = np.arange(members + springs)
    return [
        *_rates(case, swinging, factors, every, LEAST_ALL, setting),
        *_derivatives(case, swinging, setting),
    ]


def few_vary(setting: ModesSetting) -> list[Measurement]:
    """The same where eight members and two springs vary."""
    swinging = Swinging.of(box_bridge(setting.seed))
    members, springs = _counts(swinging)
    draw = np.random.default_rng(setting.seed)
    factors = np.ones((setting.samples, members + springs))
    varied = draw.choice(members, FEW, replace=False)
    factors[:, varied] = draw.uniform(*OF_MEMBERS, (setting.samples, FEW))
    factors[:, members:] = draw.uniform(*OF_SPRINGS, (setting.samples, springs))
    case = f"the same, {FEW} members and {springs} springs vary"
    few = np.append(varied, members + np.arange(springs))
    return _rates(case, swinging, factors, few, LEAST_FEW, setting)


def grid(setting: ModesSetting) -> list[Measurement]:
    """Modes of a large roof, from the structure on."""
    swinging = Swinging.of(double_layer_grid(setting.panels, setting.seed))
    factors = np.ones(sum(_counts(swinging)))

    def ours() -> FloatArray:
        return hertz(_core.modes(swinging.truss.structure, swinging.masses, OF_GRID)[0])

    settings = [("supernodal", one) for one in ("amd", "metis", "default")]
    kept = _fastest(swinging, OF_GRID, settings, factors, setting)
    case = f"double-layer grid, {swinging.system.size} DOFs, {OF_GRID} modes"
    peer = "ARPACK on CHOLMOD"
    if kept is None:
        (own,) = shortest([ours], setting.seconds, 2)
        return [Measurement(case, "from the structure on", own, "s").beside(peer, None)]
    chosen, _ = kept

    def theirs() -> FloatArray:
        return ArpackOnCholmod(swinging, OF_GRID, chosen).frequencies(factors)

    apart = agree("the grid", theirs(), ours(), AGREEMENT)
    own, their = shortest([ours, theirs], setting.seconds, 2)
    known_as = f"{peer} ({', '.join(chosen)})"
    figure = Measurement(case, "from the structure on", own, "s")
    return [
        figure.beside(known_as, their, LEAST_GRID),
        Measurement(case, "frequencies apart, relative", apart),
    ]


def _counts(swinging: Swinging) -> tuple[int, int]:
    structure = swinging.truss.structure
    return len(structure["ends"]), len(structure["spring_stiffness"])


def _rates(
    case: str,
    swinging: Swinging,
    factors: FloatArray,
    varied: IntArray,
    least: float,
    setting: ModesSetting,
) -> list[Measurement]:
    """Samples a second, side by side and one by one, beside each peer, after all agree."""
    structure, masses, nowhere = swinging.truss.structure, swinging.masses, np.zeros(0, np.int64)
    batch = _core.ModalBatch(structure, masses, varied, MODES_WANTED, nowhere)
    near = _core.ModalReanalysis(structure, masses, MODES_WANTED)
    given = np.ascontiguousarray(factors[:, varied])

    def together(samples: FloatArray) -> FloatArray:
        return np.asarray(np.sqrt(batch.modes(samples)[0]) / (2 * np.pi))

    def alone(sample: FloatArray) -> FloatArray:
        return hertz(near.modes(swinging.structure(sample), masses, MODES_WANTED)[0])

    settings = list(product(MODES, ORDERINGS))
    kept = _fastest(swinging, MODES_WANTED, settings, factors[0], setting)
    peers: dict[str, Frequencies | None] = {
        "ARPACK on CHOLMOD": None,
        "eigsh, shift-invert": ShiftInvert(swinging, MODES_WANTED).frequencies,
        "eigh, dense": Dense(swinging, MODES_WANTED).frequencies,
    }
    if kept is not None:
        peers["ARPACK on CHOLMOD"] = kept[1]
    one_by_one = [alone, *(one for one in peers.values() if one is not None)]
    found = [together(given), *(np.array([one(s) for s in factors]) for one in one_by_one)]
    apart = max(agree(case, one, found[-1], AGREEMENT) for one in found[:-1])
    tasks: list[Callable[[], object]] = [partial(together, given)]
    tasks += [partial(_each, one, factors[:ONE_BY_ONE]) for one in one_by_one]
    taken = shortest(tasks, setting.seconds * len(tasks))
    rows = [len(factors), *(min(len(factors), ONE_BY_ONE) for _ in one_by_one)]
    each = (count / one for count, one in zip(rows, taken, strict=True))
    rates = dict(zip([together, *one_by_one], each, strict=True))
    ours = (("samples", together, least), ("samples, one at a time", alone, LEAST_ALONE))
    figures = [
        Measurement(case, what, rates[own], "/s").beside(
            name, None if one is None else rates[one], at_least if "CHOLMOD" in name else None
        )
        for what, own, at_least in ours
        for name, one in peers.items()
    ]
    return [*figures, Measurement(case, "frequencies apart, relative", apart)]


def _derivatives(case: str, swinging: Swinging, setting: ModesSetting) -> list[Measurement]:
    """Derivatives of all frequencies by all stiffnesses and masses, over a sample."""
    structure, masses = swinging.truss.structure, swinging.masses
    near = _core.ModalReanalysis(structure, masses, MODES_WANTED)
    shapes = near.modes(structure, masses, MODES_WANTED)[1]
    tasks: list[Callable[[], object]] = [
        partial(_core.modal_energies, structure, masses, shapes),
        partial(near.modes, structure, masses, MODES_WANTED),
    ]
    own, sample = shortest(tasks, setting.seconds)
    name = "derivatives by all stiffnesses and masses"
    figure = Measurement(case, name, own, "s")
    return [figure.beside("a sample", sample, LEAST_DERIVATIVES)]


def _each(frequencies: Frequencies, factors: FloatArray) -> None:
    for sample in factors:
        frequencies(sample)


def _fastest(
    swinging: Swinging,
    count: int,
    settings: list[tuple[str, str]],
    factors: FloatArray,
    setting: ModesSetting,
) -> tuple[tuple[str, str], Frequencies] | None:
    """Mode and ordering in which ARPACK on CHOLMOD is fastest; None where it is not installed."""
    trials = [present(partial(ArpackOnCholmod, swinging, count, one)) for one in settings]
    known = [one for one in trials if one is not None]
    if not known:
        return None
    taken = shortest([partial(one.frequencies, factors) for one in known], setting.seconds, 2)
    best = int(np.argmin(taken))
    return settings[best], known[best].frequencies
