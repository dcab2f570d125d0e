"""`rga replay`: the log of the twin."""

from pathlib import Path
from typing import Annotated

import typer

from rga.cli.operation.running_service import ServiceClient, is_service
from rga.cli.options import JsonTarget, whole
from rga.quantities import plain

#: damage that is listed, and entries of the log of a service
MOST, MOST_OF_SERVICE = 5, 1000

Place = Annotated[
    str,
    typer.Argument(
        metavar="DIR", help="Directory of a run, a database by URL, or http://host:port/twin."
    ),
]
Row = Annotated[
    int | None,
    typer.Option(
        "--row", metavar="N", parser=whole(0, 2**53), help="As it stood at this row of the record."
    ),
]
Time = Annotated[
    str | None,
    typer.Option(
        "--time",
        help="As it stood at this time: a date as in the record, such as 2026-03-01T12:00, or "
        "seconds since the first row.",
    ),
]


Check = Annotated[
    bool, typer.Option("--check", help="Prove first that all that is kept is what was written.")
]


def replay(
    place: Place,
    row: Row = None,
    time: Time = None,
    check: Check = False,
    json: JsonTarget = None,
) -> None:
    """Replay the log of queries and responses, and check that it leads to where the twin stands."""
    from rga.cli.output import write_json
    from rga.errors import InputError
    from rga.twin import Twin

    if is_service(place):
        _replay_served(place, row, time, check, json)
        return
    if row is not None and time is not None:
        raise InputError("both --row and --time are given", "options", "give one of them")
    proved = _proved(place) if check else ""
    if check and not _played(place):
        typer.echo(f"{proved} No repository is beside it.")
        return
    with Twin.open(place) as twin:
        if row is not None or time is not None:
            twin = twin.as_of(row=row, time=None if time is None else _moment(time))
        log = twin.log()
        state = {
            "version": twin.version,
            "row": twin.state.row,
            "context": dict(twin.context),
            "effects": twin.state.versions.get(twin.version, {}),
        }
    if json is not None:
        entries = [{"row": at, "messages": kinds, "words": words} for at, kinds, words in log]
        write_json({"log": entries, "twin": state}, json)
    if json == "-":
        return
    for at, kinds, words in log:
        typer.echo(f"row {at:>6}  {kinds}  {words}")
    if proved:
        typer.echo(proved)
    where = "before its first row" if state["row"] is None else f"at row {state['row']}"
    typer.echo(f"The twin stands {where}, with model version {state['version']}.")


def _replay_served(
    place: str, row: int | None, time: str | None, check: bool, json: str | None
) -> None:
    """Replay the latest part of the log of a twin of a service."""
    from rga.cli.output import write_json
    from rga.errors import InputError

    if row is not None or time is not None or check:
        remedy = "leave out --row, --time and --check, or name its directory"
        raise InputError("a service shows its log as it stands now", place, remedy)
    client = ServiceClient(place)
    log, now = client.get("/log", {"last": MOST_OF_SERVICE}), client.get()["now"]
    if json is not None:
        write_json({"log": log, "twin": now}, json)
    if json == "-":
        return
    for one in log:
        typer.echo(f"row {one['row']:>6}  {one['messages']}  {one['words']}")
    typer.echo(f"The twin stands at row {now['rows'] - 1}, with model version {now['version']}.")


def _proved(place: str) -> str:
    """That a repository is whole, in words.

    Raises:
        InputError: it is not.
    """
    from contextlib import closing

    from rga.errors import InputError
    from rga.twin.hardware.inbox import INBOX, Inbox
    from rga.twin.hardware.interface import LIVE
    from rga.twin.repository import Repository
    from rga.twin.repository.faults import Damaged
    from rga.twin.repository.proof import Proof

    played, waits = _played(place), Path(place, INBOX).is_file()
    alone = ""
    try:
        proof = Proof(0, ())
        if played:
            with Repository.open(place, read_only=True) as repository:
                proof = repository.check()
                fed = any(run.identity.source.startswith(LIVE) for run in repository.runs())
            if fed and not waits:
                alone = f" Its {INBOX} is not there: rows that waited in it are not proved."
        if waits:
            with closing(Inbox(Path(place), read_only=True)) as inbox:
                waiting = inbox.check()
            proof = Proof(proof.entries + waiting.entries, (*proof.damage, *waiting.damage))
    except Damaged as error:
        proof = Proof(0, (error.what,))
    if not proof.damage:
        what = "repository" if played else "inbox"
        return f"The {what} is whole: all {proof.entries} entries are what was written.{alone}"
    listed, more = "; ".join(proof.damage[:MOST]), len(proof.damage) - MOST
    raise InputError(
        f"it is not whole: {listed}{f'; and {more} more' if more > 0 else ''}",
        place,
        "restore it from a copy; rga export saves rows that were taken in and can be read",
    )


def _played(place: str) -> bool:
    """False where rows wait for a twin that has not taken any in."""
    from rga.twin.hardware.inbox import INBOX
    from rga.twin.repository.database import FILE_NAME

    return not Path(place, INBOX).is_file() or Path(place, FILE_NAME).exists()


def _moment(text: str) -> float | str:
    """Seconds where the text is a number, else the text."""
    try:
        return float(plain(text))
    except ValueError:
        return text
