"""Whether the files of a twin can be used, and whether they go with what was kept of it."""

import shutil
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Literal

from rga.checking.finding import Finding
from rga.jobs.begin import addressee_of, check_same
from rga.model import Model, load_model
from rga.operation.configuration import TwinSettings
from rga.operation.inbox.row_length import check_length
from rga.operation.rows.samples import Reader
from rga.operation.served_twin import live_settings
from rga.operation.sources.readers import readers_of
from rga.operation.sources.settings import source_name
from rga.twin.hardware.inbox import INBOX, Inbox
from rga.twin.repository import migrations
from rga.twin.repository.database import database
from rga.twin.settings import Settings


@dataclass(frozen=True)
class TwinFiles:
    """What the files of a twin hold.

    Attributes:
        settings: of the twin, as the service has them.
        model: of the twin.
        run: settings of its run.
        readers: by source.
    """

    settings: TwinSettings
    model: Model
    run: Settings
    readers: dict[str, Reader]

    @classmethod
    def read(cls, settings: TwinSettings) -> "TwinFiles":
        """Read them.

        Raises:
            InputError: one cannot be used.
        """
        model, run = load_model(settings.model), live_settings(settings.settings, settings.arl0)
        addressee_of(model, run, settings.name, settings.seed)
        sources = {source_name(one): one for one in settings.source}
        readers = readers_of(settings.name, sources, model)
        for one in readers.values():
            one.stated_names()  # of stated columns two may mean the same
        return cls(settings, model, run, readers)

    def check_goes_on(self, directory: Path) -> None:
        """Whether the twin that was kept in a directory, if there is one, is this one.

        Raises:
            InputError: it is another, or cannot be read.
        """
        if not (directory / INBOX).is_file():
            return
        with Inbox(directory, read_only=True) as inbox:
            known = inbox.addressee
            check_length(inbox, self.settings.rows.grid.every, str(directory))
        if known is not None:
            name, seed = self.settings.name, self.settings.seed
            check_same(known, addressee_of(self.model, self.run, name, seed), directory)


def repository_findings(where: str, place: str | Path) -> Iterator[Finding]:
    """Whether a repository can be gone on with, and whether its tables change when it is.

    Args:
        where: whose it is.
        place: its file, or URL of a PostgreSQL database.

    Raises:
        InputError: it cannot be read.
    """
    if isinstance(place, Path) and not place.is_file():
        return
    kept = _state(place)
    if kept == "newer":
        yield Finding(
            "error", where, "its repository is newer than this rga", "install a newer rga"
        )
    elif kept == "foreign" and isinstance(place, Path):
        yield Finding("error", where, f"{place} is no repository", "move it away")
    elif kept == "older":
        what, remedy = "its repository is brought up to date at the start", "make a backup before"
        if isinstance(place, Path):
            remedy = "a copy of it is put beside it"
            size, free = place.stat().st_size, shutil.disk_usage(place.parent).free
            if free < 2 * size:
                what = f"{what}, and there is no room for a copy"
                yield Finding("error", where, what, f"make room: {2 * size} bytes")
                return
        yield Finding("note", where, what, remedy)


def _state(place: str | Path) -> Literal["empty", "foreign", "older", "current", "newer"]:
    """Where the tables of a repository are, against this code."""
    found = database(place, read_only=True)
    try:
        with found.engine.begin() as connection:
            return migrations.state(connection)
    finally:
        found.close()
