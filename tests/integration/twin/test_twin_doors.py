"""A twin is opened with a `with` block and without, closed, left to Python, and opened again."""

import gc
import json
import shutil
from collections.abc import Callable
from contextlib import suppress
from dataclasses import replace
from pathlib import Path

import pytest

import rga
from rga.errors import InputError
from rga.twin import Settings, rollback
from rga.twin.repository import Repository
from rga.twin.restore import station_of

LINUX = pytest.mark.skipif(not Path("/proc/self/fd").exists(), reason="open files are in /proc")


@pytest.fixture(scope="module")
def ended(small_stream: Callable[..., Path], tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The directory of a short run that has ended."""
    folder, directory = (
        small_stream(drifts=False, sinks=False, rows=60),
        tmp_path_factory.mktemp("r"),
    )
    settings = json.loads((folder / "settings.json").read_text(encoding="utf-8"))
    chosen = Settings.model_validate({**settings, "level": "A"})
    rga.run(folder / "model.json", folder / "record.csv", directory, settings=chosen)
    return directory


@pytest.fixture
def place(ended: Path, tmp_path: Path) -> Path:
    """A copy of it."""
    shutil.copytree(ended, tmp_path, dirs_exist_ok=True)
    return tmp_path


def open_files(place: Path) -> list[str]:
    """Files of a directory that this process holds open."""
    targets = []
    for link in list(Path("/proc/self/fd").iterdir()):
        with suppress(FileNotFoundError):  # that of the folder itself
            targets.append(str(link.readlink()))
    return [one for one in targets if one.startswith(str(place))]


def writes(place: Path) -> None:
    """The one writer gets its lock at once."""
    with Repository.open(place, read_only=True) as kept:
        identity = kept.runs()[0].identity
    with Repository.open(place) as repository:
        repository.run(identity)


def test_it_answers_alike_with_and_without_a_block(place: Path) -> None:
    with rga.Twin.open(place) as twin:
        within = twin.version, twin.context, twin.log()
    twin = rga.Twin.open(place)
    assert (twin.version, twin.context, twin.log()) == within
    writes(place)  # an open twin keeps no other from writing
    twin.close()
    writes(place)
    assert twin.log() == within[2]  # it opens its repository again
    twin.close()
    twin.close()


@LINUX
def test_closed_or_forgotten_it_holds_no_file(place: Path) -> None:
    twin = rga.Twin.open(place)
    assert twin.log()
    assert open_files(place)
    twin.close()
    assert open_files(place) == []
    twin.log()
    del twin
    gc.collect()
    assert open_files(place) == []
    early = rga.Twin.open(place).as_of(row=10)
    gc.collect()
    assert early.log()  # what is told of earlier keeps what it is told by
    del early
    gc.collect()
    assert open_files(place) == []
    for _ in range(3):
        assert rga.Twin.open(place).version == 1
    gc.collect()
    assert open_files(place) == []
    writes(place)


@LINUX
def test_where_there_is_no_twin_nothing_stays_open(tmp_path: Path) -> None:
    Repository.open(tmp_path).close()
    with pytest.raises(InputError, match="nothing has run here"):
        rga.Twin.open(tmp_path)
    gc.collect()
    assert open_files(tmp_path) == []


def test_what_rollback_returns_can_be_asked(place: Path) -> None:
    twin = rollback(place, 1)
    assert twin.version == 1
    assert [one.kind for one in twin.history().events[-2:]] == ["rollback", "command"]
    writes(place)


def test_it_stands_as_it_did_at_a_date_of_its_record(
    ended: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with rga.Twin.open(ended) as twin:
        with pytest.raises(InputError, match="counts seconds, and '2026-03-01' is a date"):
            twin.as_of(time="2026-03-01")
        station = replace(station_of(twin._view), start="2026-03-01T00:00:00", time_format="iso")
        monkeypatch.setattr("rga.twin.twin.station_of", lambda view: station)
        assert twin.as_of(time="2026-03-01T09:50").state.row == 59
        with pytest.raises(InputError, match="the time 2026-02-28 is none of the record"):
            twin.as_of(time="2026-02-28")
        with pytest.raises(InputError, match="'yesterday' is no date"):
            twin.as_of(time="yesterday")
