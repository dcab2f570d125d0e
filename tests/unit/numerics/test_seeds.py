"""A seed is a whole number that a repository can keep, wherever one is given."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from made_findings import findings
from rga.detection import SyncMonitor
from rga.errors import InputError
from rga.model import Model, read_model
from rga.numerics.seeds import as_seed
from rga.records import Record
from rga.simulation.dataset import write_dataset
from rga.twin.runner import taken_up
from rga.twin.settings import Settings

NO_SEEDS = [-1, 2**63, 10**20, 1.0, float("nan"), "1", None, True, np.int8(-1), np.float64(1)]


@pytest.mark.parametrize("given", NO_SEEDS)
def test_what_is_no_seed(given: Any) -> None:
    with pytest.raises(InputError, match="is no seed"):
        as_seed(given)


@pytest.mark.parametrize("given", [0, 7, 2**63 - 1, np.int64(7), np.uint64(2**63 - 1)])
def test_what_is_one(given: Any) -> None:
    assert as_seed(given) == given
    assert type(as_seed(given)) is int


@pytest.mark.parametrize("seed", [-1, "a", float("nan"), 2**63])
def test_whoever_takes_one_refuses_others(
    seed: Any,
    measured_bridge: dict[str, Any],
    measured_record: Callable[..., Record],
    tmp_path: Path,
) -> None:
    model: Model = read_model(measured_bridge, "bridge")
    record = measured_record(model)
    out = tmp_path / "out"

    def play() -> None:
        with taken_up(model, record, out, Settings(), seed):
            pass

    settled = Settings(calibration_rows=40, packet=10, settle=10)
    takers: list[Callable[[], object]] = [
        lambda: rga.diagnose(model, record, seed=seed),
        lambda: rga.diagnose_many({"bridge": (model, record)}, out, seed=seed),
        lambda: rga.live(model, out, settings=settled, seed=seed),
        lambda: rga.plan(model, findings(), seed=seed),
        lambda: write_dataset(model, 10, out / "rows.parquet", seed=seed),
        lambda: SyncMonitor(np.zeros((100, 2)) + np.arange(100.0)[:, None], seed=seed),
        lambda: SyncMonitor.known(2, seed=seed),
        play,
    ]
    for taker in takers:
        with pytest.raises(InputError, match="is no seed"):
            taker()
    assert list(tmp_path.iterdir()) == []


def test_a_seed_of_numpy_is_that_of_python(tmp_path: Path, small_bridge: dict[str, Any]) -> None:
    seeds: dict[str, Any] = {"a": 3, "b": np.int64(3)}
    model = read_model(small_bridge, "bridge")
    for name, seed in seeds.items():
        write_dataset(model, 10, tmp_path / f"{name}.parquet", seed=seed)
    assert (tmp_path / "a.parquet").read_bytes() == (tmp_path / "b.parquet").read_bytes()
