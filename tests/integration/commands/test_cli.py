"""The command line: what the commands write, and what they leave alone."""

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any, ClassVar

import numpy as np
import polars as pl
import pytest

from rga.cli.output import whole_directory, whole_file
from rga.errors import InputError
from rga.model import load_model, read_model
from rga.records import load_record
from rga.simulation import Simulator
from rga.simulation.dataset import write_dataset

Rga = Callable[..., Any]
VERIFICATION = Path(__file__).parents[4] / "shared" / "verification"


def test_starting_imports_nothing_heavy() -> None:
    heavy = {"torch", "matplotlib", "scipy", "polars", "numpy", "pydantic", "rga._core"}
    code = f"import sys, rga.cli; print(*({heavy!r} & set(sys.modules)))"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.split() == []


def test_help_and_version(rga: Rga) -> None:
    outcome = rga("--help")
    assert outcome.code == 0
    for command in ("run", "diagnose", "simulate", "dataset", "whatif", "verify", "schema"):
        assert command in outcome.out
    assert rga("--version").out.startswith("rga 0.")


def test_where_memory_ends_a_line_says_so(
    rga: Rga, model_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: Any, **__: Any) -> None:
        raise MemoryError

    monkeypatch.setattr("rga.checking.check", full)
    done = rga("check", model_file)
    assert (done.code, done.err.count("\n")) == (2, 1)
    assert "not enough memory" in done.err


def test_unknown_option_is_bad_input(rga: Rga, model_file: Path) -> None:
    assert rga("whatif", model_file, "--speed", "3").code == 2


@pytest.mark.parametrize("suffix", ["csv", "parquet"])
def test_simulation_is_a_record_of_the_model(
    suffix: str, tmp_path: Path, model_file: Path, rga: Rga
) -> None:
    contexts = tmp_path / "contexts.csv"
    contexts.write_text(
        "time,temperature,load\n2024-01-01T00:00,10,0\n2024-01-01T01:00,30,5e4\n", encoding="utf-8"
    )
    output = tmp_path / f"simulated.{suffix}"
    assert rga("simulate", model_file, contexts, "-o", output).code == 0
    model = load_model(model_file)
    record = load_record(output, model)
    expected = Simulator(model).predict(
        {"time": [0, 3600], "temperature": [10, 30], "load": [0, 5e4]}
    )
    np.testing.assert_allclose(record.readings, expected, rtol=1e-12)
    assert record.time.tolist() == [0, 3600]
    # Two bars of 5 m at a height of 4 m: N = -F/2 * 5/4, strain = N / EA.
    assert record.readings[1, 1] == pytest.approx(-2.5e4 * 1.25 / (2e11 * 0.01) * 1e6)


def test_dataset_is_reproducible_and_says_what_made_it(
    tmp_path: Path, model_file: Path, rga: Rga
) -> None:
    for name, seed in (("a", 1), ("b", 1), ("c", 2)):
        output = tmp_path / f"{name}.parquet"
        assert rga("dataset", model_file, "-n", 100, "--seed", seed, "-o", output).code == 0
    a, b, c = (pl.read_parquet(tmp_path / f"{name}.parquet") for name in "abc")
    assert a.equals(b)
    assert not a.equals(c)
    assert a.columns == ["temperature", "load", "D1", "S1"]
    metadata = pl.read_parquet_metadata(tmp_path / "a.parquet")
    model = load_model(model_file)
    assert metadata["seed"] == "1"
    assert metadata["model_sha256"] == model.sha256
    contexts = {name: a[name].to_numpy() for name in model.context}
    np.testing.assert_allclose(a[:, 2:].to_numpy(), Simulator(model).predict(contexts))
    assert contexts["temperature"].min() < -15
    assert contexts["temperature"].max() > 35


def test_dataset_in_chunks_is_the_same_sequence(
    tmp_path: Path, model_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model = load_model(model_file)
    done = []
    write_dataset(model, 100, tmp_path / "whole.parquet", seed=3)
    monkeypatch.setattr("rga.simulation.dataset.CHUNK", 32)
    target = tmp_path / "parts.parquet"
    write_dataset(model, 100, target, seed=3, progress=lambda _, share: done.append(share))
    whole, parts = (pl.read_parquet(tmp_path / f"{n}.parquet") for n in ("whole", "parts"))
    assert parts.equals(whole)
    assert done == [0.25, 0.5, 0.75, 1.0]


def test_a_dataset_goes_on_where_it_was_interrupted(
    tmp_path: Path, model_file: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Nothing is lost, nothing repeated, and another dataset does not take up its parts."""
    monkeypatch.setattr("rga.simulation.dataset.CHUNK", 16)
    model = load_model(model_file)
    write_dataset(model, 100, tmp_path / "whole.parquet", seed=3, noise=True)
    whole = pl.read_parquet(tmp_path / "whole.parquet")
    target = tmp_path / "parts.parquet"

    def stop_at(most: float, seed: int) -> None:
        def progress(_: str, share: float) -> None:
            if share > most:
                raise KeyboardInterrupt

        with pytest.raises(KeyboardInterrupt):
            write_dataset(model, 100, target, seed=seed, noise=True, progress=progress)

    for most, seed in ((0.2, 4), (0.1, 3), (0.4, 3)):
        stop_at(most, seed)
        assert not target.exists()
    kept = {
        file.name: file.stat().st_mtime_ns for file in (tmp_path / "parts.parquet.parts").iterdir()
    }
    assert len(kept) == 4
    # A part that was damaged is written again.
    damaged = tmp_path / "parts.parquet.parts" / "000000000016.parquet"
    damaged.write_bytes(damaged.read_bytes()[:1000])
    again: list[float] = []
    write_dataset(
        model, 100, target, seed=3, noise=True, progress=lambda _, share: again.append(share)
    )
    assert len(again) == 5
    assert pl.read_parquet(target).equals(whole)
    assert not (tmp_path / "parts.parquet.parts").exists()


def test_a_dataset_has_no_order_to_remember(tmp_path: Path, two_bars: dict[str, Any]) -> None:
    two_bars["effects"]["late"] = {"kind": "thermal_lag", "time_constant": 3.0}
    with pytest.raises(InputError, match="no order"):
        write_dataset(read_model(two_bars, "test"), 10, tmp_path / "samples.parquet")


def test_a_dataset_does_not_depend_on_the_number_of_workers(
    tmp_path: Path, model_file: Path, rga: Rga
) -> None:
    for workers in (1, 2):
        output = tmp_path / f"{workers}.parquet"
        size = ("-n", 40_000, "--noise", "--workers", workers)
        assert rga("dataset", model_file, *size, "-o", output).code == 0
    one, two = (pl.read_parquet(tmp_path / f"{n}.parquet") for n in (1, 2))
    assert one.height == 40_000
    assert one.equals(two)


def test_noise_of_a_dataset_is_the_sensors(tmp_path: Path, model_file: Path) -> None:
    model = load_model(model_file)
    write_dataset(model, 4096, tmp_path / "clean.parquet")
    write_dataset(model, 4096, tmp_path / "noisy.parquet", noise=True)
    clean, noisy = (pl.read_parquet(tmp_path / f"{n}.parquet") for n in ("clean", "noisy"))
    for name, sensor in model.sensors.items():
        assert (noisy[name] - clean[name]).std() == pytest.approx(sensor.noise, rel=0.1)


def test_results_take_contexts_as_they_are_written_and_from_a_file(
    tmp_path: Path, model_file: Path, rga: Rga
) -> None:
    written, rows = tmp_path / "written.csv", tmp_path / "rows.csv"
    of_one = rga("results", model_file, "--contexts", "load=5e4, temperature=20", "-o", written)
    assert of_one.out.startswith("1 row of 3 nodes")
    table = pl.read_csv(written)
    assert table["time"].null_count() == len(table), "no time was given"
    assert set(table["row"]) == {1}
    rows.write_text("time,load\n0,0\n60,5e4\n", encoding="utf-8")
    both = tmp_path / "both.csv"
    rga("results", model_file, rows, "--contexts", "temperature=20", "-o", both)
    second = pl.read_csv(both).filter(pl.col("row") == 2)
    assert set(second["time"]) == {60.0}
    np.testing.assert_allclose(second["value"], table["value"], rtol=1e-12)
    lacking = rga("results", model_file, "--contexts", "load=5e4", "-o", both)
    assert lacking.code == 2
    assert "temperature" in lacking.err
    many = rga("results", model_file, rows, "-o", both, "--stations", "100000000")
    assert (many.code, many.err.count("\n")) == (2, 1)
    assert "2 to 10001" in many.err


def test_whatif_compares_with_mid_range(tmp_path: Path, model_file: Path, rga: Rga) -> None:
    outcome = rga("whatif", model_file, "--set", "load=1e5", "--json")
    result = json.loads(outcome.out)
    assert result["contexts"] == {"temperature": 10.0, "load": 1e5}
    strain = result["sensors"]["S1"]
    assert strain["after"] == pytest.approx(2 * strain["before"])
    assert strain["unit"] == "microstrain"
    (tmp_path / "softer.json").write_text(
        '{"kind": "elastic_modulus", "material": "steel", "factor": 0.5}', encoding="utf-8"
    )
    target = tmp_path / "result.json"
    outcome = rga("whatif", model_file, "--add", tmp_path / "softer.json", "--json", target)
    sensors = json.loads(target.read_text(encoding="utf-8"))["sensors"]
    assert sensors["D1"]["after"] == pytest.approx(2 * sensors["D1"]["before"])
    assert "D1" in outcome.out
    assert "Without and with the change, at temperature = 10, load = 5e+04." in outcome.out


def test_whatif_adds_an_effect_at_the_contexts_that_are_set(
    tmp_path: Path, model_file: Path, rga: Rga
) -> None:
    (tmp_path / "none.json").write_text(
        '{"kind": "elastic_modulus", "material": "steel", "factor": 1.0}', encoding="utf-8"
    )
    result = json.loads(
        rga(
            "whatif", model_file, "--set", "load=1e5", "--add", tmp_path / "none.json", "--json"
        ).out
    )
    assert result["contexts_before"] == result["contexts"]
    for sensor in result["sensors"].values():
        assert sensor["after"] == pytest.approx(sensor["before"], rel=1e-9, abs=1e-9)
    shown = rga("whatif", model_file, "--set", "load=1e5").out
    assert "Before: temperature = 10, load = 5e+04. After: load = 1e+05." in shown


@pytest.mark.parametrize("ci90", [[0.45, 0.55], None])
def test_whatif_has_intervals_where_something_is_unsure(
    tmp_path: Path, model_file: Path, rga: Rga, ci90: list[float] | None
) -> None:
    softer = {"kind": "elastic_modulus", "material": "steel"}
    factor = 0.5 if ci90 is None else {"value": 0.5, "ci90": ci90}
    (tmp_path / "softer.json").write_text(json.dumps({**softer, "factor": factor}))
    shown = rga("whatif", model_file, "--add", tmp_path / "softer.json").out
    (moved,) = (line for line in shown.splitlines() if " D1 " in line)
    assert (" to " in moved) == (ci90 is not None)
    assert ("Intervals are of what is not sure" in shown) == (ci90 is not None)


def test_whatif_warns_outside_the_range(model_file: Path, rga: Rga) -> None:
    outcome = rga("whatif", model_file, "--set", "temperature=55")
    assert outcome.code == 0
    assert outcome.err == ("warning: temperature = 55 lies outside its range -20..40 degC\n")


@pytest.mark.parametrize("of", ["model", "record", "findings"])
def test_schema(of: str, rga: Rga) -> None:
    assert json.loads(rga("schema", of).out)["type"] == "object"


def test_doctor(rga: Rga) -> None:
    assert "python" in rga("doctor").out
    result = json.loads(rga("doctor", "--json").out)
    assert result["core"] == "loads"
    assert result["threads"]["cores"] >= 1


def test_verify_fails_with_exit_code_1(tmp_path: Path, rga: Rga) -> None:
    if not VERIFICATION.exists():
        pytest.skip("the verification cases are not part of this project")
    case = json.loads((VERIFICATION / "truss_bar_thermal_spring.json").read_text(encoding="utf-8"))
    (tmp_path / "good.json").write_text(json.dumps(case), encoding="utf-8")
    assert rga("verify", tmp_path).code == 0
    case["load_cases"][0]["expected"][0]["value"] += 1.0
    (tmp_path / "wrong.json").write_text(json.dumps(case), encoding="utf-8")
    outcome = rga("verify", tmp_path, "--json", tmp_path / "out" / "result.json")
    assert outcome.code == 1
    assert "1 of 2 cases passed" in outcome.out
    result = json.loads((tmp_path / "out" / "result.json").read_text(encoding="utf-8"))
    assert [case["passed"] for case in result["cases"]] == [True, False]
    for torn in ("{", "[" * 100_000, "[]", '{"nodes": [], "load_cases": []}', '{"dim": 2}'):
        (tmp_path / "torn.json").write_text(torn, encoding="utf-8")
        outcome = rga("verify", tmp_path)
        assert outcome.code == 2
        assert "torn: FAILED: the case" in outcome.out
        assert "good: passed" in outcome.out


class Nothing:
    """Findings of a diagnosis that finds nothing, and doubts a channel."""

    verdict = "nothing_wrong"
    warnings: ClassVar[list[str]] = ["D1 is odd"]

    def __init__(
        self, model: Any, record: Any, *, modal: Any, criteria: Any, seed: int, progress: Any
    ) -> None:
        assert modal is None
        progress("screening", 1.0)
        self.content = {"verdict": "nothing_wrong", "seed": seed, "rows": len(record)}
        if criteria is not None:
            self.content["criteria"] = criteria.differing()

    def write(self, directory: Path) -> None:
        (directory / "findings.json").write_text(json.dumps(self.content), encoding="utf-8")

    def sentence(self) -> str:
        return "Nothing is wrong."


def test_diagnosis_is_written_and_said(
    tmp_path: Path, model_file: Path, rga: Rga, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("rga.diagnosis.diagnose", Nothing)
    record, target = tmp_path / "record.csv", tmp_path / "out"
    record.write_text("time,D1,S1,temperature\n0,1,2,50\n1,1,2,3\n", encoding="utf-8")
    said = rga("diagnose", model_file, record, "-o", target, "--seed", 7)
    assert said.code == 0
    assert said.out.startswith("Verdict: nothing_wrong. Nothing is wrong.\n")
    assert said.err.startswith("warning: temperature lies outside its range")
    assert said.err.endswith("warning: D1 is odd\n")
    findings = json.loads((target / "findings.json").read_text(encoding="utf-8"))
    assert findings == {"verdict": "nothing_wrong", "seed": 7, "rows": 2}
    printed = rga("diagnose", model_file, record, "-o", target, "--seed", 8, "--json")
    assert json.loads(printed.out)["seed"] == 8
    stricter = tmp_path / "criteria.json"
    stricter.write_text('{"naming": {"log_odds": 9.2}}', encoding="utf-8")
    outcome = rga("diagnose", model_file, record, "-o", target, "--criteria", stricter, "--json")
    assert json.loads(outcome.out)["criteria"] == {"naming.log_odds": 9.2}


def interrupted(whole: Callable[..., Any], target: Path, name: str) -> None:
    with whole(target) as draft:
        (draft / name).write_text("half", encoding="utf-8")
        raise OSError(28, "No space left on device")


def test_a_directory_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    target = tmp_path / "deep" / "out"
    with pytest.raises(InputError, match="the output cannot be written, no space left on device"):
        interrupted(whole_directory, target, "figures")
    assert list((tmp_path / "deep").iterdir()) == []
    for text in ("first", "second"):
        with whole_directory(target) as draft:
            (draft / "figures").mkdir()
            (draft / "figures" / "a").write_text(text, encoding="utf-8")
        assert (target / "figures" / "a").read_text(encoding="utf-8") == text
        (target / "notes").write_text("mine", encoding="utf-8")
    assert sorted(path.name for path in target.iterdir()) == ["figures", "notes"]


def test_a_file_is_written_whole_or_not_at_all(tmp_path: Path) -> None:
    target = tmp_path / "out.csv"
    target.write_text("old", encoding="utf-8")
    with pytest.raises(InputError, match="the output cannot be written, no space left on device"):
        interrupted(whole_file, target, "")
    assert target.read_text(encoding="utf-8") == "old"
    assert list(tmp_path.iterdir()) == [target]
