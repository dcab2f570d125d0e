"""The networks of the table, and the rule that chooses their settings without labels."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from rga.errors import InputError
from rga.inference import ContextNetwork, Samples, TrainingSettings
from rga.inference.networks.design_samples import design
from rga.inference.networks.selection import WORSE, choose
from rga.model import read_model
from rga.simulation import Simulator
from rga_bench.contexts.method import LearningProblem, Rows
from rga_bench.contexts.methods import networks
from rga_bench.contexts.methods.networks import NETWORKS, LearnedNetwork, learn
from rga_bench.synthetic.bridges.full_case_study import full_case_study
from rga_bench.synthetic.physical_twin import PhysicalTwin

MODEL = read_model(full_case_study(), "case study")
SIMULATOR = Simulator(MODEL)
RANGES = np.array([variable.range for variable in MODEL.context.values()])
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


def problem(twin: PhysicalTwin, *, load_tests: Rows | None = None) -> LearningProblem:
    source = design(MODEL, 500, latent=tuple(MODEL.context), seed=5)
    none = Rows(np.empty((0, len(RANGES))), np.empty((0, len(NOISE))))
    return LearningProblem(
        model=MODEL, simulator=SIMULATOR, noise=NOISE,
        source=Rows(source.contexts, source.readings),
        real=drawn(6, 60, twin).readings, load_tests=load_tests or none, seed=3,
    )  # fmt: skip


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
    found = learn(short(name), problem(like)).infer(asked.readings)
    # The prior's mean has 1.0; where readings alone are fitted, what they hardly tell runs free.
    assert error(found.value, asked.contexts) < (0.85 if name == "residual_network" else 0.4)
    assert found.spread is not None
    covered = np.mean(np.abs(found.value - asked.contexts) < 1.645 * found.spread)
    assert 0.8 < covered < 0.98


def test_rows_are_methods(like: PhysicalTwin) -> None:
    for name in NETWORKS:
        assert getattr(networks, name).args == (NETWORKS[name],)
    given = problem(like)
    learned = learn(short("source_only", **FEW), given)
    middle = RANGES.mean(axis=1)[None]
    assert np.array_equal(learned.simulate(middle), given.simulate(middle))


@pytest.mark.parametrize("name", NETWORKS)
def test_no_label_of_the_target_is_used(unlike: PhysicalTwin, name: str) -> None:
    settings = short(name, **FEW)
    without = problem(unlike)
    first = learn(settings, without)
    tests = drawn(7, 20, unlike)
    with_tests = problem(unlike, load_tests=tests)
    scrambled = problem(unlike, load_tests=replace(tests, contexts=tests.contexts[::-1]))
    recent = drawn(11, 30, unlike).readings
    for other in (with_tests, scrambled):
        again = learn(settings, other)
        assert again.network.to_bytes() == first.network.to_bytes()
        assert np.array_equal(again.factor, first.factor)
    tuned = [learned.recalibrated(recent).network.to_bytes() for learned in (first, again)]
    assert tuned[0] == tuned[1]


def test_real_rows_are_used_where_they_may_be(unlike: PhysicalTwin) -> None:
    """The null of the test above: other rows give another network, but to the source alone."""
    given = problem(unlike)
    other = replace(given, real=drawn(12, 60, unlike).readings)
    for name in NETWORKS:
        one, two = (
            learn(short(name, **{**FEW, "steps": 120}), rows).network.to_bytes()
            for rows in (given, other)
        )  # fmt: skip
        assert (one == two) == (name == "source_only")


def test_the_same_seed_gives_the_same_bits(unlike: PhysicalTwin) -> None:
    given, settings = problem(unlike), short("adversarial_exact_physics", **FEW)
    one, two = (learn(settings, given) for _ in range(2))
    assert one.network.to_bytes() == two.network.to_bytes()
    assert np.array_equal(one.factor, two.factor)
    other = learn(settings, replace(given, seed=4))
    assert other.network.to_bytes() != one.network.to_bytes()


def test_physics_narrow_the_gap(unlike: PhysicalTwin) -> None:
    given, asked = problem(unlike), drawn(9, 300, unlike)

    def gap(name: str) -> float:
        found = learn(short(name, steps=400), given).infer(asked.readings).value
        return float(np.mean((asked.readings - given.simulate(found)) ** 2))

    assert gap("adversarial_exact_physics") < 0.58 * gap("adversarial")


def test_a_recalibration_forgets_nothing(like: PhysicalTwin) -> None:
    asked = drawn(8, 300, like)
    learned = learn(short("adversarial_exact_physics"), problem(like))
    drift = drawn(10, 60, like).readings + 5.0 * (np.arange(84) == 30)
    tuned = learned.recalibrated(drift)
    assert isinstance(tuned, LearnedNetwork)
    assert len(tuned.problem.real) == 120
    before, after = (
        error(one.infer(asked.readings).value, asked.contexts) for one in (learned, tuned)
    )
    assert after < 1.05 * before


def test_a_checkpoint_runs_no_code(like: PhysicalTwin) -> None:
    learned = learn(short("source_only", **FEW), problem(like))
    content = learned.network.to_bytes()
    assert ContextNetwork.from_bytes(content).to_bytes() == content

    class Bomb:
        def __reduce__(self) -> tuple[object, tuple[str]]:
            return (pytest.fail, ("the pickle was opened",))

    for bad in (pickle.dumps(Bomb()), pickle.dumps(learned.network.variables), b""):
        with pytest.raises(InputError, match="hold no context network"):
            ContextNetwork.from_bytes(bad)


def samples(given: LearningProblem) -> tuple[Samples, Samples]:
    return (
        Samples(given.source.readings, np.empty((500, 0)), given.source.contexts),
        Samples(given.real, np.empty((60, 0))),
    )


def test_a_harmful_weight_is_refused(unlike: PhysicalTwin) -> None:
    harmful = short("adversarial", beta=0.001, alpha=50.0)
    sound = short("adversarial_exact_physics")
    trials = choose(
        [harmful, sound], *samples(problem(unlike)), simulator=SIMULATOR, noise=NOISE, seed=1
    )  # fmt: skip
    assert trials[0].settings == sound
    assert trials[-1].settings == harmful
    alone = next(trial for trial in trials if trial.settings.alpha == 0)
    assert trials[-1].source_error > WORSE * alone.source_error
    assert trials[0].gap < alone.gap


def test_where_nothing_is_to_be_gained_little_is_lost(like: PhysicalTwin) -> None:
    """The null twin: there is no gap to close, and the choice is about as good as none."""
    candidates = [short("adversarial", alpha=alpha) for alpha in (0.03, 3.0)]
    trials = choose(
        candidates, *samples(problem(like)), simulator=SIMULATOR, noise=NOISE, seed=1
    )  # fmt: skip
    alone = next(trial for trial in trials if trial.settings.alpha == 0)
    assert trials[0].source_error <= WORSE * alone.source_error
    assert trials[0].gap <= alone.gap
    assert len(trials) == 3


def test_too_little_to_choose_from_is_refused(like: PhysicalTwin) -> None:
    source, target = samples(problem(like))
    with pytest.raises(InputError, match="nothing to choose from"):
        choose([], source, target, simulator=SIMULATOR, noise=NOISE, seed=1)
    with pytest.raises(InputError, match="too few rows"):
        choose(
            [short("coral")], source, target.rows(slice(4)), simulator=SIMULATOR, noise=NOISE,
            seed=1,
        )  # fmt: skip
