"""The networks of the table, and the rule that chooses their settings without labels."""

import pickle
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from context_problems import lesson, with_rows
from rga.errors import InputError
from rga.inference import ContextNetwork, Rows, Samples, TrainingSettings
from rga.inference.networks.selection import WORSE, choose
from rga.model import read_model
from rga.simulation import Simulator
from rga.twin.calibration.estimator import ContextEstimator
from rga.twin.calibration.lesson import Lesson
from rga.twin.calibration.networks import NetworkEstimator
from rga_bench.contexts.data import ranges_of
from rga_bench.contexts.method import Estimate
from rga_bench.contexts.methods.networks import NETWORKS, trained
from rga_bench.contexts.rows import METHODS
from rga_bench.synthetic.bridges.full_case_study import full_case_study
from rga_bench.synthetic.physical_twin import PhysicalTwin

MODEL = read_model(full_case_study(), "case study")
SIMULATOR = Simulator(MODEL)
RANGES = ranges_of(MODEL)
NOISE = np.array([sensor.noise for sensor in MODEL.sensors.values()])
SHORT = {"steps": 250, "fine_steps": 60, "reduced_steps": 250, "width": 48}
FEW = {"steps": 40, "fine_steps": 10, "reduced_steps": 20, "width": 16}


def short(name: str, **changes: object) -> TrainingSettings:
    return NETWORKS[name].model_copy(update={**SHORT, **changes})


def drawn(seed: int, rows: int, twin: PhysicalTwin) -> Rows:
    """Measured rows."""
    rng = np.random.default_rng(seed)
    contexts = rng.uniform(*RANGES.T, (rows, len(RANGES)))
    return Rows(contexts, twin.read(contexts) + twin.noise(rng, rows))


def given(twin: PhysicalTwin) -> Lesson:
    """A lesson with 60 measured rows."""
    return replace(lesson(500, seed=5, real=drawn(6, 60, twin).readings), seed=3)


def again(lesson: Lesson, recent: np.ndarray) -> Lesson:
    """A lesson with further measured rows, float[n, sensors], that are new."""
    known = lesson.data.real
    return with_rows(lesson, np.concatenate([known, recent]), new=len(known))


def inferred(estimator: ContextEstimator, asked: Rows) -> Estimate:
    return Estimate.by(estimator, asked.readings, MODEL)


def error(value: np.ndarray, truth: np.ndarray) -> float:
    return float(np.mean(12.0 * ((value - truth) / np.ptp(RANGES, axis=1)) ** 2))


@pytest.fixture(scope="module")
def like() -> PhysicalTwin:
    """A physical twin that differs from the model by its noise alone."""
    return PhysicalTwin.draw(4, "noise only")


@pytest.fixture(scope="module")
def unlike() -> PhysicalTwin:
    return PhysicalTwin.draw(4, "all")


@pytest.mark.parametrize("name", NETWORKS)
def test_every_row_learns(like: PhysicalTwin, name: str) -> None:
    asked = drawn(8, 300, like)
    found = inferred(trained(short(name))(given(like)), asked)
    # The prior's mean has 1.0; where readings alone are fitted, what they hardly tell runs free.
    assert error(found.value, asked.contexts) < (0.85 if name == "residual network" else 0.4)
    assert found.spread is not None
    covered = np.mean(np.abs(found.value - asked.contexts) < 1.645 * found.spread)
    assert 0.8 < covered < 0.98


def test_rows_learn_and_are_refined_with_their_settings(
    like: PhysicalTwin, monkeypatch: pytest.MonkeyPatch
) -> None:
    known = []

    def learn(cls: Any, lesson: Lesson, start: Any = None) -> Any:
        known.append((lesson.training, len(lesson.data.real)))
        return object.__new__(cls)

    monkeypatch.setattr(NetworkEstimator, "learn", classmethod(learn))
    for name, settings in NETWORKS.items():
        known.clear()
        learned = METHODS[name].learn(given(like))
        refined = learned.refined(again(given(like), drawn(11, 30, like).readings))
        alone = name == "source only"
        assert known == ([(settings, 0)] if alone else [(settings, 60), (settings, 90)])
        assert (refined is learned) == alone


@pytest.mark.parametrize("name", NETWORKS)
def test_no_label_of_the_target_is_used(unlike: PhysicalTwin, name: str) -> None:
    learn, without = trained(short(name, **FEW)), given(unlike)
    first = learn(without)
    tests = drawn(7, 20, unlike)
    with_tests = replace(without, load_tests=tests)
    scrambled = replace(without, load_tests=replace(tests, contexts=tests.contexts[::-1]))
    recent = drawn(11, 30, unlike).readings
    for other in (with_tests, scrambled):
        learned = learn(other)
        assert learned.to_bytes() == first.to_bytes()
    tuned = [one.refined(again(without, recent)).to_bytes() for one in (first, learned)]
    assert tuned[0] == tuned[1]


@pytest.mark.thorough
def test_real_rows_are_used_where_they_may_be(unlike: PhysicalTwin) -> None:
    """The null of the test above: other rows give another network, but to the source alone."""
    lessons = given(unlike), with_rows(given(unlike), drawn(12, 60, unlike).readings)
    # Long enough for the network that does best to have learned from them.
    longer = {**FEW, "steps": 400, "width": 48}
    for name in NETWORKS:
        learn = trained(short(name, **longer))
        one, two = (learn(rows).to_bytes() for rows in lessons)
        assert (one == two) == (name == "source only")


def test_the_same_seed_gives_the_same_bits(unlike: PhysicalTwin) -> None:
    learn = trained(short("DANN + physics, exact simulator", **FEW))
    one, two = (learn(given(unlike)) for _ in range(2))
    assert one.to_bytes() == two.to_bytes()
    other = learn(replace(given(unlike), seed=4))
    assert other.to_bytes() != one.to_bytes()


def test_exact_physics_are_the_simulator_where_each_row_has_a_structure(
    unlike: PhysicalTwin,
) -> None:
    """Bearings and stiffness follow contexts here; the frozen network does not stand in."""
    frozen, exact = (
        trained(short(f"DANN + physics, {kind}", **FEW))(given(unlike))
        for kind in ("frozen network", "exact simulator")
    )
    assert frozen.to_bytes() != exact.to_bytes()


def test_physics_narrow_the_gap(unlike: PhysicalTwin) -> None:
    asked, simulation = drawn(9, 300, unlike), given(unlike).simulation

    def gap(name: str) -> float:
        found = inferred(trained(short(name, steps=400))(given(unlike)), asked).value
        simulated = simulation.readings(np.zeros(len(found)), found)
        return float(np.mean((asked.readings - simulated) ** 2))

    assert gap("DANN + physics, exact simulator") < 0.58 * gap("DANN")


def test_a_recalibration_forgets_nothing(like: PhysicalTwin) -> None:
    asked = drawn(8, 300, like)
    learned = trained(short("DANN + physics, exact simulator"))(given(like))
    drift = drawn(10, 60, like).readings + 5.0 * (np.arange(84) == 30)
    tuned = learned.refined(again(given(like), drift))
    before, after = (error(inferred(one, asked).value, asked.contexts) for one in (learned, tuned))
    assert after < 1.05 * before


def test_a_checkpoint_runs_no_code(like: PhysicalTwin) -> None:
    learned = trained(short("source only", **FEW))(given(like))
    content = learned.to_bytes().partition(b"\n")[2]
    network = ContextNetwork.from_bytes(content)
    assert network.to_bytes() == content

    class Bomb:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return (pytest.fail, ("the pickle was opened",))

    for bad in (pickle.dumps(Bomb()), pickle.dumps(network.variables), b""):
        with pytest.raises(InputError, match="hold no context network"):
            ContextNetwork.from_bytes(bad)


def samples(lesson: Lesson) -> tuple[Samples, Samples]:
    data = lesson.data
    return (
        Samples(data.readings, np.empty((500, 0)), data.contexts),
        Samples(data.real, np.empty((60, 0))),
    )


def test_a_harmful_weight_is_refused(unlike: PhysicalTwin) -> None:
    harmful = short("DANN", beta=0.001, alpha=50.0)
    sound = short("DANN + physics, exact simulator")
    trials = choose(
        [harmful, sound], *samples(given(unlike)), simulator=SIMULATOR, noise=NOISE, seed=1
    )  # fmt: skip
    assert trials[0].settings == sound
    assert trials[-1].settings == harmful
    alone = next(trial for trial in trials if trial.settings.alpha == 0)
    assert trials[-1].source_error > WORSE * alone.source_error
    assert trials[0].gap < alone.gap


def test_where_nothing_is_to_be_gained_little_is_lost(like: PhysicalTwin) -> None:
    """The null twin: there is no gap to close, and the choice is about as good as none."""
    candidates = [short("DANN", alpha=alpha) for alpha in (0.03, 3.0)]
    trials = choose(
        candidates, *samples(given(like)), simulator=SIMULATOR, noise=NOISE, seed=1
    )  # fmt: skip
    alone = next(trial for trial in trials if trial.settings.alpha == 0)
    assert trials[0].source_error <= WORSE * alone.source_error
    assert trials[0].gap <= alone.gap
    assert len(trials) == 3


def test_too_little_to_choose_from_is_refused(like: PhysicalTwin) -> None:
    source, target = samples(given(like))
    with pytest.raises(InputError, match="nothing to choose from"):
        choose([], source, target, simulator=SIMULATOR, noise=NOISE, seed=1)
    with pytest.raises(InputError, match="too few rows"):
        choose(
            [short("CORAL")], source, target.rows(slice(4)), simulator=SIMULATOR, noise=NOISE,
            seed=1,
        )  # fmt: skip
