"""The judge of what comes of hostile files sees every kind of fault, and none where none is."""

import sys
import time
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

OUT = ("diagnose", "{}/model.json", "{}/record.csv", "-o", "{}/out")


def refused(said: str) -> None:
    sys.stderr.write(said)
    sys.exit(2)


def breaks() -> None:
    raise ZeroDivisionError("division by zero")


def waits() -> None:
    time.sleep(60)


def runs_for_ever() -> None:
    while True:
        pass


def takes_memory() -> None:
    np.ones(2**28).sum()


def says_nothing() -> None:
    refused("")


def says_much() -> None:
    refused("error: it cannot be read\nand that is not all\n")


def prints_a_traceback() -> None:
    refused("error: it cannot be read\n  Traceback (most recent call last)\n")


def ends_as_a_fault() -> None:
    sys.exit(1)


FAULTS: dict[Callable[[], None], str] = {
    breaks: "ZeroDivisionError",
    waits: "longer than 1 s",
    runs_for_ever: "longer than 1 s",
    takes_memory: "MemoryError",
    says_nothing: "does not say why",
    says_much: "more than a line",
    prints_a_traceback: "a traceback",
    ends_as_a_fault: "exit code 1",
}


@pytest.mark.parametrize("does", FAULTS, ids=lambda one: one.__name__)
def test_a_fault_is_seen(
    does: Callable[[], None],
    given: Callable[..., Any],
    judged: Callable[[Any], Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr("rga.cli.app.run_command", lambda words: does())
    (fault,) = judged(replace(given(OUT, {}), longest=1)).faults
    assert FAULTS[does] in fault


@pytest.mark.parametrize(
    ("code", "content", "fault"),
    [(2, "{}", "it leaves ['findings.json']"), (0, '{"gap": NaN}', "NaN is no number")],
)
def test_what_is_written_is_looked_at(
    code: int,
    content: str,
    fault: str,
    given: Callable[..., Any],
    judged: Callable[[Any], Any],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def writes(words: Sequence[str]) -> None:
        Path(words[-1], "findings.json").write_text(content, "utf-8")
        if code:
            refused("error: it cannot be read\n")
        sys.exit(0)

    monkeypatch.setattr("rga.cli.app.run_command", writes)
    (found,) = judged(given(OUT, {})).faults
    assert fault in found


def test_what_works_and_what_is_refused_in_a_line_has_no_fault(
    given: Callable[..., Any], judged: Callable[[Any], Any]
) -> None:
    assert judged(given(("check", "{}/model.json"), {})).faults == []
    came = judged(given(OUT, {"record.csv": b""}))
    assert (came.code, came.faults) == (2, [])
