"""Checks of models and records that no structure has come to an end with findings."""

import copy
import json
import warnings
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from rga.checking import CheckResult, check
from rga.errors import InputError
from rga.model import Model, read_model
from rga.records import Record

SIZES = [0.0, -1.0, 1e-300, 1e30]


def numbers(part: Any, here: tuple[Any, ...] = ()) -> Iterator[tuple[Any, ...]]:
    """Places of all numbers in tables and lists."""
    for key, value in part.items() if isinstance(part, dict) else enumerate(part):
        if isinstance(value, dict | list):
            yield from numbers(value, (*here, key))
        elif isinstance(value, int | float):
            yield (*here, key)


def whole(found: CheckResult) -> None:
    """Findings can be told in every form."""
    assert str(found)
    assert json.loads(found.to_json())["ok"] == found.ok
    assert found._repr_html_()


@pytest.mark.parametrize("size", SIZES)
def test_numbers_that_no_structure_has(size: float, portal: dict[str, Any]) -> None:
    count = 0
    for *path, key in numbers(portal):
        damaged = copy.deepcopy(portal)
        part = damaged
        for step in path:
            part = part[step]
        part[key] = size
        try:
            model = read_model(damaged, "portal")
        except InputError:
            continue
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # numbers that overflow in the simulation
            whole(check(model))
        count += 1
    assert count > 20


EMPTY = np.full((200, 6), np.nan)
RECORDS: dict[str, Callable[[Record], Record]] = {
    "no row": lambda r: r.rows(slice(0, 0)),
    "one row": lambda r: r.rows(slice(0, 1)),
    "two rows": lambda r: r.rows(slice(0, 2)),
    "no reading": lambda r: replace(r, readings=EMPTY),
    "no context": lambda r: replace(r, contexts=dict.fromkeys(r.contexts, EMPTY[:, 0])),
    "zeros": lambda r: replace(r, readings=0 * r.readings),
    "huge readings": lambda r: replace(r, readings=1e29 * r.readings),
    "huge contexts": lambda r: replace(r, contexts={n: 1e29 * c for n, c in r.contexts.items()}),
    "no channel": lambda r: r.channels([]),
}


@pytest.mark.parametrize("case", RECORDS)
def test_records_that_say_nothing(case: str, model: Model, measured: Callable[..., Record]) -> None:
    found = check(model, RECORDS[case](measured()))
    whole(found)
    assert found.findings


def test_a_zero_outside_the_record_is_told_once(
    portal: dict[str, Any], measured: Callable[..., Record]
) -> None:
    portal["sensors"]["U"]["zero"] = [1e9, 2e9]
    found = check(read_model(portal, "portal"), measured())
    assert [one.severity for one in found.findings] == ["error"]
    assert "lies outside the record" in found.findings[0].what
