"""Many bridges at once: the same findings wherever the work is done, and errors told by bridge."""

import csv
import pickle
import socket
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest

import rga as package
from rga.errors import InputError
from rga.parallel import finished

Rga = Callable[..., Any]
FILES = ("findings.json", "model.json", "report.html")


@pytest.fixture(scope="module")
def alone(bridges: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The results of one process."""
    output = tmp_path_factory.mktemp("alone")
    package.diagnose_many(bridges, output)
    return output


@pytest.fixture
def cluster() -> Iterator[str]:
    """A Dask cluster: one process with two threads that must not work at once."""
    distributed = pytest.importorskip("distributed", reason="needs rga[dask]")
    with distributed.LocalCluster(
        n_workers=1, threads_per_worker=2, dashboard_address=None
    ) as running:
        yield running.scheduler_address


def contents(output: Path) -> dict[str, bytes]:
    return {
        path.relative_to(output).as_posix(): path.read_bytes()
        for path in output.rglob("*")
        if path.is_file()
    }


def test_findings_are_those_of_a_diagnosis_alone(bridges: Path, alone: Path) -> None:
    for name in ("west", "east"):
        model = package.load_model(bridges.parent / name / "model.json")
        record = package.load_record(bridges.parent / name / "record.csv", model)
        findings = package.diagnose(model, record)
        written = (alone / name / "findings.json").read_text(encoding="utf-8")
        assert written == findings.to_json() + "\n"
    assert set(contents(alone)) == {
        "summary.csv", *(f"{name}/{file}" for name in ("west", "east") for file in FILES)
    }  # fmt: skip


def test_summary_reports_causes_and_errors(alone: Path) -> None:
    with (alone / "summary.csv").open(encoding="utf-8", newline="") as file:
        west, broken, east = csv.DictReader(file)
    findings = package.load_findings(alone / "west")
    assert [west["name"], broken["name"], east["name"]] == ["west", "broken", "east"]
    assert west["verdict"] == findings.verdict != "nothing_wrong"
    assert "member stiffness of" in west["causes"]
    assert float(west["gain"]) == findings.gap.held_out.gain > 0
    assert (east["verdict"], east["causes"], east["error"]) == ("nothing_wrong", "", "")
    assert "broken.csv" in broken["error"]
    assert (broken["verdict"], broken["gain"]) == ("", "")


def test_two_processes_give_the_same_bytes(
    bridges: Path, alone: Path, tmp_path: Path, rga: Rga
) -> None:
    outcome = rga("diagnose-many", bridges, "-o", tmp_path / "out", "--workers", 2)
    assert outcome.code == 2
    assert "1 of 3 bridges could not be diagnosed" in outcome.err
    assert all(word in outcome.out for word in ("west", "broken", "east", "nothing_wrong"))
    assert contents(tmp_path / "out") == contents(alone)


@pytest.mark.thorough
def test_a_dask_cluster_gives_the_same_bytes(
    bridges: Path, alone: Path, tmp_path: Path, rga: Rga, cluster: str
) -> None:
    outcome = rga("diagnose-many", bridges, "-o", tmp_path / "out", "--dask", cluster)
    assert outcome.code == 2
    assert "1 of 3 bridges could not be diagnosed" in outcome.err
    assert contents(tmp_path / "out") == contents(alone)


def test_an_error_passes_from_process_to_process() -> None:
    error = pickle.loads(pickle.dumps(InputError("a", "b", "c")))
    assert (str(error), error.remedy) == ("a (b): c", "c")


def _half(number: int) -> int:
    if number % 2:
        raise InputError(f"{number} is odd", "number", "give an even one")
    return number // 2


@pytest.mark.parametrize("workers", [1, 2])
def test_a_failed_task_stops_no_other(workers: int) -> None:
    outcomes = {
        task: future.exception() or future.result()
        for task, future in finished(_half, range(1, 5), workers=workers)
    }
    assert {task: str(one) for task, one in outcomes.items()}[3].startswith("3 is odd")
    assert (outcomes[2], outcomes[4]) == (1, 2)


def _free_address() -> str:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        return f"tcp://127.0.0.1:{probe.getsockname()[1]}"


@pytest.mark.parametrize("address", ["", "nonsense", "far://away:1", None])
def test_an_address_that_does_not_answer(
    bridges: Path, tmp_path: Path, rga: Rga, monkeypatch: pytest.MonkeyPatch, address: str | None
) -> None:
    pytest.importorskip("distributed", reason="needs rga[dask]")
    monkeypatch.setattr("rga.parallel.PATIENCE", 0.5)
    silent = _free_address() if address is None else address
    for command in (("diagnose-many", bridges), ("benchmark", "diagnosis", "--quick")):
        outcome = rga(*command, "-o", tmp_path / "out", "--dask", silent)
        assert outcome.code == 2
        assert "no Dask scheduler answers" in outcome.err
        assert "such as tcp://host:8786" in outcome.err


def test_a_port_that_never_answers(
    bridges: Path, tmp_path: Path, rga: Rga, monkeypatch: pytest.MonkeyPatch
) -> None:
    pytest.importorskip("distributed", reason="needs rga[dask]")
    monkeypatch.setattr("rga.parallel.PATIENCE", 0.5)
    with socket.socket() as silent:
        silent.bind(("127.0.0.1", 0))
        silent.listen()
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        outcome = rga("diagnose-many", bridges, "-o", tmp_path / "out", "--dask", address)
    assert outcome.code == 2
    assert "no Dask scheduler answers" in outcome.err


def test_without_dask_the_error_says_what_to_install(
    bridges: Path, tmp_path: Path, rga: Rga, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "distributed", None)
    outcome = rga("diagnose-many", bridges, "-o", tmp_path / "out", "--dask", "tcp://host:8786")
    assert outcome.code == 2
    assert "pip install 'rga[dask]'" in outcome.err


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("name,model\na,m.json\n", "the list has no column 'record'"),
        ("name,model,record,owner\na,m.json,r.csv,b\n", "the column 'owner' is unknown"),
        ("name,model,record\na,,r.csv\n", "there is no model"),
        ("name,model,record\nA,m.json,r.csv\na,m.json,r.csv\n", "the name 'a' stands twice"),
        ("name,model,record\na/b,m.json,r.csv\n", "'a/b' cannot name a directory"),
        ("name,model,record\n..,m.json,r.csv\n", "'..' cannot name a directory"),
        ("name,model,record\nsummary.csv,m.json,r.csv\n", "is the name of the summary"),
        ("name,model,record\n", "there are no rows"),
    ],
)
def test_a_bad_list_is_refused_before_anything_is_written(
    tmp_path: Path, rga: Rga, text: str, message: str
) -> None:
    listed = tmp_path / "list.csv"
    listed.write_text(text, encoding="utf-8")
    outcome = rga("diagnose-many", listed, "-o", tmp_path / "out")
    assert outcome.code == 2
    assert message in outcome.err
    assert str(listed) in outcome.err
    assert not (tmp_path / "out").exists()
