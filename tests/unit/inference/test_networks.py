"""The data-driven model: networks, training, posterior, laws and designs."""

import dataclasses
from typing import Any

import numpy as np
import pytest
import torch
from scipy.stats import norm

from rga.errors import InputError
from rga.inference import ContextNetwork, Samples, TrainingSettings, Variables, train
from rga.inference.laws.over_time import follow_law
from rga.inference.laws.refine import polish_line
from rga.inference.map.laplace import covering_factor, laplace_spread
from rga.inference.networks.design_samples import Design, design
from rga.inference.networks.gradient_reversal import reverse_gradient
from rga.inference.networks.layers import Encoder
from rga.inference.networks.surrogate import pretrain
from rga.inference.networks.travel_direction import EitherWay
from rga.model import read_model
from rga.model.schema import ContextVariable, Model
from rga.simulation import Simulator

SETTINGS = TrainingSettings(
    steps=600, learning_rate=6e-3, reduced_steps=400, fine_steps=60, width=32, features=12
)
FEW = SETTINGS.model_copy(update={"steps": 30, "reduced_steps": 30, "fine_steps": 20})


@pytest.fixture(scope="module")
def truss() -> Model:
    """A truss of four panels under temperature (measured), a crowd and a cart."""
    bar = {"section": "bar", "material": "steel", "groups": ["all"]}
    low = {f"L{k}": [3.0 * k, 0, 0] for k in range(5)}
    high = {f"U{k}": [3.0 * k, 0, 2.5] for k in range(1, 4)}
    chords = [(f"L{k}", f"L{k + 1}") for k in range(4)] + [("U1", "U2"), ("U2", "U3")]
    web = [("L0", "U1"), ("U1", "L2"), ("L2", "U3"), ("U3", "L4"), *zip(
        ("L1", "L2", "L3"), ("U1", "U2", "U3"), strict=True)]  # fmt: skip
    members = {f"{i}-{j}": {"nodes": [i, j], **bar} for i, j in chords + web}
    strains = {
        f"S {name}": {"kind": "strain", "member": name, "unit": "microstrain", "noise": 2.0}
        for name in members
    }
    moved = {
        f"D {node}": {
            "kind": "displacement",
            "node": node,
            "direction": [0, 0, 1],
            "unit": "mm",
            "noise": 0.1,
        }
        for node in ("L1", "L2", "L3")
    }
    roller = {"node": "L4", "kind": "displacement", "direction": [1, 0, 0]}
    content = {
        "rga_model": 1,
        "name": "truss",
        "plane": "xz",
        "materials": {"steel": {"E": 2e11, "alpha": 1.2e-5}},
        "sections": {"bar": {"A": 0.002}},
        "nodes": {**low, **high},
        "members": members,
        "supports": {
            "west": {"node": "L0", "fixed": ["ux", "uz"]},
            "east": {"node": "L4", "fixed": ["uz"]},
        },
        "context": {
            "crowd": {"unit": "kN", "range": [0, 20]},
            "temperature": {"unit": "degC", "range": [-20, 40], "noise": 0.3},
            "cart": {"unit": "m", "range": [0.5, 11.5], "law": "linear", "rate": [-2, 2]},
        },
        "effects": {
            "warmth": {
                "kind": "temperature",
                "groups": {"all": 1.0},
                "delta": {"context": "temperature", "minus": 10.0},
            },
            "people": {
                "kind": "nodal_load",
                "forces": {f"L{k}": [0, 0, -1000] for k in range(1, 4)},
                "factor": {"context": "crowd"},
            },
            "axles": {
                "kind": "axle_load",
                "path": list(low),
                "forces": [60e3, 20e3],
                "offsets": [0.0, 1.5],
                "position": {"context": "cart"},
            },
        },
        "sensors": {**strains, **moved, "D end": {**roller, "unit": "mm", "noise": 0.1}},
    }
    return read_model(content, "test")


@pytest.fixture(scope="module")
def forwards(truss: Model) -> Model:
    """The truss with a cart that goes one way."""
    cart = truss.context["cart"].model_copy(update={"rate": (0.0, 2.0)})
    return truss.model_copy(update={"context": {**truss.context, "cart": cart}})


LATENT = ("crowd", "cart")


def noise_of(model: Model) -> np.ndarray:
    return np.array([*(s.noise or 0.0 for s in model.sensors.values()), 0.3])


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


def test_reversal_is_minus_the_gradient() -> None:
    features = torch.randn(4, 3, generator=torch.Generator().manual_seed(1), dtype=torch.float64)
    features.requires_grad_()
    forward = torch.autograd.grad(features.sin().sum(), features)[0]
    backward = torch.autograd.grad(reverse_gradient(features, 0.7).sin().sum(), features)[0]
    assert torch.allclose(backward, -0.7 * forward)
    assert torch.equal(reverse_gradient(features, 0.7), features)
    # Twice reversed is the plain gradient, which finite differences know.
    assert torch.autograd.gradcheck(
        lambda x: reverse_gradient(reverse_gradient(x, 1.0).sin(), 1.0), (features,)
    )


def test_a_channel_far_off_is_a_missing_channel() -> None:
    encoder = Encoder(3, 4, 2)
    rows = torch.tensor([[1.0, 2.0, 1e9], [1.0, 2.0, -torch.inf], [1.0, 2.0, torch.nan]])
    off, infinite, missing = encoder.standardise(rows)
    assert torch.allclose(off, missing, atol=1e-6)
    assert torch.equal(infinite, missing)
    assert torch.allclose(missing, torch.tensor([1.0, 2.0, 0.0, 0.0, 0.0, 1.0]), atol=1e-4)


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


def test_laplace_is_the_textbook_formula(forwards: Model) -> None:
    variables, noise = Variables.of(forwards, LATENT), noise_of(forwards)
    simulator = Simulator(forwards)
    measured, latent = np.array([[12.0]]), np.array([[8.0, 4.1]])
    seen = np.ones((1, len(variables.sensors)), dtype=bool)
    seen[0, 3] = False
    j = simulator.jacobian({"crowd": 8.0, "temperature": 12.0, "cart": 4.1})[0][seen[0]]
    s = np.diag(noise[:-1][seen[0]] ** 2) + np.outer(j[:, 1], j[:, 1]) * 0.3**2
    prior = np.diag(12 / np.array([20.0, 11.0]) ** 2)
    precision = j[:, [0, 2]].T @ np.linalg.solve(s, j[:, [0, 2]]) + prior
    wanted = np.sqrt(np.diag(np.linalg.inv(precision)))
    found = laplace_spread(simulator, variables, measured, latent, seen, noise)[0]
    assert found == pytest.approx(wanted, rel=1e-6)
    blind = laplace_spread(simulator, variables, measured, latent, np.zeros_like(seen), noise)[0]
    assert blind == pytest.approx(np.array([20.0, 11.0]) / np.sqrt(12))


LINE = ContextVariable(unit="m", range=(-100, 100), law="linear", rate=(-5, 5))


def crossing(seed: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]:
    """Time, estimates, spreads and the line: a third gross errors, a third that say nothing."""
    rng = np.random.default_rng(seed)
    time = np.arange(0.0, 60.0, 0.5)
    line = -30.0 + 1.7 * time
    spread = np.full(len(time), 0.5)
    estimate = line + spread * rng.standard_normal(len(time))
    kind = rng.integers(3, size=len(time))
    estimate[kind == 1] += 25.0
    estimate[kind == 2], spread[kind == 2] = 0.0, 200 / np.sqrt(12)
    return time, estimate, spread, line


@pytest.mark.parametrize("seed", range(4))
def test_a_line_is_found_among_gross_errors(seed: int) -> None:
    time, estimate, spread, line = crossing(seed)
    # Half of the good rows are pulled the same way only where they are a minority.
    estimate = np.where((estimate - line > 10) & (np.arange(len(time)) % 2 == 0), -70.0, estimate)
    value, doubt = follow_law(time, estimate, spread, LINE)
    assert np.abs(value - line).max() < 0.5
    assert (np.abs(value - line) < 5 * doubt).all()
    assert doubt.max() < 2.0


def test_a_line_through_candidates_keeps_to_its_direction() -> None:
    time = np.linspace(0, 20, 80)
    rising, falling = -40 + 3 * time, 35 - 3 * time
    candidates = np.column_stack([rising, rising - 45.0, falling])
    shares = np.tile([0.3, 0.5, 0.2], (len(time), 1))
    spreads = np.full_like(candidates, 0.4)
    backwards = np.array([False, True, False])
    value, _ = follow_law(time, candidates, spreads, LINE, shares, backwards)
    assert np.abs(value - rising).max() < 0.5
    value, _ = follow_law(time, candidates, spreads, LINE, shares, ~backwards)
    assert np.abs(value - falling).max() < 0.5 or np.abs(value - rising + 45).max() < 0.5


def test_the_rate_is_bounded() -> None:
    time = np.linspace(0, 10, 50)
    value, _ = follow_law(time, 9.0 * time - 45, np.full(50, 0.3), LINE)
    assert np.diff(value) / np.diff(time) == pytest.approx(np.full(49, 5.0))


def test_nothing_known_leaves_the_prior() -> None:
    time, blind = np.arange(5.0), np.full(5, 200 / np.sqrt(12))
    for law in ("constant", "smooth"):
        variable = LINE.model_copy(update={"law": law})
        value, spread = follow_law(time, np.full(5, 40.0), blind, variable)
        assert value == pytest.approx(np.zeros(5))
        assert spread == pytest.approx(blind)


def test_a_line_is_polished_though_the_model_is_wrong() -> None:
    """Sensors that are off by 10 % for as long as the load is there; a start in another valley."""
    time = np.linspace(0.0, 40.0, 200)
    places = np.linspace(3.0, 37.0, 12)
    wagons = np.arange(0.0, 30.0, 6.0)

    def influence(position: Any) -> Any:
        axles = np.asarray(position)[:, None, None] - wagons
        return 100 * np.exp(-(((axles - places[:, None]) / 3.0) ** 2)).sum(2)

    covered = []
    for seed in range(40):
        draw = np.random.default_rng(seed)
        truth = -20.0 + 2.0 * time
        seen = influence(truth) * (1 + 0.1 * draw.standard_normal(12))
        seen += draw.standard_normal(seen.shape)
        start = truth + draw.uniform(-6, 6) + draw.uniform(-0.2, 0.2) * (time - 20)
        found, covariance = polish_line(
            influence, seen, np.ones(12), time, start, (-200.0, 200.0), (-5.0, 5.0)
        )
        off = (found - [truth.mean(), 2.0]) / np.sqrt(np.diag(covariance))
        assert abs(found[0] - truth.mean()) < 1.0
        covered.append(np.abs(off) < norm.ppf(0.95))
    assert (np.mean(covered, axis=0) >= 0.75).all()


def test_weak_estimates_of_a_constant_add_up() -> None:
    # Each row holds the prior: the mean of the rows alone would be drawn to the middle.
    rng = np.random.default_rng(3)
    truth, noise, prior = 60.0, 80.0, 200**2 / 12
    seen = truth + noise * rng.standard_normal(4000)
    spread = (1 / noise**2 + 1 / prior) ** -0.5
    rows = seen * spread**2 / noise**2
    constant = LINE.model_copy(update={"law": "constant"})
    value, doubt = follow_law(np.arange(4000.0), rows, np.full(4000, spread), constant)
    assert abs(rows.mean() - truth) > 20
    assert abs(value[0] - truth) < 4 * noise / np.sqrt(4000) + 1
    assert doubt[0] < 5


def test_smooth_follows_and_weighs() -> None:
    rng = np.random.default_rng(5)
    smooth = ContextVariable(unit="K", range=(-20, 20), law="smooth")
    time = np.arange(300.0)
    truth = np.cumsum(0.15 * rng.standard_normal(300))
    rows = truth + rng.standard_normal(300)
    rows[100:110] = np.nan
    value, spread = follow_law(time, rows, np.ones(300), smooth)
    error = value - truth
    assert np.sqrt(np.mean(error**2)) < 0.5
    assert 0.6 < np.mean(np.abs(error) < 1.645 * spread) <= 1.0
    assert spread[105] > 1.1 * spread[150]
    still, _ = follow_law(time, 3 + rng.standard_normal(300), np.ones(300), smooth)
    assert np.ptp(still) < 1.0


def test_a_design_holds_both_directions(truss: Model, forwards: Model) -> None:
    drawn = design(truss, 64, latent=LATENT, seed=1, box={"crowd": (5.0, 6.0)})
    assert drawn.reversed.sum() == 32
    crowd, _, cart = drawn.contexts.T
    assert crowd.min() >= 5
    assert crowd.max() <= 6
    simulator = Simulator(truss)
    for chosen, sign in ((~drawn.reversed, 1), (drawn.reversed, -1)):
        order = np.flatnonzero(chosen)[np.argsort(sign * cart[chosen])]
        table = dict(zip(truss.context, drawn.contexts[order].T, strict=True))
        assert np.array_equal(drawn.readings[order], simulator.predict(table))
    again = design(truss, 64, latent=LATENT, seed=1, box={"crowd": (5.0, 6.0)})
    assert again.readings.tobytes() == drawn.readings.tobytes()
    for model, latent in ((forwards, LATENT), (truss, ("crowd",))):
        assert not design(model, 64, latent=latent, seed=1).reversed.any()
    with pytest.raises(InputError, match="no context 'snow'"):
        design(truss, 64, latent=LATENT, seed=1, box={"snow": (0.0, 1.0)})


def test_either_way_does_not_hang_on_the_order_of_rows(truss: Model) -> None:
    drawn = design(truss, 64, latent=LATENT, seed=1)
    both = EitherWay(Simulator(truss).as_torch(), 2)(torch.from_numpy(drawn.contexts)).numpy()
    found = np.where(drawn.reversed[:, None], both[1], both[0])
    assert np.allclose(found, drawn.readings, atol=1e-9)
    assert not np.allclose(both[0], both[1])


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
