"""The mapping of a logger's file to the channels of a model: `import.toml`."""

import re
from datetime import UTC, datetime
from pathlib import Path
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    PrivateAttr,
    ValidationError,
    field_validator,
    model_validator,
)

from rga.bounded_files import bytes_of, fault_of, toml_of
from rga.errors import InputError, kind_of
from rga.no_booleans import NO_BOOLEAN

MAPPING_NAME = "import.toml"
#: lines above the rows of a file, by what writes it
HEAD_LINES = {"toa5": 4}
#: formats of times that are no patterns
TIMES = ("excel", "unix", "unix_ms", "unix_us", "unix_ns", "seconds")
#: begins a reason that `rga import-record` gave, and that nobody has confirmed
TO_CHECK = "TO CHECK"
_Finite = Annotated[float, Field(allow_inf_nan=False), NO_BOOLEAN]
_Positive = Annotated[float, Field(gt=0, allow_inf_nan=False), NO_BOOLEAN]
_Line = Annotated[int, Field(ge=1, strict=True)]
_Sign = Annotated[str, Field(min_length=1, max_length=1)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


def _as_words(stated: Any) -> Any:
    """Codes for a missing value as text: -9999 and "-9999" say the same."""
    if isinstance(stated, (list, tuple)):
        numbers = (int, float)
        return [
            f"{one:g}" if isinstance(one, numbers) and not isinstance(one, bool) else one
            for one in stated
        ]
    return stated


class TimeColumns(_Table):
    """Where the time stands.

    Attributes:
        columns: the columns that hold it, in the order in which `format` reads them.
        format: strptime pattern of the columns joined by a blank; `excel` for day numbers of a
            spreadsheet, `unix`, `unix_ms`, `unix_us` or `unix_ns` for time since 1970, `seconds`
            for seconds of any size; None: ISO 8601, seconds, or what the file itself tells beyond
            doubt.
        sampling_rate_hz: counts time by rows instead, from the first stamp on; a file without a
            time needs nothing else.
        zone: of stamps without one: a name such as "Europe/Berlin", or "+01:00".
        repeated_hour: what becomes of stamps of the hour that comes twice in `zone` where summer
            time ends: "guessed" from the rows about them, or "refused".
    """

    columns: list[str] = ["time"]
    format: str | None = None
    sampling_rate_hz: _Positive | None = None
    zone: str | None = None
    repeated_hour: Literal["guessed", "refused"] = "guessed"

    @field_validator("format")
    @classmethod
    def _reads_what_it_writes(cls, format: str | None) -> str | None:
        if format is None or format in TIMES:
            return format
        try:
            if "%" not in format:
                raise ValueError("it has no %")
            moment = datetime(2026, 11, 23, tzinfo=UTC)
            datetime.strptime(moment.strftime(format), format)
        except (ValueError, re.error) as error:
            known = ", ".join(TIMES)
            raise ValueError(f"{format!r} is no pattern ({error}), nor one of {known}") from None
        return format

    @field_validator("zone")
    @classmethod
    def _exists(cls, zone: str | None) -> str | None:
        if zone is not None:
            # What reads zones is large, and nothing else of a mapping needs it.
            from rga.records.times.zone import zone_of

            try:
                zone_of(zone, "zone")
            except InputError as error:
                raise ValueError(f"{error.what}: {error.remedy}") from None
        return zone

    @model_validator(mode="after")
    def _some_time(self) -> "TimeColumns":
        if not self.columns and self.sampling_rate_hz is None:
            raise ValueError("without columns, sampling_rate_hz is needed")
        return self


class Channel(_Table):
    """One channel: how the file has it.

    Attributes:
        column: its name in the file; its own name if left out.
        unit: in which the file has it; the file's own or the model's if left out.
        sign: -1 where the file counts the other way.
        missing: what stands for a missing value in this channel, beside those of the file.
    """

    column: str | None = None
    unit: str | None = None
    sign: Annotated[Literal[1, -1], NO_BOOLEAN] = 1
    missing: list[str] = []

    _missing_as_words = field_validator("missing", mode="before")(_as_words)

    @field_validator("column")
    @classmethod
    def _has_a_name(cls, column: str | None) -> str | None:
        if column is not None and not column.strip():
            raise ValueError("name the column, or leave it out where it is called as the channel")
        return column


class FileMapping(_Table):
    """How files of one logger are read; what a file tells of itself needs no key.

    Attributes:
        files: the files, in time, beside import.toml; names may have * for any text.
        logger: that writes them, where a file is read while it grows: "toa5" has four lines above
            its rows.
        delimiter: what separates the columns of a text file; None: found.
        encoding: of a text file, such as "cp1252"; None: found.
        decimal, thousands: signs in numbers; None: found.
        header_line: line of the column names, counted from 1; None: found.
        units_line: line of the units; None: found below the names, or in them.
        data_line: line of the first row; None: below names and units.
        block: which of several tables of a file, counted from 1.
        missing: what stands for a missing value, such as "-9999".
        empty: what a channel is whose column holds no value: "refused", or "missing".
        unknown: what a column is that the model has no channel for: "refused", or "unused".
        header: pattern of the column names, such as "{channel} ({unit})"; None: channel names, or
            names with the unit in brackets behind them.
        time: where the time stands.
        channels: by sensor or context variable of the model, where the file differs from it.
        unused: channel -> reason why it is left out; a sensor without a column stands here too.

    >>> FileMapping(header="{channel} ({unit})").channel_of("d5 (mm)")
    ('d5', 'mm')
    """

    files: list[str] = []
    logger: Literal["toa5"] | None = None
    delimiter: _Sign | None = None
    encoding: str | None = None
    decimal: Literal[".", ","] | None = None
    thousands: _Sign | None = None
    header_line: _Line | None = None
    units_line: _Line | None = None
    data_line: _Line | None = None
    block: _Line | None = None
    missing: list[str] = []
    empty: Literal["refused", "missing"] = "refused"
    unknown: Literal["refused", "unused"] = "refused"
    header: str | None = None
    time: TimeColumns = TimeColumns()
    channels: dict[str, Channel] = {}
    unused: dict[str, Annotated[str, Field(min_length=1)]] = {}

    _missing_as_words = field_validator("missing", mode="before")(_as_words)

    @field_validator("encoding")
    @classmethod
    def _known(cls, encoding: str | None) -> str | None:
        if encoding is not None:
            try:
                "".encode(encoding)
            except LookupError:
                raise ValueError(f"{encoding!r} is no encoding that is known") from None
        return encoding

    @field_validator("header")
    @classmethod
    def _names_the_channel(cls, header: str | None) -> str | None:
        if header is not None and (header.count("{channel}") != 1 or header.count("{unit}") > 1):
            raise ValueError("write {channel} once, and {unit} at most once")
        return header

    @model_validator(mode="after")
    def _lines_follow(self) -> "FileMapping":
        header, data = self.header_line or 1, self.data_line
        if data is not None and data <= max(header, self.units_line or 1):
            raise ValueError("data_line must be below header_line and units_line")
        if self.decimal is not None and self.decimal in (self.thousands, self.delimiter):
            other = "thousands" if self.decimal == self.thousands else "delimiter"
            raise ValueError(f"decimal and {other} are the same sign")
        return self

    @model_validator(mode="after")
    def _every_column_is_of_one(self) -> "FileMapping":
        named: dict[str, str] = {}
        for name, one in self.channels.items():
            if one.column in named:
                both = f"the channels {named[one.column]!r} and {name!r} both name the column"
                raise ValueError(f"{both} {one.column!r}: name another for one of them")
            if one.column is not None:
                named[one.column] = name
        return self

    @property
    def left_out(self) -> dict[str, str]:
        """What is unused, but for what is still to be checked and what `channels` names since.

        >>> FileMapping(
        ...     channels={"S1": {"column": "a"}, "S2": {"column": "b"}},
        ...     unused={"a": "TO CHECK: no name is like it", "b": "broken"},
        ... ).left_out
        {'b': 'broken'}
        """
        named = {name: one.column for name, one in self.channels.items() if one.column}
        claimed = {*named, *named.values()}
        return {
            name: reason
            for name, reason in self.unused.items()
            if not (name in claimed and reason.startswith(TO_CHECK))
        }

    @property
    def overruled(self) -> list[str]:
        """Channels that `channels` reads and `unused` leaves out all the same.

        >>> FileMapping(channels={"S1": {"column": "a"}}, unused={"S1": "broken"}).overruled
        ['S1']
        """
        left_out = self.left_out
        return [name for name, one in self.channels.items() if {name, one.column} & {*left_out}]

    @property
    def head_lines(self) -> int:
        """Lines above the first row of a text file that grows.

        >>> FileMapping(logger="toa5").head_lines, FileMapping(units_line=2).head_lines
        (4, 2)
        """
        if self.data_line is not None:
            return self.data_line - 1
        if self.logger is not None:
            return HEAD_LINES[self.logger]
        return max(self.header_line or 1, self.units_line or 1)

    def channel_of(self, column: str) -> tuple[str, str | None]:
        """Channel and unit that a column's name states by the header pattern."""
        if self.header is not None:
            pattern = re.escape(self.header)
            for key in ("channel", "unit"):
                pattern = pattern.replace(re.escape(f"{{{key}}}"), f"(?P<{key}>.+?)")
            if found := re.fullmatch(pattern, column):
                return found["channel"], found.groupdict().get("unit")
        return column, None


class Beside(FileMapping):
    """Files of another logger, whose rows are matched to those of the record.

    Attributes:
        match: `nearest`: the row nearest in time; `interpolate`: between the rows before and after;
            `mean`: the mean of the rows about each row of the slower logger, which then has the
            rows of the record.
        tolerance_s: greatest distance in time of a match; None: half the usual step of the slower
            of the two for `nearest`, one and a half of this logger for `interpolate`.
        shift_s: added to the times of this logger, whose clock is late by as much.
    """

    match: Literal["nearest", "interpolate", "mean"] = "nearest"
    tolerance_s: _Positive | None = None
    shift_s: _Finite = 0.0

    @model_validator(mode="after")
    def _some_files(self) -> "Beside":
        if not self.files:
            raise ValueError('files of the other logger are needed: files = ["..."]')
        return self


class RecordMapping(FileMapping):
    """What a logger's file means, as `import.toml` says it.

    Attributes:
        zero: interval [s since the first row] whose mean is taken off, or "lead-in": found.
        beside: files of other loggers, side by side with those of this one.
    """

    zero: Literal["lead-in"] | tuple[_Finite, _Finite] | None = None
    beside: list[Beside] = []

    _path: Path = PrivateAttr(default=Path(MAPPING_NAME))

    @model_validator(mode="after")
    def _zero_grows(self) -> "RecordMapping":
        if isinstance(self.zero, tuple) and not self.zero[0] < self.zero[1]:
            raise ValueError("zero must be [from, to] with from < to")
        return self

    @property
    def folder(self) -> Path:
        """Where the files stand that it names: its own folder."""
        return self._path.parent

    @property
    def path(self) -> Path:
        """Its file, or what that is to be called where it was made by a program."""
        return self._path


def mapping_schema() -> dict[str, Any]:
    """JSON Schema of a mapping, `import.toml`.

    >>> mapping_schema()["title"]
    'import.toml'
    """
    schema = RecordMapping.model_json_schema()
    draft = "https://json-schema.org/draft/2020-12/schema"
    return {"$schema": draft, **schema, "title": MAPPING_NAME}


def read_mapping(path: str | Path) -> RecordMapping:
    """Read a mapping file.

    Raises:
        InputError: the file is missing, is no TOML, or has an unknown key or a wrong value.
    """
    if not isinstance(path, (str, Path)):
        what = f"{kind_of(path)} is no mapping"
        raise InputError(what, "mapping", "give a RecordMapping, or the path of its file")
    path = Path(path)
    try:
        content = bytes_of(path, "mapping").decode("utf-8-sig")
    except UnicodeDecodeError:
        raise InputError("the mapping is no UTF-8", str(path), "save it as UTF-8") from None
    return mapping_of(content, path)


def mapping_of(content: str, path: Path) -> RecordMapping:
    """The mapping that a text says.

    Args:
        content: TOML.
        path: where it stands, or is to stand: files are named from there.

    Raises:
        InputError: it is no TOML, or has an unknown key or a wrong value.
    """
    try:
        mapping = RecordMapping.model_validate(toml_of(content))
    except ValidationError as error:
        raise _explained(error, str(path)) from None
    except (ValueError, RecursionError) as error:
        raise InputError(
            f"the mapping is no TOML: {fault_of(error)}", str(path), "mend the syntax"
        ) from None
    mapping._path = path
    return mapping


def find_mapping(record: Path, model: Path | None) -> Path | None:
    """The mapping beside the record, else beside the model, if there is one."""
    beside = [record.parent / MAPPING_NAME] + ([model.parent / MAPPING_NAME] if model else [])
    return next((path for path in beside if path.is_file()), None)


def _explained(error: ValidationError, where: str) -> InputError:
    first = error.errors(include_url=False)[0]
    key = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        tables: dict[str, type[_Table]] = {"time": TimeColumns, "channels": Channel}
        kind: type[_Table] = Beside if first["loc"][0] == "beside" else RecordMapping
        for part in first["loc"][:-1]:
            kind = tables.get(str(part), kind)
        known = ", ".join(kind.model_fields)
        return InputError(f"the key {key!r} is unknown", where, f"known are {known}")
    message = first["msg"].removeprefix("Value error, ")
    return InputError(f"{key or 'mapping'}: {message}", where, "correct the value")
