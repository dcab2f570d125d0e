"""The stream of the case study: its bridge, its drift, what is hidden and what can be seen."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from rga.records import load_record
from rga_bench.synthetic import draw_stream
from rga_bench.synthetic.bridges.case_study import case_study_bridge
from rga_bench.synthetic.gauges import observe
from rga_bench.synthetic.hidden.observability import Sight
from rga_bench.synthetic.hidden.score import d_prime
from rga_bench.synthetic.physics.world import World


@pytest.fixture(scope="module")
def model(tmp_path_factory: pytest.TempPathFactory) -> Any:
    path = tmp_path_factory.mktemp("bridge") / "model.json"
    path.write_text(json.dumps(case_study_bridge().model))
    return rga.load_model(path)


def anywhere(model: Any, rows: int) -> dict[str, np.ndarray]:
    rng = np.random.default_rng(3)
    return {name: rng.uniform(*variable.range, rows) for name, variable in model.context.items()}


def test_bridge_is_that_of_the_case_study(model: Any) -> None:
    points = np.array(list(model.nodes.values()))
    assert np.ptp(points, axis=0) == pytest.approx([46.0, 3.0, 2.6])
    assert sum(name.startswith("north") for name in model.sensors) == 21
    assert sum(name.startswith("south") for name in model.sensors) == 21


def test_truth_and_simulator_agree_where_nothing_is_hidden(model: Any) -> None:
    contexts = anywhere(model, 40)
    world = World.of(case_study_bridge().model)
    truth = observe(world, contexts, np.arange(40.0))
    assert rga.Simulator(model).predict(contexts) == pytest.approx(truth, rel=1e-7, abs=1e-7)


def test_latent_contexts_show_on_the_sensors(model: Any) -> None:
    """Laplace posteriors of a single row are far narrower than the ranges."""
    contexts = anywhere(model, 60)
    contexts["crowd"] = np.maximum(contexts["crowd"], 1.0)
    jacobian = rga.Simulator(model).jacobian(contexts)
    noise = np.array([sensor.noise for sensor in model.sensors.values()])
    width = np.array([np.ptp(variable.range) for variable in model.context.values()])
    scaled = jacobian / noise[:, None] * width
    information = scaled.transpose(0, 2, 1) @ scaled + 12.0 * np.eye(len(width))
    spread = np.sqrt(np.linalg.inv(information).diagonal(axis1=1, axis2=2))
    assert spread.max() < 0.05


def test_only_the_temperature_is_measured(tmp_path: Path) -> None:
    stream = draw_stream(6, rows=90)
    stream.write(tmp_path)
    loaded = rga.load_model(tmp_path / "model.json")
    record = load_record(tmp_path / "record.csv", loaded)
    assert set(record.contexts) == {"temperature"}
    assert record.readings.shape == (90, 42)
    lost = np.isnan(record.readings).mean()
    assert 0.0 < lost < 0.05
    error = stream.channels["temperature"] - np.array(stream.truth["contexts"]["temperature"])
    assert error.std() == pytest.approx(0.3, rel=0.3)


def test_of_known_contexts_it_is_the_plain_d_prime() -> None:
    rng = np.random.default_rng(0)
    signature, share = rng.standard_normal((2, 50, 4))
    jacobian = rng.standard_normal((50, 4, 2))
    variance = np.array([1.0, 2.0, 0.5, 4.0])
    plain = d_prime(signature, [share], variance)
    known = Sight(jacobian, np.full(2, 1e-9), [share], variance)
    assert known.d_prime(signature) == pytest.approx(plain)


def test_d_prime_leaves_out_what_a_latent_context_may_do() -> None:
    rng = np.random.default_rng(1)
    jacobian = rng.standard_normal((50, 6, 2))
    variance = np.ones(6)
    latent = Sight(jacobian, np.full(2, 1e6), [np.zeros((50, 6))], variance)
    moved = np.einsum("tck,tk->tc", jacobian, rng.standard_normal((50, 2)))
    assert latent.d_prime(moved) < 1e-3
    assert latent.d_prime(rng.standard_normal((50, 6))) > 10.0


@pytest.mark.parametrize(
    ("wrong", "says"),
    [({"hidden": "gremlin"}, "no kind 'gremlin'"), ({"rows": 10}, "10 rows are no stream")],
)
def test_wrong_requests_are_refused(wrong: dict[str, Any], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        draw_stream(1, **wrong)
