"""A repository of which bytes are damaged: what is answered is right, or one line says so."""

import json
import shutil
import sqlite3
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import sqlalchemy

import rga as package
from rga.errors import InputError
from rga.twin import Settings
from rga.twin.repository import tables
from rga.twin.repository.checksum import checksum

Rga = Callable[..., Any]
#: readings of one sensor, as bytes, are so many; damage that is drawn is as long
LENGTH = 16
OUTPUT = "{output}"
COMMANDS = {
    "status": ("status", "--json", "-"),
    "replay": ("replay", "--json", "-"),
    "as of": ("replay", "--row", "30", "--json", "-"),
    "what if": ("whatif", "--set", "west load=50", "--json", "-"),
    "export": ("export", "-o", OUTPUT),
}


@dataclass(frozen=True)
class Ended:
    """A run that has ended, and what commands say of it."""

    directory: Path
    answers: dict[str, str]


def asked(rga: Rga, words: tuple[str, ...], place: Path) -> tuple[int, str, str]:
    """Exit code of a command, what it answers, and what it says besides."""
    output = place / "out.csv"
    command, *options = [str(output) if one == OUTPUT else one for one in words]
    found = rga(command, place, *options)
    answer = output.read_text("utf-8") if OUTPUT in words and output.exists() else found.out
    output.unlink(missing_ok=True)
    return found.code, answer, found.err


@pytest.fixture(scope="module")
def directory(small_stream: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    folder, place = small_stream(drifts=False, rows=130), tmp_path_factory.mktemp("run")
    settings = json.loads((folder / "settings.json").read_text("utf-8"))
    chosen = Settings.model_validate(settings | {"level": "B"})
    with pytest.MonkeyPatch.context() as patch:
        # No report is read here.
        patch.setattr("rga.report.write_run_report", lambda history, findings, path: path)
        package.run(folder / "model.json", folder / "record.csv", place, settings=chosen)
    # What the log of writing holds is in the file.
    with sqlite3.connect(place / "twin.sqlite") as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")
    connection.close()
    return place


@pytest.fixture
def ended(directory: Path, rga: Rga) -> Ended:
    answers = {}
    for name, words in COMMANDS.items():
        code, answers[name], err = asked(rga, words, directory)
        assert code == 0, err
    return Ended(directory, answers)


@pytest.mark.parametrize(
    "seed", [0, *(pytest.param(seed, marks=pytest.mark.thorough) for seed in range(1, 4))]
)
def test_an_answer_is_right_or_one_line_says_what_is_damaged(
    seed: int, ended: Ended, rga: Rga, tmp_path: Path
) -> None:
    content = (ended.directory / "twin.sqlite").read_bytes()
    draw = np.random.default_rng(seed)
    seen = 0
    for _ in range(10):
        begun = int(draw.integers(0, len(content) - LENGTH))
        noise = draw.integers(0, 256, LENGTH, dtype=np.uint8).tobytes()
        broken = content[:begun] + noise + content[begun + LENGTH :]
        (tmp_path / "twin.sqlite").write_bytes(broken)
        for file in tmp_path.glob("twin.sqlite-*"):
            file.unlink()
        code, _, err = asked(rga, ("replay", "--check"), tmp_path)
        whole = code == 0
        seen += not whole
        assert whole or (code == 2 and err.count("\n") == 1), (begun, err)
        for name, words in COMMANDS.items():
            code, answer, err = asked(rga, words, tmp_path)
            if code == 0 and "are damaged and left out" not in err:
                assert answer == ended.answers[name], (name, begun)
            else:
                assert not whole, (name, begun, err)
                assert err.count("\n") == 1, (name, begun, err)
    assert seen > 2


def test_words_of_the_database_that_are_no_text(ended: Ended, rga: Rga, tmp_path: Path) -> None:
    content = (ended.directory / "twin.sqlite").read_bytes()
    broken = content.replace(b"CREATE TABLE gap", b"CREATE TABL\xf2 gap")
    assert broken != content
    (tmp_path / "twin.sqlite").write_bytes(broken)
    for words in (("replay", "--check"), *COMMANDS.values()):
        code, _, err = asked(rga, words, tmp_path)
        assert (code, err.count("\n")) == (2, 1), err
    assert [file.name for file in tmp_path.iterdir()] == ["twin.sqlite"]


def test_a_repository_that_was_tampered_with_is_reported(directory: Path, tmp_path: Path) -> None:
    """Also where whoever did it knows of checksums: the log has hashes of what was answered."""
    shutil.copytree(directory, tmp_path, dirs_exist_ok=True)
    package.Twin.open(tmp_path).close()
    engine = sqlalchemy.create_engine(f"sqlite:///{tmp_path / 'twin.sqlite'}")
    with engine.begin() as connection:
        connection.execute(sqlalchemy.text("UPDATE gap SET simulated = gaps"))
    with pytest.raises(InputError, match=r"an entry of gap .* is not what was written"):
        package.Twin.open(tmp_path)
    with engine.begin() as connection:
        for entry in connection.execute(sqlalchemy.select(tables.gap)).all():
            own = (tables.gap.c.step == entry.step) & (tables.gap.c.ordinal == entry.ordinal)
            forged = {"checksum": checksum(entry._asdict())}
            connection.execute(sqlalchemy.update(tables.gap).where(own).values(**forged))
    engine.dispose()
    with pytest.raises(InputError, match="does not hold what the twin answered"):
        package.Twin.open(tmp_path)
