"""Whether a command can be meant, as far as that is known when it is asked for."""

from collections.abc import Mapping
from datetime import datetime
from typing import Any

from rga.dashboard.api.served import moment_in_utc
from rga.dashboard.surroundings import SeenTwin
from rga.operation.reading.twin_now import TwinNow
from rga.operation.settings_types import is_readable
from rga.twin.commands.command import Accept, AnyCommand, Exclude, Note, Reject, Rollback


def unreadable(command: Mapping[str, Any]) -> str | None:
    """What of the words of a command nobody could read, in words; None: nothing.

    >>> unreadable({"why": "a\\0b"}), unreadable({"why": " "}), unreadable({"kind": "accept"})
    ('why: it has a control character', 'why: say why, or leave it out', None)
    """
    for name, words in command.items():
        if isinstance(words, str) and not is_readable(words):
            return f"{name}: it has a control character"
    why = command.get("why")
    if isinstance(why, str) and not why.strip():
        return "why: say why, or leave it out"
    return None


def about(command: AnyCommand, seen: SeenTwin, now: TwinNow | None) -> AnyCommand:
    """A command about what whoever asks has seen: a later version or proposal is another matter."""
    update: dict[str, Any] = {}
    if isinstance(command, Accept | Reject | Rollback) and command.version_seen is None and now:
        # Of two who decide at once about the same version, the second is told.
        update["version_seen"] = now.version or None
    if isinstance(command, Accept | Reject) and command.proposal is None:
        proposals = seen.reading.proposals()
        update["proposal"] = proposals[-1].number if proposals else None
    return command.model_copy(update=update)


def impossible(command: AnyCommand, seen: SeenTwin, now: TwinNow | None) -> str | None:
    """Why a twin will refuse a command, in words; None: that is not known before it tries.

    What waits to be carried out is not looked at, nor what was decided: of two who decide at once,
    the second is told by the twin, and both stand in its log.
    """
    if isinstance(command, Accept | Reject):
        last = max((one.number for one in seen.reading.proposals()), default=0)
        if not last:
            return f"nothing is proposed that could be {command.kind}ed"
        if command.proposal is not None and command.proposal > last:
            return f"there is no proposal {command.proposal}: the last is {last}"
    named = [command.version_seen, command.version if isinstance(command, Rollback) else None]
    if any(one is not None for one in named):
        view = seen.reading.view()
        known = [] if view is None else [one.number for one in view.versions()]
        if lacking := [one for one in named if one is not None and one not in known]:
            told = ", ".join(map(str, known)) or "none yet"
            return f"there is no version {lacking[0]}: there is {told}"
    if isinstance(command, Note) and not command.why:
        return "a note has words: write them as why"
    if isinstance(command, Exclude):
        return _impossible_exclusion(command, seen, now)
    return None


def _impossible_exclusion(command: Exclude, seen: SeenTwin, now: TwinNow | None) -> str | None:
    if command.sensor not in seen.served.model.sensors:
        return f"there is no sensor {command.sensor!r}"
    times: dict[str, datetime | None] = {
        "since": None if now is None else now.time,
        "until": None,
    }
    for name, moment in (("since", command.since), ("until", command.until)):
        if moment is not None:
            try:
                times[name] = moment_in_utc(moment)
            except ValueError as error:
                return f"{name}: {error}"
    since, until = times["since"], times["until"]
    if since is not None and until is not None and until <= since:
        return "until: it ends before it begins"
    return None
