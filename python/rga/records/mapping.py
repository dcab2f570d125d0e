"""The mapping of a logger's file to the channels of a model: `import.toml`."""

import re
import tomllib
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from rga.errors import InputError

MAPPING_NAME = "import.toml"
_Finite = Annotated[float, Field(allow_inf_nan=False)]


class _Table(BaseModel):
    model_config = ConfigDict(extra="forbid", frozen=True)


class TimeColumns(_Table):
    """Where the time stands.

    Attributes:
        columns: the columns that hold it, in the order in which `format` reads them.
        format: strptime pattern of the columns joined by a blank; None: ISO 8601 or seconds.
        sampling_rate_hz: counts time by rows instead, from the first stamp on.
    """

    columns: list[str] = ["time"]
    format: str | None = None
    sampling_rate_hz: Annotated[float, Field(gt=0, allow_inf_nan=False)] | None = None

    @model_validator(mode="after")
    def _some_time(self) -> "TimeColumns":
        if not self.columns and self.sampling_rate_hz is None:
            raise ValueError("without columns, sampling_rate_hz is needed")
        return self


class Channel(_Table):
    """One channel: its column (its own name if left out), its unit there, and its sign."""

    column: str | None = None
    unit: str | None = None
    sign: Literal[1, -1] = 1


class RecordMapping(_Table):
    """What a logger's file means, as `import.toml` says it.

    Attributes:
        delimiter: what separates the columns of a text file.
        header: pattern of the column names, such as "{channel} ({unit})"; None: channel names.
        time: where the time stands.
        channels: by sensor or context variable of the model, where the file differs from it.
        unused: channel -> reason why it is left out; a sensor without a column stands here too.
        zero: interval [s since the first row] whose mean is taken off, or "lead-in": found.

    >>> RecordMapping(header="{channel} ({unit})").channel_of("d5 (mm)")
    ('d5', 'mm')
    """

    delimiter: Annotated[str, Field(min_length=1, max_length=1)] = ","
    header: str | None = None
    time: TimeColumns = TimeColumns()
    channels: dict[str, Channel] = {}
    unused: dict[str, Annotated[str, Field(min_length=1)]] = {}
    zero: Literal["lead-in"] | tuple[_Finite, _Finite] | None = None

    @field_validator("header")
    @classmethod
    def _names_the_channel(cls, header: str | None) -> str | None:
        if header is not None and (header.count("{channel}") != 1 or header.count("{unit}") > 1):
            raise ValueError("write {channel} once, and {unit} at most once")
        return header

    @model_validator(mode="after")
    def _zero_grows(self) -> "RecordMapping":
        if isinstance(self.zero, tuple) and not self.zero[0] < self.zero[1]:
            raise ValueError("zero must be [from, to] with from < to")
        return self

    def channel_of(self, column: str) -> tuple[str, str | None]:
        """Channel and unit that a column's name states by the header pattern."""
        if self.header is not None:
            pattern = re.escape(self.header)
            for key in ("channel", "unit"):
                pattern = pattern.replace(re.escape(f"{{{key}}}"), f"(?P<{key}>.+?)")
            if found := re.fullmatch(pattern, column):
                return found["channel"], found.groupdict().get("unit")
        return column, None


def read_mapping(path: str | Path) -> RecordMapping:
    """Read a mapping file.

    Raises:
        InputError: the file is missing, is no TOML, or has an unknown key or a wrong value.
    """
    try:
        content = tomllib.loads(Path(path).read_text(encoding="utf-8"))
        return RecordMapping.model_validate(content)
    except OSError as error:
        reason = error.strerror or "unreadable"
        raise InputError(
            f"the mapping cannot be read, {reason.lower()}", str(path), "check the path"
        ) from None
    except ValidationError as error:
        raise _explained(error, str(path)) from None
    except ValueError as error:  # no TOML, or no UTF-8
        raise InputError(
            f"the mapping is no TOML: {' '.join(str(error).split())}", str(path), "mend the syntax"
        ) from None


def find_mapping(record: Path, model: Path | None) -> Path | None:
    """The mapping beside the record, else beside the model, if there is one."""
    beside = [record.parent / MAPPING_NAME] + ([model.parent / MAPPING_NAME] if model else [])
    return next((path for path in beside if path.is_file()), None)


def _explained(error: ValidationError, where: str) -> InputError:
    first = error.errors(include_url=False)[0]
    key = ".".join(str(part) for part in first["loc"])
    if first["type"] == "extra_forbidden":
        tables: dict[str, type[_Table]] = {"time": TimeColumns, "channels": Channel}
        known = ", ".join(tables.get(str(first["loc"][0]), RecordMapping).model_fields)
        return InputError(f"the key {key!r} is unknown", where, f"known are {known}")
    message = first["msg"].removeprefix("Value error, ")
    return InputError(f"{key or 'mapping'}: {message}", where, "correct the value")
