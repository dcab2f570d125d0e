"""Forms: what somebody asks a twin for, kept once however often it is sent."""

from collections.abc import Mapping
from typing import Any
from urllib.parse import parse_qs

from fastapi import HTTPException, Request

from rga.dashboard.api.possible import impossible, unreadable
from rga.dashboard.pages.times import given_moment
from rga.dashboard.surroundings import SeenTwin
from rga.errors import InputError
from rga.operation.inbox.requests import Requests
from rga.twin.commands.command import Accept, AnyCommand, Exclude, Reject, Rollback

#: fields of a form at most
MOST_FIELDS = 20
#: where errors are
PLACE = "form"


async def form_of(request: Request) -> dict[str, str]:
    """The fields of a form, each once."""
    body = await request.body()
    try:
        fields = parse_qs(body.decode(), keep_blank_values=True, max_num_fields=MOST_FIELDS)
    except ValueError:
        raise HTTPException(400, "this is no form") from None
    return {name: values[0] for name, values in fields.items()}


def ask(seen: SeenTwin, form: Mapping[str, str], who: str) -> None:
    """Keep what a form asks a twin for; whoever plays it carries it out.

    Raises:
        InputError: it asks for nothing that can be done, or its key was used for something else.
    """
    command = command_of(form, who)
    if not form.get("key"):
        raise InputError("the form has no key", PLACE, "load its page again")
    if wrong := unreadable({name: words for name, words in form.items() if words}):
        raise InputError(wrong, PLACE, "write it again")
    requests, asked = Requests(seen.served.inbox), f"{who} {form['key']}"
    compared = command.model_dump_json(exclude={"given_at"})
    if requests.known(asked, compared) is None:
        if lacking := impossible(command, seen, seen.reading.now()):
            raise InputError(lacking, PLACE, "load its page again")
        requests.ask(asked, command.model_dump_json(), compared)


def command_of(form: Mapping[str, str], who: str) -> AnyCommand:
    """The command of a form.

    Raises:
        InputError: it is none.

    >>> form = {"kind": "rollback", "version": "2", "version_seen": "3", "why": "calmer"}
    >>> command_of(form, "Ada").version
    2
    """
    given: dict[str, Any] = {"who": who, "why": form.get("why", "")}
    kind = form.get("kind", "")
    if kind in ("accept", "reject", "rollback"):
        # Of two who decide at once about the same version, the second is told.
        given["version_seen"] = _number(form, "version_seen")
    if kind == "accept":
        return Accept(**given, proposal=_number(form, "proposal"))
    if kind == "reject":
        return Reject(**given, proposal=_number(form, "proposal"))
    if kind == "rollback":
        return Rollback(**given, version=_number(form, "version"))
    if kind == "exclude":
        times = {name: _moment(form, name) for name in ("since", "until")}
        return Exclude(**given, sensor=form.get("sensor", ""), **times)
    raise InputError(f"there is no command {kind!r}", PLACE, "load its page again")


def _number(form: Mapping[str, str], name: str) -> int:
    text = form.get(name, "")
    if not text.isdecimal() or len(text) > 9:
        raise InputError(f"{text!r} is no number", f"{PLACE}, {name}", "give a whole number")
    return int(text)


def _moment(form: Mapping[str, str], name: str) -> str | None:
    text = form.get(name, "")
    if not text:
        return None
    found = given_moment(text)
    if found is None:
        raise InputError(f"{text!r} is no time", f"{PLACE}, {name}", "write 2026-03-01T12:00")
    return found.isoformat()
