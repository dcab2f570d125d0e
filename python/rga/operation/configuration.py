"""What `rga serve` does: its twins, where their data comes from, and how rows are made of it."""

import re
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Any, Literal
from urllib.parse import urlsplit

from pydantic import BaseModel, BeforeValidator, ConfigDict, Field, model_validator

from rga.operation.packets.packet import MICROSECONDS
from rga.operation.rows.grid import Grid
from rga.operation.sources.clock import ClockRule
from rga.settings_files import read_table, validated

_SIZES = {"ms": 1e-3, "s": 1.0, "min": 60.0, "h": 3600.0, "d": 86_400.0}
_DURATION = re.compile(rf"(\d+(?:\.\d+)?) ?({'|'.join(_SIZES)})")


def duration_of(given: Any) -> float:
    """Seconds of a duration, as people write it.

    Raises:
        ValueError: it is none.

    >>> duration_of("10 min"), duration_of("0.5 s")
    (600.0, 0.5)
    """
    found = _DURATION.fullmatch(given) if isinstance(given, str) else None
    if found is None:
        raise ValueError(f"{given!r} is no duration: write '60 s', '10 min', '2 h' or '7 d'")
    return float(found[1]) * _SIZES[found[2]]


Duration = Annotated[float, BeforeValidator(duration_of), Field(gt=0, le=366 * 86_400)]
#: as it stands in addresses, topics and names of folders
NAME_PATTERN = r"^[A-Za-z0-9][A-Za-z0-9_-]{0,63}$"
Name = Annotated[str, Field(pattern=NAME_PATTERN)]


def _address(given: Any) -> str:
    return str(ip_address(given))


#: of a machine, as numbers
Address = Annotated[str, BeforeValidator(_address)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class RowSettings(_Table):
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


class ClockSettings(_Table):
    """What is believed of the clock of a logger.

    Attributes:
        check: False: all, as where a record is played faster than it was measured.
        tolerance: by which it may be ahead of that of this machine [s].
        backlog: how long before they arrive readings may be from [s].
    """

    check: bool = True
    tolerance: Duration = 1800.0
    backlog: Duration = 7 * 86_400.0

    @property
    def rule(self) -> ClockRule | None:
        """None: all is believed."""
        return ClockRule(self.tolerance, self.backlog) if self.check else None


class _Source(_Table):
    """What every source states.

    Attributes:
        name: by which it is accounted for; left out, its kind.
        mapping: import.toml of the logger, beside the configuration.
        clock: what is believed of its clock.
    """

    name: Name | None = None
    mapping: Path | None = None
    clock: ClockSettings = ClockSettings()


class HttpSource(_Source):
    """Loggers that send to this service."""

    kind: Literal["http"]


class MqttSource(_Source):
    """A broker that loggers send to.

    Attributes:
        url: mqtt:// or mqtts://, host and port.
        topics: that hold data; + and # as in MQTT.
        credentials: file of two lines, user and password.
    """

    kind: Literal["mqtt"]
    url: str
    topics: Annotated[list[str], Field(min_length=1)]
    credentials: Path | None = None

    @model_validator(mode="after")
    def _broker(self) -> "MqttSource":
        parts = urlsplit(self.url)
        if parts.scheme not in ("mqtt", "mqtts") or not parts.hostname:
            raise ValueError(f"{self.url!r} is no broker: write mqtt://host:1883")
        if parts.username or parts.password:
            raise ValueError("url holds a password: name a file of credentials instead")
        return self


class FolderSource(_Source):
    """A folder that files are written to.

    Attributes:
        path: of it.
        files: names of the files, * for any text.
        poll: how often it is looked at [s].
    """

    kind: Literal["folder"]
    path: Path
    files: str = "*"
    poll: Duration = 5.0


Source = Annotated[HttpSource | MqttSource | FolderSource, Field(discriminator="kind")]


class TwinSettings(_Table):
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


def source_name(source: HttpSource | MqttSource | FolderSource) -> str:
    """Name of a source in its twin."""
    return source.name or source.kind


class ServiceSettings(_Table):
    """The service itself.

    Attributes:
        listen: address and port of the API and the pages.
        data: folder of the twins, beside the configuration.
        repository: URL of a PostgreSQL database for the repositories; None: they are in `data`.
        certificate, key: files of TLS, beside the configuration; None: plain HTTP.
        trusted_proxies: addresses of proxies that are believed for whom they call.
        user_header: by which they say whom they have let in; None: they let nobody in.
    """

    listen: Annotated[str, Field(pattern=r"^(\[[0-9a-f:]+\]|[A-Za-z0-9.-]+):\d{1,5}$")] = (
        "127.0.0.1:8471"
    )
    data: Path = Path("data")
    repository: str | None = None
    certificate: Path | None = None
    key: Path | None = None
    trusted_proxies: tuple[Address, ...] = ()
    user_header: Annotated[str, Field(pattern=r"^[A-Za-z][A-Za-z0-9-]{0,63}$")] | None = None

    @model_validator(mode="after")
    def _complete(self) -> "ServiceSettings":
        if (self.certificate is None) != (self.key is None):
            raise ValueError("certificate and key come together")
        if self.user_header is not None and not self.trusted_proxies:
            raise ValueError("user_header: anybody could send it; name a proxy in trusted_proxies")
        return self


class Configuration(_Table):
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
