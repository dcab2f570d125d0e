"""The samples that are shipped: files, and that a diagnosis finds what they hide."""

import csv
import io
import re
import tomllib
from collections.abc import Callable
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from rga.diagnosis import diagnose, diagnose_modes
from rga.errors import InputError
from rga.model import Model, load_model
from rga.records import Record, load_record
from rga.samples import SAMPLE_NAMES, sample_files
from rga_bench.samples.catalogue import SAMPLES
from rga_bench.samples.make import sample_files as made_files

FILES = ["README.txt", "answer.txt", "import.toml", "logger.csv", "model.json"]
FILES_OF_MODES = ["README.txt", "answer.txt", "model.json", "modes.csv"]
LOGGED = [name for name in SAMPLE_NAMES if name != "crane"]
CAUSE = re.compile(r"kind = '(\w+)', (\w+) = '([^']+)'")


def logged(files: dict[str, bytes]) -> dict[str, list[str]]:
    """The columns of a logger's file, as its mapping says: a reader of this test's own."""
    mapping: dict[str, Any] = tomllib.loads(files["import.toml"].decode())
    lines = files["logger.csv"].decode(mapping["encoding"]).splitlines()
    head = lines[mapping["header_line"] - 1].split(mapping["delimiter"])
    units = lines[mapping["units_line"] - 1].split(mapping["delimiter"])
    assert len(units) == len(head)
    rows = csv.reader(io.StringIO("\n".join(lines[mapping["units_line"] :])), delimiter=";")
    columns: dict[str, list[str]] = {name: [] for name in head}
    for row in rows:
        assert len(row) == len(head)
        for name, cell in zip(head, row, strict=True):
            columns[name].append("" if cell in mapping["missing"] else cell)
    for name in mapping["unused"]:
        del columns[name]
    date, clock = (columns.pop(name) for name in mapping["time"]["columns"])
    moments = [
        datetime.strptime(f"{day} {hour}", mapping["time"]["format"]).replace(tzinfo=UTC)
        for day, hour in zip(date, clock, strict=True)
    ]
    point = {
        name: [c.replace(mapping["decimal"], ".") for c in own] for name, own in columns.items()
    }
    return {"time": [str(moment.timestamp()) for moment in moments], **point}


@pytest.fixture
def read(tmp_path: Path) -> Callable[[str], tuple[Model, Record]]:
    """Reads a sample by its own files."""

    def sample(name: str) -> tuple[Model, Record]:
        files = sample_files(name)
        (tmp_path / "model.json").write_bytes(files["model.json"])
        columns = logged(files)
        rows = [",".join(columns), *(",".join(row) for row in zip(*columns.values(), strict=True))]
        (tmp_path / "record.csv").write_text("\n".join(rows), encoding="utf-8")
        model = load_model(tmp_path / "model.json")
        return model, load_record(tmp_path / "record.csv", model)

    return sample


class TestShippedFiles:
    @pytest.mark.parametrize("name", LOGGED)
    def test_every_sample_is_read_as_its_mapping_says(
        self, name: str, read: Callable[[str], tuple[Model, Record]]
    ) -> None:
        model, record = read(name)
        assert model.about.structure == model.name
        assert record.sensors == tuple(model.sensors)
        assert set(record.contexts) == set(model.context)
        assert len(record.time) == 240
        assert sum(len(content) for content in sample_files(name).values()) < 200_000

    @pytest.mark.parametrize("name", SAMPLE_NAMES)
    def test_the_answer_stands_in_its_own_file_alone(self, name: str) -> None:
        files = sample_files(name)
        assert list(files) == (FILES if name in LOGGED else FILES_OF_MODES)
        found = CAUSE.search(files["answer.txt"].decode())
        assert found is not None
        kind, _, place = found.groups()
        for file in ("README.txt", "import.toml"):
            told = files.get(file, b"").decode()
            assert kind not in told
            assert place not in told

    @pytest.mark.parametrize("name", LOGGED)
    def test_a_logger_writes_in_its_own_encoding(self, name: str) -> None:
        content = sample_files(name)["logger.csv"]
        assert "µm/m" in content.decode("cp1252")
        with pytest.raises(UnicodeDecodeError):
            content.decode("utf-8")

    def test_modes_are_what_the_generator_makes(self) -> None:
        shipped, made = sample_files("crane"), made_files(SAMPLES["crane"])
        (one, *rows), (other, *again) = (
            files["modes.csv"].decode().splitlines() for files in (shipped, made)
        )
        assert one == other
        for row, cells in zip(rows, again, strict=True):
            (time, *values), (second, *others) = row.split(","), cells.split(",")
            assert time == second
            np.testing.assert_allclose(
                np.array(values, dtype=float), np.array(others, dtype=float), atol=1e-6
            )

    def test_they_are_what_the_generator_makes(self) -> None:
        """To the last digit that machines agree on: what is rounded may fall either way."""
        shipped, made = sample_files("footbridge"), made_files(SAMPLES["footbridge"])
        for name in FILES:
            if name != "logger.csv":
                assert shipped[name] == made[name], name
        one, other = logged(shipped), logged(made)
        assert list(one) == list(other)
        for name, cells in one.items():
            for cell, again in zip(cells, other[name], strict=True):
                digit = 10.0 ** -len(cell.partition(".")[2])
                assert float(cell or 0) == pytest.approx(float(again or 0), abs=1.01 * digit)

    def test_an_unknown_name_is_refused(self) -> None:
        with pytest.raises(InputError, match=r"no sample 'bridge'.*use footbridge, roof"):
            sample_files("bridge")


class TestHiddenCauses:
    @pytest.mark.parametrize("name", ["footbridge", "roof", "crane"])
    def test_a_diagnosis_names_what_is_hidden(
        self, name: str, read: Callable[[str], tuple[Model, Record]], tmp_path: Path
    ) -> None:
        files = sample_files(name)
        if name in LOGGED:
            findings = diagnose(*read(name))
        else:
            for file in ("model.json", "modes.csv"):
                (tmp_path / file).write_bytes(files[file])
            findings = diagnose_modes(tmp_path / "model.json", tmp_path / "modes.csv")
        kind, part, place = CAUSE.findall(files["answer.txt"].decode())[0]
        assert findings.verdict == "named"
        (cause,) = findings.causes
        assert (cause.effect["kind"], cause.effect[part]) == (kind, place)


class TestExampleCommand:
    def test_it_writes_all_files_into_a_new_or_an_empty_directory(
        self, rga: Callable[..., Any], tmp_path: Path
    ) -> None:
        (tmp_path / "empty").mkdir()
        for place in (tmp_path / "new" / "deep", tmp_path / "empty"):
            outcome = rga("example", "mast", place)
            assert outcome.code == 0
            assert "README.txt says what it is" in outcome.out
            assert sorted(path.name for path in place.iterdir()) == FILES

    def test_a_directory_with_other_files_stays_as_it_is(
        self, rga: Callable[..., Any], tmp_path: Path
    ) -> None:
        (tmp_path / "model.json").write_text("mine")
        outcome = rga("example", "roof", tmp_path)
        assert outcome.code == 2
        assert "the directory is not empty" in outcome.err
        assert (tmp_path / "model.json").read_text() == "mine"
        assert len(list(tmp_path.iterdir())) == 1
        outcome = rga("example", "roof", tmp_path / "model.json")
        assert outcome.code == 2
        assert "the output is a file" in outcome.err

    def test_an_unknown_sample_is_bad_input(self, rga: Callable[..., Any], tmp_path: Path) -> None:
        assert rga("example", "castle", tmp_path / "new").code == 2
        assert not (tmp_path / "new").exists()
