"""A twin that is brought back from copies of its files."""

import shutil
from pathlib import Path

import pytest

import rga
from live_streams import SETTINGS
from rga.errors import InputError
from rga.model import Model
from rga.records import Record
from rga.twin.hardware.inbox import INBOX
from rga.twin.repository.database import FILE_NAME


def fed(sound: tuple[Model, Record], place: Path, *ends: int) -> None:
    """Feed and play the rows up to each of some, and keep copies of the files after each."""
    first = 0
    for number, end in enumerate(ends):
        with rga.live(sound[0], place, settings=SETTINGS) as twin:
            twin.feed(sound[1].rows(slice(first, end)))
            twin.play()
        first = end
        shutil.copytree(place, place.with_name(f"copy {number}"))


def test_an_inbox_that_is_older_than_its_repository_is_told(
    sound: tuple[Model, Record], tmp_path: Path
) -> None:
    place = tmp_path / "twin"
    fed(sound, place, 50, 80)
    shutil.copy(tmp_path / "copy 0" / INBOX, place / INBOX)
    with rga.LiveTwin(place) as twin, pytest.raises(InputError, match="80 rows were taken in"):
        twin.play()
    # Both of one copy go on.
    shutil.copy(tmp_path / "copy 0" / FILE_NAME, place / FILE_NAME)
    with rga.LiveTwin(place) as twin:
        twin.feed(sound[1].rows(slice(50, 80)))
        twin.play()
        assert twin.waiting == (0, 0)
