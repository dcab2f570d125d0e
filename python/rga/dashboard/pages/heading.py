"""What stands on top of every page of a twin."""

from dataclasses import dataclass, replace

from rga.dashboard.surroundings import Feed, SeenTwin
from rga.dashboard.twin_health import TwinHealth, damaged, health_of, state_of
from rga.errors import InputError
from rga.operation.reading.twin_now import TwinNow
from rga.twin.commands.command import AnyCommand, Command

#: pages of a twin: the end of their address, and what they are called
TABS = {
    "": "Bridge",
    "/sensors": "Sensors",
    "/alarms": "Alarms",
    "/causes": "Causes",
    "/versions": "Versions",
    "/queries": "Queries",
    "/data": "Data",
}


@dataclass(frozen=True)
class Heading:
    """What stands on top of every page of a twin.

    Attributes:
        twin: its name in the service.
        structure: name of the structure.
        state: how it is.
        waiting: what people have asked for and nothing has carried out yet, in words.
        state_now: how it is now, where `state` is that of a time before; None: it is that of now.
    """

    twin: str
    structure: str
    state: TwinHealth
    waiting: tuple[str, ...]
    state_now: TwinHealth | None = None


def heading(seen: SeenTwin, now: TwinNow | None) -> Heading:
    """The heading of a twin that can be read."""
    return Heading(
        seen.name,
        seen.served.model.name,
        health_of(seen, now),
        tuple(map(command_words, seen.waiting())),
    )


def heading_as_of(seen: SeenTwin, then: TwinNow | None, latest: TwinNow) -> Heading:
    """The heading of a twin as it stood at a time, beside how it is now."""
    now = heading(seen, latest)
    # What was late or silent then is not kept: the state is that of its rows.
    return replace(now, state=state_of(then, Feed()), waiting=(), state_now=now.state)


def heading_of_damaged(seen: SeenTwin, error: InputError) -> Heading:
    """The heading of a twin that cannot be read."""
    return Heading(seen.name, seen.served.model.name, damaged(str(error)), ())


def command_words(command: AnyCommand) -> str:
    """What somebody asks for, in words.

    >>> from rga.twin import Accept, Note
    >>> command_words(Accept(who="Ada", proposal=2)), command_words(Note(who="Ada", why="greased"))
    ('accept, proposal 2, asked by Ada', 'note, asked by Ada: greased')
    """
    about = command.model_dump(exclude={"kind", *Command.model_fields}, exclude_none=True)
    said = [command.kind, *(f"{name} {value}" for name, value in about.items())]
    why = f": {command.why}" if command.why else ""
    return f"{', '.join(said)}, asked by {command.who}{why}"
