"""What people ask a twin for: every command says who asks, and why, and stays in its log."""

from datetime import UTC, datetime
from typing import Annotated, Any, Literal

from pydantic import (
    BaseModel,
    ConfigDict,
    Field,
    TypeAdapter,
    ValidationError,
    field_validator,
)

from rga.errors import InputError
from rga.model.effect import check_moment

#: where an error about one is
PLACE = "command"
Moment = float | str
Number = Annotated[int, Field(ge=1, strict=True)]


def _now() -> str:
    return datetime.now(UTC).isoformat()


class Command(BaseModel):
    """Something that a twin is asked for.

    Attributes:
        who: asks.
        why: in words.
        given_at: wall clock, UTC, as ISO 8601 text.
        version_seen: number of the version in force that whoever asks has seen: where another is
            by then, the command is refused. None: it is carried out whatever is in force.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)

    who: Annotated[str, Field(min_length=1, max_length=200)]
    why: Annotated[str, Field(max_length=20_000)] = ""
    given_at: str = Field(default_factory=_now)
    version_seen: Number | None = None

    def __init__(self, **given: Any) -> None:
        """A command of values.

        Raises:
            InputError: a value is missing, or none that can be.
        """
        try:
            super().__init__(**given)
        except ValidationError as error:
            first = error.errors(include_url=False)[0]
            key = ".".join(str(one) for one in first["loc"]) or "it"
            keys = ", ".join(one for one in type(self).model_fields if one != "kind")
            raise InputError(f"{key}: {first['msg']}", PLACE, f"its values are {keys}") from None

    @field_validator("who", "why")
    @classmethod
    def _in_one_line(cls, words: str) -> str:
        return "".join(sign for sign in " ".join(words.split()) if sign.isprintable())


class Accept(Command):
    """Let what a diagnosis proposed become a version of the twin.

    Attributes:
        proposal: its number; None: the last.
    """

    kind: Literal["accept"] = "accept"
    proposal: Number | None = None


class Reject(Command):
    """Leave the twin as it is, whatever a diagnosis proposed.

    Attributes:
        proposal: its number; None: the last.
    """

    kind: Literal["reject"] = "reject"
    proposal: Number | None = None


class Rollback(Command):
    """Put an earlier model version in force again."""

    kind: Literal["rollback"] = "rollback"
    version: Number


class Exclude(Command):
    """Use no readings of a sensor between two times; rows that were followed stay as they are.

    Attributes:
        sensor: its name.
        since, until: from when to when, as the rows write time; None: from now on, for good.
    """

    kind: Literal["exclude"] = "exclude"
    sensor: str
    since: Moment | None = None
    until: Moment | None = None

    @field_validator("since", "until")
    @classmethod
    def _a_time(cls, moment: Moment | None) -> Moment | None:
        if moment is not None:
            check_moment(moment)
        return moment


class Recalibrate(Command):
    """Learn from the latest rows now, whatever the policy says."""

    kind: Literal["recalibrate"] = "recalibrate"


class Forget(Command):
    """Keep the readings of the latest rows alone from now on, beside those of the calibration.

    Forgotten for good are readings, what was simulated for them, and gaps. Times, contexts, the
    log, events, findings and versions stay, and so do rows that an alarm is about.

    Attributes:
        keep: rows whose readings stay; None: nothing more is forgotten.
    """

    kind: Literal["forget"] = "forget"
    keep: Number | None


class Note(Command):
    """Write something into the log."""

    kind: Literal["note"] = "note"


AnyCommand = Accept | Reject | Rollback | Exclude | Recalibrate | Forget | Note

_ADAPTER: TypeAdapter[AnyCommand] = TypeAdapter(Annotated[AnyCommand, Field(discriminator="kind")])


def read_command(text: str) -> AnyCommand:
    """A command from the text that `model_dump_json` makes.

    Raises:
        pydantic.ValidationError: it is none.

    >>> read_command(Rollback(who="Ada", version=1).model_dump_json()).version
    1
    """
    return _ADAPTER.validate_json(text)
