"""The data-driven model: training, accuracy, intervals, and the bits of it."""

import dataclasses
from typing import Any

import numpy as np
import pytest
import torch
from scipy.stats import norm

from crossed_truss import LATENT, crossed_truss, noise_of
from rga.errors import InputError
from rga.inference import ContextNetwork, Samples, TrainingSettings, Variables, train
from rga.inference.laws.over_time import follow_law
from rga.inference.map.laplace import covering_factor, laplace_spread
from rga.inference.networks.design_samples import Design, design
from rga.inference.networks.surrogate import pretrain
from rga.model.schema import Model
from rga.simulation import Simulator

SETTINGS = TrainingSettings(
    steps=600, learning_rate=6e-3, reduced_steps=400, fine_steps=60, width=32, features=12
)
FEW = SETTINGS.model_copy(update={"steps": 30, "reduced_steps": 30, "fine_steps": 20})


@pytest.fixture(scope="module")
def truss() -> Model:
    return crossed_truss(both_ways=True)


@pytest.fixture(scope="module")
def forwards() -> Model:
    return crossed_truss(both_ways=False)


def noisy(drawn: Design, model: Model, seed: int) -> Samples:
    """The design as sensors would have recorded it; latent contexts kept for judging."""
    rows = drawn.samples(Variables.of(model, LATENT))
    rng, noise = np.random.default_rng(seed), noise_of(model)
    readings = rows.readings + noise[:-1] * rng.standard_normal(rows.readings.shape)
    measured = rows.measured + noise[-1:] * rng.standard_normal(rows.measured.shape)
    return Samples(readings, measured, rows.latent)


def learn(
    model: Model, settings: TrainingSettings = FEW, rows: int = 512, **more: Any
) -> ContextNetwork:
    variables = Variables.of(model, LATENT)
    source = design(model, rows, latent=LATENT, seed=1).samples(variables)
    target = noisy(design(model, 60, latent=LATENT, seed=2), model, 2)
    return train(
        source, target, settings, variables=variables, noise=noise_of(model),
        **{"seed": 3, **more},
    )  # fmt: skip


@pytest.fixture(scope="module")
def trained(forwards: Model) -> ContextNetwork:
    # The noise of these rows is known; readiness for gains and faults would cost accuracy.
    exact = SETTINGS.model_copy(update={"steps": 1000, "gain": 0.0, "faults": 0.0})
    return learn(forwards, exact, 2048)


def test_contexts_are_inferred_about_as_well_as_the_noise_allows(
    forwards: Model, trained: ContextNetwork
) -> None:
    drawn = design(forwards, 300, latent=LATENT, seed=9)
    rows = noisy(drawn, forwards, 9)
    variables = trained.variables
    found = trained.infer(rows.readings, rows.measured)
    spread = laplace_spread(
        Simulator(forwards), variables, rows.measured, rows.latent,
        np.isfinite(rows.readings), noise_of(forwards),
    )  # fmt: skip
    # In the middle: what is left of the shape of the influence lines weighs at their ends.
    error = np.quantile(np.abs(found - rows.latent), 0.68, axis=0)
    assert (error < 3 * np.median(spread, axis=0)).all()


def test_a_missing_and_a_broken_channel_are_survived(
    forwards: Model, trained: ContextNetwork
) -> None:
    rows = noisy(design(forwards, 200, latent=LATENT, seed=5), forwards, 5)
    width = trained.variables.width[trained.variables.latent_columns]

    def error(readings: np.ndarray) -> np.ndarray:
        found = trained.infer(readings, rows.measured)
        return np.median(np.abs(found - rows.latent), axis=0) / width

    missing, broken = rows.readings.copy(), rows.readings.copy()
    missing[:, 4], broken[:, 4] = np.nan, 1e5
    assert (error(missing) < 0.08).all()
    assert error(broken) == pytest.approx(error(missing), rel=1e-3)


def test_contexts_stay_where_the_training_looked(trained: ContextNetwork) -> None:
    """However far readings are from all that was simulated."""
    readings = np.random.default_rng(1).normal(0.0, 1e3, (200, len(trained.variables.sensors)))
    found = trained.infer(readings, np.zeros((200, 1)))
    low, high = np.transpose(trained.variables.ranges)[:, trained.variables.latent_columns]
    beyond = np.maximum(low - found, found - high) / (high - low)
    assert (beyond <= 0.25 + 1e-6).all()
    assert (beyond > 0.0).any()


def test_two_trainings_give_equal_bytes_for_any_number_of_threads(forwards: Model) -> None:
    threads = torch.get_num_threads()
    results = []
    try:
        for count in (1, 2):
            torch.set_num_threads(count)
            results.append(learn(forwards).to_bytes())
            assert torch.get_num_threads() == count
    finally:
        torch.set_num_threads(threads)
    assert results[0] == results[1]
    assert learn(forwards, seed=4).to_bytes() != results[0]
    assert not torch.are_deterministic_algorithms_enabled()


def test_bytes_bring_back_the_same_network(forwards: Model, trained: ContextNetwork) -> None:
    again = ContextNetwork.from_bytes(trained.to_bytes())
    rows = noisy(design(forwards, 50, latent=LATENT, seed=6), forwards, 6)
    assert again.variables == trained.variables
    assert again.to_bytes() == trained.to_bytes()
    one, other = (n.infer(rows.readings, rows.measured) for n in (trained, again))
    assert one.tobytes() == other.tobytes()
    with pytest.raises(InputError, match="no context network"):
        ContextNetwork.from_bytes(trained.to_bytes()[:-3])


def test_the_reduced_simulator_stays_as_it_is(forwards: Model) -> None:
    variables = Variables.of(forwards, LATENT)
    source = design(forwards, 1024, latent=LATENT, seed=1).samples(variables)
    reduced = pretrain(
        source, variables, SETTINGS.model_copy(update={"reduced_steps": 1500}), seed=7
    )
    fresh = design(forwards, 256, latent=LATENT, seed=8)
    error = reduced(torch.from_numpy(fresh.contexts))[0].numpy() - fresh.readings
    moved = fresh.readings.std(axis=0) > 1e-6
    left = error.std(axis=0)[moved] / fresh.readings.std(axis=0)[moved]
    # The hangers under the path have kinks in their influence lines: hardest for a smooth network.
    assert left.max() < 0.2
    assert np.median(left) < 0.06

    before = {name: value.clone() for name, value in reduced.state_dict().items()}
    with_it = learn(forwards, physics=reduced)
    assert all(torch.equal(before[name], value) for name, value in reduced.state_dict().items())
    assert not reduced.training
    assert not any(weight.requires_grad for weight in reduced.parameters())
    # It did take part.
    alone = learn(forwards, FEW.model_copy(update={"physics": None}))
    assert with_it.to_bytes() != alone.to_bytes()


def test_exact_physics_and_fine_tuning(forwards: Model, trained: ContextNetwork) -> None:
    exact = FEW.model_copy(update={"physics": "exact", "gamma": 0.05})
    simulator = Simulator(forwards).as_torch()
    tuned = learn(forwards, exact, physics=simulator, start=trained)
    assert tuned.to_bytes() != trained.to_bytes()
    assert torch.equal(tuned.encoder.scale, trained.encoder.scale)
    assert torch.equal(tuned.encoder.rotation, trained.encoder.rotation)
    rows = noisy(design(forwards, 200, latent=LATENT, seed=5), forwards, 5)
    width = trained.variables.width[trained.variables.latent_columns]
    error = np.abs(tuned.infer(rows.readings, rows.measured) - rows.latent) / width
    assert (np.median(error, axis=0) < 0.05).all()
    with pytest.raises(InputError, match="as_torch"):
        learn(forwards, exact)


def test_intervals_cover(forwards: Model, trained: ContextNetwork) -> None:
    simulator, noise = Simulator(forwards), noise_of(forwards)

    def judged(seed: int) -> tuple[np.ndarray, np.ndarray]:
        rows = noisy(design(forwards, 400, latent=LATENT, seed=seed), forwards, seed)
        found = trained.infer(rows.readings, rows.measured)
        spread = laplace_spread(
            simulator, trained.variables, rows.measured, found, np.isfinite(rows.readings), noise
        )
        return found - rows.latent, spread

    factor = covering_factor(*judged(20))
    error, spread = judged(21)
    covered = (np.abs(error) <= norm.ppf(0.95) * factor * spread).mean(axis=0)
    # Four standard deviations of both samples of 400.
    assert (np.abs(covered - 0.9) < 4 * np.sqrt(2 * 0.09 / 400)).all()
    with pytest.raises(InputError, match="too few"):
        covering_factor(error[:5], spread[:5])


def test_a_train_of_unknown_direction_is_followed(truss: Model) -> None:
    network = learn(truss, SETTINGS, 2048)
    assert network.ways == 2
    time = np.linspace(0.0, 8.0, 60)
    for cart in (1.0 + 1.2 * time, 11.0 - 1.2 * time):
        table = {"crowd": np.full(60, 6.0), "temperature": np.full(60, 10.0), "cart": cart}
        readings = Simulator(truss).predict(table)
        rng = np.random.default_rng(2)
        readings += noise_of(truss)[:-1] * rng.standard_normal(readings.shape)
        rows = network.candidates(readings, np.full((60, 1), 10.0))
        line, _ = follow_law(
            time, rows.value[:, :, 1], rows.spread[:, :, 1], truss.context["cart"], rows.share,
            rows.reversed,
        )  # fmt: skip
        assert np.abs(line - cart).max() < 0.6


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"readings": np.zeros((4, 2))}, "readings have the shape"),
        ({"latent": np.full((4, 2), np.nan)}, "not finite"),
        ({"latent": None}, "no rows with known contexts"),
    ],
)
def test_samples_that_do_not_fit_are_refused(
    forwards: Model, change: dict[str, Any], words: str
) -> None:
    variables = Variables.of(forwards, LATENT)
    sensors = len(variables.sensors)
    good = Samples(np.zeros((4, sensors)), np.zeros((4, 1)), np.zeros((4, 2)))
    bad = dataclasses.replace(good, **change)
    with pytest.raises(InputError, match=words):
        train(bad, good, FEW, variables=variables, noise=np.ones(sensors + 1), seed=1)
