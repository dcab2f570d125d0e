"""Doors of Python: objects or files, tables of contexts, and the names that there are."""

import json
from collections.abc import Callable
from datetime import datetime, timedelta
from pathlib import Path
from typing import Any

import jsonschema
import numpy as np
import polars as pl
import pytest

import rga
from made_findings import cause, findings
from rga import diagnose, inference
from rga.errors import InputError
from rga.findings.criteria import Criteria
from rga.model import load_model, read_model
from rga.model.effect import seconds
from rga.simulation.whatif import whatif
from rga.twin.settings import Settings, as_settings

CONTEXTS = {"temperature": np.array([0.0, 20.0]), "load": np.array([0.0, 5e4])}


@pytest.fixture
def record_file(model_file: Path) -> Path:
    path = model_file.parent / "record.csv"
    path.write_text("time,temperature,load,D1,S1\n0,1,2,3,4\n60,2,3,4,5\n", encoding="utf-8")
    return path


@pytest.fixture
def given(monkeypatch: pytest.MonkeyPatch) -> list[tuple[Any, ...]]:
    """What reaches the work behind `diagnose` and `plan`, which is left out."""
    calls: list[tuple[Any, ...]] = []
    for place in ("rga.diagnosis.pipeline._diagnose", "rga.planning.planner._planned"):
        monkeypatch.setattr(place, lambda *arguments: calls.append(arguments))
    return calls


@pytest.mark.parametrize("form", [str, Path])
def test_diagnose_takes_files_as_it_takes_objects(
    form: Callable[[Path], Any], model_file: Path, record_file: Path, given: list[tuple[Any, ...]]
) -> None:
    criteria = model_file.parent / "criteria.json"
    criteria.write_text('{"$schema": "x.json", "record": {"few_rows": 20}}', encoding="utf-8")
    rga.diagnose(form(model_file), form(record_file), criteria=form(criteria))
    model = rga.load_model(model_file)
    rga.diagnose(model, rga.load_record(record_file, model), criteria=rga.load_criteria(criteria))
    files, objects = given
    assert files[0] == files[1] == objects[0] == model
    assert files[0].sha256 == model.sha256
    assert files[2].sha256 == objects[2].sha256
    assert files[5] == objects[5]
    assert files[5].record.few_rows == 20
    rga.diagnose(form(model_file), form(record_file))
    assert given[-1][5] == Criteria()


def test_a_record_is_read_against_a_model_or_its_file(model_file: Path, record_file: Path) -> None:
    of_model = rga.load_record(record_file, rga.load_model(model_file))
    for form in (str, Path):
        read = rga.load_record(record_file, form(model_file))
        assert read.sensors == of_model.sensors
        assert (read.readings == of_model.readings).all()


def test_a_mapping_goes_with_the_file(
    model_file: Path, record_file: Path, given: list[tuple[Any, ...]]
) -> None:
    how = model_file.parent / "how.toml"
    how.write_text("[channels]\nD1 = {sign = -1}", encoding="utf-8")
    rga.diagnose(model_file, record_file, mapping=how)
    assert given[0][2].readings[:, 0].tolist() == [-3.0, -4.0]


def test_plan_takes_files(model_file: Path, given: list[tuple[Any, ...]]) -> None:
    model = rga.load_model(model_file)
    found = findings(cause({"kind": "sensor_gain", "sensor": "S1", "factor": 1.2}))
    found = found.model_copy(update={"model_sha256": model.sha256})
    (model_file.parent / "findings.json").write_text(found.to_json(), encoding="utf-8")
    rga.plan(model_file, model_file.parent)
    rga.plan(str(model_file), str(model_file.parent / "findings.json"))
    rga.plan(model, found)
    assert [one[1].to_json() for one in given] == [found.to_json()] * 3
    assert [one[0] for one in given] == [model] * 3


def test_settings_are_taken_as_a_file(tmp_path: Path) -> None:
    path = tmp_path / "settings.toml"
    path.write_text('level = "B"', encoding="utf-8")
    assert as_settings(path) == as_settings(str(path)) == Settings(level="B")
    assert as_settings(Settings(level="A")).level == "A"
    assert as_settings(None) == Settings()


WRONG: Any = 3.5


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda model: rga.diagnose(WRONG, "record.csv"), "a float is no model"),
        (lambda model: rga.diagnose(model, WRONG), "a float is no record"),
        (lambda model: rga.diagnose(model, model.parent / "r.csv", criteria=WRONG), "criteria"),
        (lambda model: rga.plan(model, WRONG), "a float is no findings"),
        (lambda model: rga.run(model, WRONG, "out"), "a float is no record"),
        (lambda model: rga.Simulator(WRONG), "a float is no model"),
        (lambda model: rga.Simulator(model).predict(WRONG), "contexts are a float"),
        (lambda model: rga.Simulator(model).predict(["load"]), "contexts are a list"),  # type: ignore[arg-type]
        (lambda model: as_settings(WRONG), "a float is no set of settings"),
        (lambda model: rga.load_model({"a": 1}), "a dict is no path of a model file"),  # type: ignore[arg-type]
        (lambda model: rga.load_record(model, 3), "an int is no model"),  # type: ignore[arg-type]
        (lambda model: rga.load_record(WRONG, model), "a float is nothing that a record is"),
        (lambda model: rga.load_record(np.zeros(3), model), "an ndarray is nothing that"),  # type: ignore[arg-type]
        (lambda model: rga.load_record([WRONG], model), "a float is nothing that a record"),
        (lambda model: rga.load_record(None, model), "None is nothing that a record"),  # type: ignore[arg-type]
        (lambda model: rga.load_record(model.parent / "r.csv", model, WRONG), "no mapping"),
        (lambda model: rga.draw(model, "x.svg", foo=1), "a drawing has no option 'foo'"),  # type: ignore[call-arg]
        (lambda model: rga.draw(model, "x.svg", names=WRONG), "a float names nothing"),
    ],
)
def test_what_is_neither_is_refused_in_words(
    call: Callable[[Path], Any], words: str, model_file: Path, record_file: Path
) -> None:
    record_file.rename(model_file.parent / "r.csv")
    with pytest.raises(InputError, match=words):
        call(model_file)


def test_python_says_what_the_command_line_says(
    model_file: Path, record_file: Path, rga: Callable[..., Any]
) -> None:
    record_file.write_text("time,D1,S1\n0,1,x\n", encoding="utf-8")
    with pytest.raises(InputError) as refused:
        diagnose(model_file, record_file)
    outcome = rga("diagnose", model_file, record_file, "-o", model_file.parent / "out")
    assert outcome.err == f"error: {refused.value}\n"


class Table:
    """A table as pandas has it: an index of columns, values by name."""

    def __init__(self, **columns: Any) -> None:
        self._columns = columns
        self.columns = np.array(list(columns), dtype=object)

    def __getitem__(self, name: str) -> Any:
        return self._columns[name]


def test_contexts_are_taken_as_a_table(model_file: Path) -> None:
    simulator = rga.Simulator(str(model_file))
    expected = simulator.predict(CONTEXTS)
    frame = pl.DataFrame({**CONTEXTS, "D1": [1.0, 2.0], "note": ["calm", "storm"]})
    for table in (frame, frame.select("load", "temperature"), Table(**CONTEXTS)):
        assert (simulator.predict(table) == expected).all()
        assert (simulator.jacobian(table) == simulator.jacobian(CONTEXTS)).all()
        assert str(simulator.plan(table)) == str(simulator.plan(CONTEXTS))
    with pytest.raises(InputError, match="the context 'load' is missing"):
        simulator.predict(frame.drop("load"))
    with pytest.raises(InputError, match=r"'load' is not a number.*row 2|row 2"):
        simulator.predict(pl.DataFrame({"temperature": [1.0, 2.0], "load": [1.0, None]}))


def test_times_of_a_table_are_dates(two_bars: dict[str, Any]) -> None:
    two_bars["effects"]["sinks"] = {
        "kind": "support_settlement",
        "support": "E",
        "dof": "uz",
        "displacement": -0.01,
        "onset": "2024-05-01T12:00",
    }
    simulator = rga.Simulator(read_model(two_bars, "two bars"))
    moments = [datetime(2024, 5, 1, 11) + timedelta(hours=k) for k in range(3)]
    level: dict[str, Any] = {"temperature": np.full(3, 10.0), "load": np.zeros(3)}
    texts = [moment.isoformat() for moment in moments]
    expected = simulator.predict({**level, "time": [seconds(text) for text in texts]})
    assert expected[:, 0].tolist() == pytest.approx([0.0, -5.0, -5.0])
    for time in (moments, texts, np.array(moments, dtype="datetime64[ns]")):
        assert (simulator.predict(pl.DataFrame({**level, "time": time})) == expected).all()
        assert (simulator.predict({**level, "time": time}) == expected).all()
    with pytest.raises(InputError, match="seconds or ISO 8601"):
        simulator.predict({**level, "time": ["soon", "later", "never"]})


def test_whatif_takes_a_file(model_file: Path) -> None:
    answer = whatif(str(model_file), {"load": 5e4})
    assert answer.contexts["load"] == 5e4


def test_many_bridges_are_taken_by_name(model_file: Path, tmp_path: Path) -> None:
    model = rga.load_model(model_file)
    bridges: dict[str, tuple[Any, Any]] = {
        "north": (model, tmp_path / "no.csv"),
        "south": (tmp_path / "no.json", "x.csv"),
    }
    summaries = rga.diagnose_many(bridges, tmp_path / "out")
    assert [one.name for one in summaries] == ["north", "south"]
    assert "no.csv" in str(summaries[0].error)
    assert "no.json" in str(summaries[1].error)
    for names in (["a/b"], ["North", "north"], [""], ["summary.csv"]):
        with pytest.raises(InputError):
            rga.diagnose_many(dict.fromkeys(names, (model, "x.csv")), tmp_path / "out")


def test_dir_lists_what_there_is() -> None:
    assert set(rga.__all__) <= set(dir(rga))
    assert {"check", "diagnose", "run", "model"} <= set(dir(rga))
    assert not {"opening", "listing", "TYPE_CHECKING", "version"} & set(dir(rga))
    for name in rga.__all__:
        assert getattr(rga, name) is not None
    assert set(inference.__all__) <= set(dir(inference))


def test_schemas_take_what_names_them(
    two_bars: dict[str, Any], rga: Callable[..., Any], tmp_path: Path
) -> None:
    for name, content in (("model", two_bars), ("criteria", {"record": {"few_rows": 20}})):
        schema = json.loads(rga("schema", name).out)
        jsonschema.validate({"$schema": f"{name}.schema.json", **content}, schema)
        with pytest.raises(jsonschema.ValidationError):
            jsonschema.validate({"$scheme": "x", **content}, schema)
    path = tmp_path / "model.json"
    path.write_text(json.dumps({"$schema": "model.schema.json", **two_bars}), encoding="utf-8")
    assert load_model(path).schema_file == "model.schema.json"
