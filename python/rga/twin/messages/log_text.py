"""The log of queries and responses in words."""

from collections.abc import Iterator, Sequence

from rga.twin.history import Event
from rga.twin.messages.queries import Q1, Q2, Q3, Q4, Q5, R1, R2, R4, Query, Response

Message = Query | Response
Pair = tuple[Message, Message]
#: the tasks of the paper that events belong to
TASKS = {
    "alarm": "T1 alarm",
    "recall": "T1 recall",
    "recalibration": "T1 recalibration",
    "novel context": "T2 stored",
}


def retold(messages: Sequence[Message | Event]) -> Iterator[tuple[int, str, str]]:
    """Row, kinds and words of each exchange and event; packets in a row share a line.

    >>> from rga.twin.messages.queries import Box, Q2, R2
    >>> box = Box(low=(0.0,), high=(1.0,))
    >>> log = [Q2(row=0, version=1, box=box, wanted=9), R2(row=0, held=2, missing=7)]
    >>> next(retold(log))
    (0, 'Q2 R2', '9 simulations of version 1 wanted: 2 held, 7 missing')
    """
    for one in exchanges(messages):
        yield row_of(one), kinds_of(one), words_of(one)


def exchanges(messages: Sequence[Message | Event]) -> list[list[Pair] | Event]:
    """What belongs together: a query with its response, packets in a row, an event."""
    runs: list[list[Pair] | Event] = []
    query: Message | None = None
    for one in messages:
        if isinstance(one, Event):
            runs.append(one)
        elif query is None:
            query = one
        else:
            last = runs[-1] if runs else None
            if isinstance(last, list) and _continues(last[-1][0], query):
                last.append((query, one))
            else:
                runs.append([(query, one)])
            query = None
    return runs


def row_of(exchange: list[Pair] | Event) -> int:
    """The row of the record at which an exchange or an event passed, its first."""
    return exchange.row if isinstance(exchange, Event) else exchange[0][0].row


def kinds_of(exchange: list[Pair] | Event) -> str:
    """The kinds of query and response, or of an event."""
    if isinstance(exchange, Event):
        return TASKS.get(exchange.kind, exchange.kind)
    query, response = exchange[0]
    return f"{query.kind} {response.kind}"


def _continues(before: Message, query: Message) -> bool:
    if not isinstance(before, Q5) or not isinstance(query, Q5):
        return False
    return before.version == query.version and query.first == before.first + before.rows


def words_of(exchange: list[Pair] | Event) -> str:
    """An exchange or an event in words."""
    if isinstance(exchange, Event):
        return exchange.words
    query, response = exchange[0]
    if isinstance(query, Q1) and isinstance(response, R1):
        return _adequacy(query, response)
    if isinstance(query, Q2) and isinstance(response, R2):
        wanted = f"{query.wanted} simulations of version {query.version} wanted"
        return f"{wanted}: {response.held} held, {response.missing} missing"
    if isinstance(query, Q3):
        what = "for the design phase" if query.origin == "design" else "around novel contexts"
        return f"{query.rows} contexts simulated {what}"
    if isinstance(query, Q4) and isinstance(response, R4):
        rows = f"{response.simulated_rows} simulated and {response.measured_rows} measured rows"
        return f"data set to learn from: {rows}"
    last = exchange[-1][0]
    assert isinstance(query, Q5)
    assert isinstance(last, Q5)
    rows = f"rows {query.first} to {last.first + last.rows - 1}"
    packets = f" in {len(exchange)} packets" if len(exchange) > 1 else ""
    return f"contexts of {rows}{packets} sent, simulated by version {query.version}"


def _adequacy(query: Q1, response: R1) -> str:
    asked = f"calibration on {len(query.channels)} channels"
    if query.restore is not None:
        asked = f"return to version {query.restore}"
    elif query.correction is not None:
        asked = "structure and sensors corrected by a calibration"
    elif query.effects is not None:
        asked = "update of the model: " + ", ".join(query.effects)
    if not response.adequate:
        return f"{asked}: refused, missing {'; '.join(response.missing)}"
    infer = ", ".join(response.latent) or "nothing"
    return f"{asked}: version {response.version} is adequate, to infer: {infer}"
