"""A dataset made by a Dask cluster: the bytes of one process, whatever becomes of its workers."""

import json
import os
import pickle
import subprocess
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import polars as pl
import pytest

from rga.model import load_model
from rga.simulation import dataset
from rga.simulation.dataset import write_dataset

distributed = pytest.importorskip("distributed", reason="needs rga[dask]")
Rga = Callable[..., Any]
ROWS, PARTS = 4096, 32
GIVEN = {"seed": 3, "noise": True}
Cluster = tuple[Any, dict[str, subprocess.Popen[bytes]]]


@pytest.fixture
def short_parts(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("rga.simulation.dataset.CHUNK", ROWS // PARTS)


@pytest.fixture(scope="module")
def cluster(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Cluster]:
    """A cluster whose workers live."""
    with started(tmp_path_factory.mktemp("elsewhere")) as cluster:
        yield cluster


@contextmanager
def started(folder: Path) -> Iterator[Cluster]:
    """A scheduler, and two worker processes that nobody starts again."""
    with distributed.LocalCluster(n_workers=0, dashboard_address=None) as running:
        command = [sys.executable, "-m", "distributed.cli.dask_worker", running.scheduler_address]
        options = ["--no-nanny", "--nthreads", "1", "--no-dashboard", "--name"]
        workers = {
            name: subprocess.Popen(
                [*command, *options, name],
                cwd=folder,
                stdout=subprocess.DEVNULL,
                stderr=subprocess.DEVNULL,
            )
            for name in ("one", "other")
        }
        try:
            with distributed.Client(running) as client:
                client.wait_for_workers(len(workers), timeout=60)
            yield running, workers
        finally:
            for worker in workers.values():
                worker.kill()
                worker.wait()


@pytest.mark.usefixtures("short_parts")
def test_the_bytes_are_those_of_one_process(
    tmp_path: Path, model_file: Path, cluster: Cluster
) -> None:
    assert_same_bytes(tmp_path, model_file, cluster, killed=False)


@pytest.mark.usefixtures("short_parts")
def test_they_are_where_a_worker_is_killed(tmp_path: Path, model_file: Path) -> None:
    folder = tmp_path / "elsewhere"
    folder.mkdir()
    with started(folder) as cluster:
        assert_same_bytes(tmp_path, model_file, cluster, killed=True)


def assert_same_bytes(tmp_path: Path, model_file: Path, cluster: Cluster, *, killed: bool) -> None:
    """A cluster writes what one process does, a worker of it killed on the way or none."""
    running, workers = cluster
    model = load_model(model_file)
    write_dataset(model, ROWS, tmp_path / "alone.parquet", **GIVEN)
    lost: list[str] = []
    shares: list[float] = []

    def progress(_: str, share: float) -> None:
        shares.append(share)
        if not killed or lost or share < 0.2:
            return
        for state in list(running.scheduler.workers.values()):
            if state.processing:
                workers[state.name].kill()
                workers[state.name].wait()
                lost.append(state.name)
                return

    target = tmp_path / "cluster.parquet"
    address = running.scheduler_address
    write_dataset(model, ROWS, target, **GIVEN, dask=address, progress=progress)
    assert target.read_bytes() == (tmp_path / "alone.parquet").read_bytes()
    assert shares == [number / PARTS for number in range(1, PARTS + 1)]
    assert len(lost) == killed
    assert len(running.scheduler.workers) == len(workers) - killed
    assert not [*tmp_path.glob("*.parts")]


@pytest.mark.usefixtures("short_parts")
def test_it_goes_on_where_it_was_interrupted(
    tmp_path: Path, model_file: Path, cluster: Cluster, monkeypatch: pytest.MonkeyPatch
) -> None:
    running, _ = cluster
    model = load_model(model_file)
    write_dataset(model, ROWS, tmp_path / "alone.parquet", **GIVEN)
    target = tmp_path / "cluster.parquet"

    def stop(_: str, share: float) -> None:
        if share >= 0.5:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        write_dataset(model, ROWS, target, **GIVEN, dask=running.scheduler_address, progress=stop)
    assert not target.exists()
    kept = {file.name for file in (tmp_path / "cluster.parquet.parts").glob("*.parquet")}
    assert len(kept) == PARTS // 2
    # The rest is made here: a part does not tell who made it. What is sent names no file.
    sent: list[bytes] = []
    real = dataset.finished

    def spied(function: Any, tasks: Any, **given: Any) -> Any:
        sent.extend(pickle.dumps(task) for task in tasks)
        return real(function, tasks, **given)

    monkeypatch.setattr("rga.simulation.dataset.finished", spied)
    write_dataset(model, ROWS, target, **GIVEN)
    assert target.read_bytes() == (tmp_path / "alone.parquet").read_bytes()
    assert len(sent) == PARTS - len(kept)
    assert not [task for task in sent if os.fsencode(tmp_path) in task]


def test_the_command(tmp_path: Path, model_file: Path, rga: Rga, cluster: Cluster) -> None:
    address = cluster[0].scheduler_address
    for name, where in (("here", ()), ("there", ("--dask", address))):
        ran = rga("dataset", model_file, "-n", 40_000, "-o", tmp_path / f"{name}.parquet", *where)
        assert ran.code == 0, ran.err
        assert "40000 rows of 2 sensors" in ran.out
    here, there = (tmp_path / f"{name}.parquet" for name in ("here", "there"))
    assert there.read_bytes() == here.read_bytes()
    assert pl.read_parquet(there).height == 40_000


def test_an_address_that_does_not_answer(
    tmp_path: Path, model_file: Path, rga: Rga, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.parallel.PATIENCE", 0.5)
    target = tmp_path / "samples.parquet"
    ran = rga("dataset", model_file, "-n", 4, "-o", target, "--dask", "tcp://127.0.0.1:1")
    assert ran.code == 2
    assert "no Dask scheduler answers" in ran.err
    assert not target.exists()


def test_an_error_of_a_worker_is_that_of_one_process(
    tmp_path: Path, two_bars: dict[str, Any], rga: Rga, cluster: Cluster
) -> None:
    two_bars["context"]["loss"] = {"unit": "-", "range": [-1, 1]}
    lost = {"kind": "member_stiffness", "member": "west", "factor": {"context": "loss"}}
    two_bars["effects"]["loss"] = lost
    (tmp_path / "bad.json").write_text(json.dumps(two_bars), encoding="utf-8")
    command = ("dataset", tmp_path / "bad.json", "-n", 8, "-o", tmp_path / "samples.parquet")
    here, there = rga(*command), rga(*command, "--dask", cluster[0].scheduler_address)
    assert here.code == there.code == 2
    assert "leaves no stiffness" in here.err
    assert there.err == here.err
