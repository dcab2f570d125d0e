"""What `rga serve` does: its twins, where their data comes from, and how rows are made of it."""

from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import BaseModel, BeforeValidator, Field, model_validator

from rga.detection.rarity import LEAST, MOST
from rga.operation.alarms.alarm_settings import AlarmSettings
from rga.operation.notices.notify_settings import NotifySettings
from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.grid import Grid
from rga.operation.settings_types import Duration, Lasting, Name, Rarity, SettingsTable
from rga.operation.sources.settings import AnySource, source_name
from rga.settings_files import read_table, validated

#: that a machine has
LARGEST_PORT = 65_535


def _address(given: Any) -> str:
    return str(ip_address(given))


def _named(given: Any) -> Any:
    if given == "":
        raise ValueError("name a folder, such as 'data'")
    return given


#: of a machine, as numbers
Address = Annotated[str, BeforeValidator(_address)]


class RowSettings(SettingsTable):
    """How rows are made of samples.

    Attributes:
        every: length of a cell [s], from which on a grid in UTC.
        statistic: of the samples of a cell.
        lateness: by which a source may send samples after others of later times [s].
        patience: after which a silent source is waited for no longer [s].
    """

    every: Duration = Field("60 s", validate_default=True)
    statistic: Literal["mean"] = "mean"
    lateness: Duration = Field("10 min", validate_default=True)
    patience: Duration = Field("30 min", validate_default=True)

    @property
    def grid(self) -> Grid:
        """The cells of the rows."""
        return Grid(round(self.every * MICROSECONDS), round(self.lateness * MICROSECONDS))


Source = Annotated[AnySource, Field(discriminator="kind")]


class RetentionSettings(SettingsTable):
    """How long what nobody needs any more is kept.

    Attributes:
        raw: packets, once rows were made of them [s]; None: for ever.
    """

    raw: Annotated[float, Lasting("7 d", "36525 d", examples=("30 d",))] | None = None


class TwinSettings(SettingsTable):
    """A twin that is served.

    Attributes:
        name: of it, in addresses and topics.
        model, settings: files, beside the configuration.
        seed: of everything random.
        false_alarms: of its monitor without a change, instead of `arl0` in its settings.
        rows: how they are made of samples.
        retention: how long packets are kept.
        source: where samples come from.
    """

    name: Name
    model: Path
    settings: Path
    seed: Annotated[int, Field(ge=0, lt=2**63, strict=True)] = 0
    false_alarms: Rarity | None = None
    rows: RowSettings = RowSettings()
    retention: RetentionSettings = RetentionSettings()
    source: Annotated[list[Source], Field(min_length=1)]

    @property
    def arl0(self) -> float | None:
        """Rows between false alarms; None: the settings say it."""
        if self.false_alarms is None:
            return None
        count, span = self.false_alarms
        return span / count / self.rows.every

    @model_validator(mode="after")
    def _rare_enough(self) -> "TwinSettings":
        rows = self.arl0
        if rows is not None and not LEAST <= rows <= MOST:
            raise ValueError(
                f"false_alarms: one in {rows:.0f} rows of {self.rows.every:g} s; "
                f"{LEAST:g} to {MOST:g} are possible"
            )
        return self

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
        certificate, key: files of TLS, beside the configuration; None: plain HTTP.
        trusted_proxies: addresses of proxies that are believed for whom they call.
        user_header: by which they say whom they have let in; None: they let nobody in.
        link: address of the pages as people reach them, for notices; None: that of `listen`.
    """

    listen: Annotated[str, Field(pattern=r"^(\[[0-9a-f:]+\]|[A-Za-z0-9.-]+):\d{1,5}$")] = (
        "127.0.0.1:8471"
    )
    data: Annotated[Path, BeforeValidator(_named)] = Path("data")
    repository: str | None = None
    certificate: Path | None = None
    key: Path | None = None
    trusted_proxies: tuple[Address, ...] = ()
    user_header: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9-]{0,63}$")] | None = None
    link: Annotated[str, Field(pattern=r"^https?://[^\s]+$")] | None = None

    @property
    def address(self) -> str:
        """Address of the pages, without a slash at its end."""
        secure = "s" if self.certificate is not None else ""
        return (self.link or f"http{secure}://{self.listen}").rstrip("/")

    @model_validator(mode="after")
    def _complete(self) -> "ServiceSettings":
        if (self.certificate is None) != (self.key is None):
            raise ValueError("certificate and key come together")
        if not 0 < int(self.listen.rpartition(":")[2]) <= LARGEST_PORT:
            raise ValueError(f"listen: ports go from 1 to {LARGEST_PORT}")
        if self.user_header is not None and not self.trusted_proxies:
            raise ValueError("user_header: anybody could send it; name a proxy in trusted_proxies")
        return self


class Configuration(SettingsTable):
    """A file of `rga serve`.

    Attributes:
        service: the service itself.
        alarms: when they are raised.
        notify: where notices of them go.
        twin: the twins.
    """

    service: ServiceSettings = ServiceSettings()
    alarms: AlarmSettings = AlarmSettings()
    notify: list[NotifySettings] = Field(default_factory=list)
    twin: Annotated[list[TwinSettings], Field(min_length=1)]

    @model_validator(mode="after")
    def _named_apart(self) -> "Configuration":
        names = [one.name for one in self.twin]
        if double := next((one for one in names if names.count(one) > 1), None):
            raise ValueError(f"two twins are called {double!r}: give each a name of its own")
        files = [one.name for one in self.notify]
        if double := next((one for one in files if files.count(one) > 1), None):
            raise ValueError(f"two tables notify have a url_file {double!r}: join or rename them")
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
