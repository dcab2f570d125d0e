"""What `rga serve` does: its twins, where their data comes from, and how rows are made of it."""

from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, Field, model_validator

from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.grid import Grid
from rga.operation.settings_types import Duration, Name, SettingsTable
from rga.operation.sources.settings import AnySource, source_name
from rga.settings_files import read_table, validated


class RowSettings(SettingsTable):
    """How rows are made of samples.

    Attributes:
        every: length of a cell [s], from which on a grid in UTC.
        statistic: of the samples of a cell.
        lateness: by which a source may send samples after others of later times [s].
        patience: after which a silent source is waited for no longer [s].
    """

    every: Duration = 60.0
    statistic: Literal["mean"] = "mean"
    lateness: Duration = 600.0
    patience: Duration = 1800.0

    @property
    def grid(self) -> Grid:
        """The cells of the rows."""
        return Grid(round(self.every * MICROSECONDS), round(self.lateness * MICROSECONDS))

    @model_validator(mode="after")
    def _whole(self) -> "RowSettings":
        if self.every < 1e-3:
            raise ValueError("every: a row is of a millisecond at least")
        return self


Source = Annotated[AnySource, Field(discriminator="kind")]


class TwinSettings(SettingsTable):
    """A twin that is served.

    Attributes:
        name: of it, in addresses and topics.
        model, settings: files, beside the configuration.
        seed: of everything random.
        rows: how they are made of samples.
        source: where samples come from.
    """

    name: Name
    model: Path
    settings: Path
    seed: Annotated[int, Field(ge=0, lt=2**63, strict=True)] = 0
    rows: RowSettings = RowSettings()
    source: Annotated[list[Source], Field(min_length=1)]

    @model_validator(mode="after")
    def _named_apart(self) -> "TwinSettings":
        names = [source_name(one) for one in self.source]
        if double := next((one for one in names if names.count(one) > 1), None):
            raise ValueError(f"two sources are called {double!r}: give each a name")
        return self


class ServiceSettings(SettingsTable):
    """The service itself.

    Attributes:
        listen: address and port of the API and the pages.
        data: folder of the twins, beside the configuration.
        repository: URL of a PostgreSQL database for the repositories; None: they are in `data`.
    """

    listen: Annotated[str, Field(pattern=r"^(\[[0-9a-f:]+\]|[A-Za-z0-9.-]+):\d{1,5}$")] = (
        "127.0.0.1:8471"
    )
    data: Path = Path("data")
    repository: str | None = None


class Configuration(SettingsTable):
    """A file of `rga serve`.

    Attributes:
        service: the service itself.
        twin: the twins.
    """

    service: ServiceSettings = ServiceSettings()
    twin: Annotated[list[TwinSettings], Field(min_length=1)]

    @model_validator(mode="after")
    def _named_apart(self) -> "Configuration":
        names = [one.name for one in self.twin]
        if double := next((one for one in names if names.count(one) > 1), None):
            raise ValueError(f"two twins are called {double!r}: give each a name of its own")
        return self


def read_configuration(path: Path) -> Configuration:
    """Read the file of a service; the paths that it states begin in its folder.

    Raises:
        InputError: it cannot be read, or a key is unknown or wrong.
    """
    content = read_table(path, "configuration")
    found = validated(Configuration, content, str(path), "configuration")
    return Configuration.model_construct(**_from(path.parent, dict(found)))


def _from(folder: Path, found: Any) -> Any:
    """The same, with paths that begin in a folder."""
    if isinstance(found, Path):
        return folder / found
    if isinstance(found, list):
        return [_from(folder, one) for one in found]
    if isinstance(found, dict):
        return {name: _from(folder, one) for name, one in found.items()}
    if isinstance(found, BaseModel):
        values = {name: _from(folder, getattr(found, name)) for name in type(found).model_fields}
        return found.model_copy(update=values)
    return found
