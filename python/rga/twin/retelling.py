"""The log of queries and responses in words."""

from collections.abc import Iterator, Sequence
from itertools import groupby

from rga.twin.messages import Q1, Q2, Q3, Q4, Q5, R1, R2, R4, Query, Response

Message = Query | Response
Pair = tuple[Message, Message]


def retold(messages: Sequence[Message]) -> Iterator[tuple[int, str, str]]:
    """Row, kinds and words of each exchange; packets that follow one another share a line.

    >>> from rga.twin.messages import Box, Q2, R2
    >>> box = Box(low=(0.0,), high=(1.0,))
    >>> log = [Q2(row=0, version=1, box=box, wanted=9), R2(row=0, held=2, missing=7)]
    >>> next(retold(log))
    (0, 'Q2 R2', '9 simulations of version 1 wanted: 2 held, 7 missing')
    """
    pairs = list(zip(messages[::2], messages[1::2], strict=True))
    runs: list[list[Pair]] = []
    for _, group in groupby(pairs, key=lambda pair: isinstance(pair[0], Q5)):
        for pair in group:
            if runs and _continues(runs[-1][-1][0], pair[0]):
                runs[-1].append(pair)
            else:
                runs.append([pair])
    for run in runs:
        query, response = run[0]
        yield query.row, f"{query.kind} {response.kind}", _words(run)


def _continues(before: Message, query: Message) -> bool:
    if not isinstance(before, Q5) or not isinstance(query, Q5):
        return False
    return before.version == query.version and query.first == before.first + before.rows


def _words(run: list[Pair]) -> str:
    query, response = run[0]
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
    last = run[-1][0]
    assert isinstance(query, Q5)
    assert isinstance(last, Q5)
    rows = f"rows {query.first} to {last.first + last.rows - 1}"
    packets = f" in {len(run)} packets" if len(run) > 1 else ""
    return f"contexts of {rows}{packets} sent, simulated by version {query.version}"


def _adequacy(query: Q1, response: R1) -> str:
    asked = f"calibration on {len(query.channels)} channels"
    if query.restore is not None:
        asked = f"return to version {query.restore}"
    elif query.effects is not None:
        asked = "update of the model: " + ", ".join(query.effects)
    if not response.adequate:
        return f"{asked}: refused, missing {'; '.join(response.missing)}"
    infer = ", ".join(response.latent) or "nothing"
    return f"{asked}: version {response.version} is adequate, to infer: {infer}"
