"""Whether there is room on a disk: as much as has to be free, and not a byte less."""

from collections import namedtuple
from pathlib import Path

import pytest

from rga.operation.disk import room
from rga.operation.disk.room import DiskRoom
from rga.twin.repository.faults import RepositoryFault

Usage = namedtuple("Usage", "total used free")


@pytest.mark.parametrize(("free", "enough"), [(101, True), (100, True), (99, False), (0, False)])
def test_a_tenth_has_to_be_free(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, free: int, enough: bool
) -> None:
    monkeypatch.setattr(room.shutil, "disk_usage", lambda _: Usage(1000, 1000 - free, free))
    disk = DiskRoom(tmp_path, 0.1)
    assert (disk.free, disk.free_share, disk.is_enough()) == (free, free / 1000, enough)


def test_a_disk_that_is_away_is_told(tmp_path: Path) -> None:
    with pytest.raises(RepositoryFault, match="cannot be looked at"):
        DiskRoom(tmp_path / "away", 0.1).is_enough()
