"""`rga feed`: a logger to try a service with."""

import os
import re
from collections.abc import Mapping, Sequence
from datetime import datetime
from math import inf
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.options import JsonTarget, decimal, whole

if TYPE_CHECKING:
    from rga.operation.feeding.senders import Sender


def _stream_name(text: str) -> str:
    """A name that packets may have, before anything is sent."""
    from rga.operation.packets.native import STREAM_PATTERN

    if re.fullmatch(STREAM_PATTERN, text) is None:
        raise typer.BadParameter(f"{text!r} is no name of a stream: take 64 of A-Z a-z 0-9 . _ -")
    return text


RecordFile = Annotated[Path, typer.Argument(metavar="RECORD", help="A logger's file.")]
MappingFile = Annotated[
    Path | None,
    typer.Option(
        "--import",
        metavar="FILE",
        help="How to read the record; left out, import.toml beside it.",
    ),
]
Target = Annotated[
    str,
    typer.Option(
        "--to",
        metavar="URL",
        help="http://host:port/TWIN, mqtt://host:port/rga/v1/TWIN/data/LOGGER, or a folder.",
    ),
]
Start = Annotated[
    str | None,
    typer.Option("--start", metavar="TIME", help="Of the first row, with a zone, in place of its."),
]
Rows = Annotated[
    int,
    typer.Option(
        "--rows",
        metavar="N",
        parser=whole(1),
        help="Rows of a packet, which is of a minute at most.",
    ),
]
Speed = Annotated[
    float | None,
    typer.Option(
        "--speed",
        metavar="X",
        parser=decimal(1e-6),
        help="Times as fast as it was measured; left out, as fast as it goes.",
    ),
]
FaultsFile = Annotated[
    Path | None,
    typer.Option("--faults", metavar="FILE", help="What goes wrong; `rga schema faults`."),
]
Stream = Annotated[
    str | None,
    typer.Option(
        "--stream",
        metavar="NAME",
        parser=_stream_name,
        help="Of the packets: the same goes on where it was stopped.",
    ),
]
Source = Annotated[
    str, typer.Option("--source", metavar="NAME", help="Of the twin, where a broker is between.")
]
Credentials = Annotated[
    Path | None,
    typer.Option("--credentials", metavar="FILE", help="User and password of the broker, by line."),
]


def feed(
    record: RecordFile,
    to: Target,
    mapping: MappingFile = None,
    start: Start = None,
    rows: Rows = 1,
    speed: Speed = None,
    faults: FaultsFile = None,
    stream: Stream = None,
    source: Source = "mqtt",
    credentials: Credentials = None,
    json: JsonTarget = None,
) -> None:
    """Play a record as a logger would send it, with faults that are drawn from a seed.

    Packets are numbered, and sent again until the service has said that they are on its disk. Where
    it can use none of them, the command fails. A token for the service is read from the
    environment: RGA_TOKEN.
    """
    from rga.cli.output import write_json
    from rga.cli.progress import shown_progress
    from rga.operation.feeding.faults import Faults, read_faults
    from rga.operation.feeding.player import play
    from rga.operation.feeding.senders import HttpSender
    from rga.operation.feeding.sent_record import sent_record
    from rga.quantities import counted
    from rga.records.mapping import RecordMapping, find_mapping, read_mapping

    found = mapping or find_mapping(record, None)
    chosen = RecordMapping() if found is None else read_mapping(found)
    drawn = Faults() if faults is None else read_faults(faults)
    sent = sent_record(record, chosen, None if start is None else _moment(start), stream)
    sender = _sender(to, source, credentials)
    with shown_progress() as progress:
        counts = play(
            sent, sender, rows, speed or inf, drawn, lambda share: progress("sending", share)
        )
    # What is sent by another way nobody answers.
    refused = sender.refused if isinstance(sender, HttpSender) else {}
    if json is not None:
        known = {"refused": len(refused)} if isinstance(sender, HttpSender) else {}
        write_json({"stream": sent.stream, **counts, **known}, json)
    if json != "-":
        typer.echo(
            f"{counted(len(sent.times), 'row')} went out as stream {sent.stream}, "
            f"in {_in_words(counts)}."
        )
    if refused:
        _tell_refused([*refused.values()], counts["packet"] + counts["late"], to)


def _in_words(counts: Mapping[str, int]) -> str:
    """What was sent.

    >>> _in_words({"packet": 9, "late": 1, "garbage": 2})
    '10 packets, of which 1 was late, and 2 payloads of garbage besides'
    """
    from rga.quantities import counted

    late, double, garbage = (counts.get(kind, 0) for kind in ("late", "duplicate", "garbage"))
    words = counted(counts.get("packet", 0) + late, "packet")
    words += f", of which {late} {'was' if late == 1 else 'were'} late" if late else ""
    more = [f"{counted(double, 'packet')} sent twice"] if double else []
    more += [f"{counted(garbage, 'payload')} of garbage"] if garbage else []
    return f"{words}, and {' and '.join(more)} besides" if more else words


def _tell_refused(reasons: Sequence[str], packets: int, place: str) -> None:
    """Say how many packets a service could not use, and why.

    Raises:
        InputError: it could use none.
    """
    from rga.errors import InputError

    why, others = reasons[0], len(set(reasons)) - 1
    more = f", and for {others} other reasons" if others else ""
    what = f"{len(reasons)} of {packets} packets were refused: {why}{more}"
    if len(reasons) == packets:
        raise InputError(what, place, "mend what it says; the packets are kept aside")
    _told(f"warning: {what}")


def _told(words: str) -> None:
    typer.echo(words, err=True)


def _sender(to: str, source: str, credentials: Path | None) -> "Sender":
    from rga.errors import InputError
    from rga.operation.feeding.senders import BrokerSender, FolderSender, HttpSender
    from rga.operation.sources.secrets import credentials_of

    if to.startswith(("http://", "https://")):
        return HttpSender(to, os.environ.get("RGA_TOKEN"), _told)
    if to.startswith(("mqtt://", "mqtts://")):
        known = None if credentials is None else credentials_of(credentials)
        return BrokerSender(to, source, known, _told)
    folder = Path(to)
    if not folder.is_dir():
        raise InputError("there is no such folder", to, "make it, or give http:// or mqtt://")
    return FolderSender(folder)


def _moment(text: str) -> datetime:
    try:
        moment = datetime.fromisoformat(text)
    except ValueError:
        raise typer.BadParameter(f"{text!r} is no time: write 2026-11-23T00:00:00Z") from None
    if moment.tzinfo is None:
        raise typer.BadParameter(f"{text!r} has no zone: write 2026-11-23T00:00:00Z")
    return moment
