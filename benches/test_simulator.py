"""What the simulator and a diagnosis cost: `pytest benches` (needs pytest-benchmark)."""

import tempfile
from typing import Any

import pytest

import rga
from rga_bench.synthetic import draw_case

SEED = 2029


@pytest.fixture(scope="module")
def case() -> tuple[rga.Model, rga.Record]:
    """A generated bridge with its record."""
    with tempfile.TemporaryDirectory() as folder:
        draw_case(SEED).write(folder)
        model = rga.load_model(f"{folder}/model.json")
        return model, rga.load_record(f"{folder}/record.csv", model)


def test_predict(benchmark: Any, case: tuple[rga.Model, rga.Record]) -> None:
    model, record = case
    simulator = rga.Simulator(model)
    low = {name: variable.range[0] for name, variable in model.context.items()}
    shown = benchmark(simulator.predict, {"time": record.time, **low})
    assert shown.shape == (len(record.time), len(model.sensors))


def test_diagnose(benchmark: Any, case: tuple[rga.Model, rga.Record]) -> None:
    findings = benchmark.pedantic(rga.diagnose, case, rounds=1)
    assert findings.causes
