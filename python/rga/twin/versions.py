"""Versions of the twin's model: the model as given with effects beyond it."""

import hashlib
import json
from bisect import bisect_left
from collections.abc import Callable
from typing import Any

from pydantic import ValidationError

from rga.errors import InputError
from rga.model import Model, model_content, read_effect

Effects = dict[str, dict[str, Any]]


def extended(model: Model, effects: Effects) -> Model:
    """The model as given with the effects of a version.

    Raises:
        InputError: an effect does not fit the model.
    """
    try:
        return model.extended({name: read_effect(one, name) for name, one in effects.items()})
    except (ValidationError, ValueError) as error:
        if isinstance(error, InputError):
            raise
        reason = " ".join(str(error).split())
        raise InputError(reason, f"model {model.name!r}", "mend the effect") from None


def beyond(given: Model, model: Model) -> Effects:
    """Effects that a model has beyond the one given, as they stand in a model file."""
    effects = model_content(model)["effects"]
    return {name: effect for name, effect in effects.items() if name not in given.effects}


def with_ends(effects: Effects, end: str | float) -> Effects:
    """Effects whose ramps are full at a time at the latest: one without an end goes on growing.

    Args:
        effects: that a diagnosis found in rows up to that time.
        end: that time, as the record writes it.

    >>> with_ends({"slow": {"profile": "ramp", "end": None}, "new": {"profile": "step"}}, 90.0)
    {'slow': {'profile': 'ramp', 'end': 90.0}, 'new': {'profile': 'step'}}
    """
    return {
        name: {**one, "end": end}
        if one.get("profile") == "ramp" and one.get("end") is None
        else one
        for name, one in effects.items()
    }


def first_row_under(effects: Effects, rows: int, label: Callable[[int], str | float]) -> int | None:
    """The first row from which on all effects act; None where none says when it began.

    Args:
        effects: of a version.
        rows: of the record so far.
        label: how the record writes the time of a row.
    """
    onsets = [one["onset"] for one in effects.values() if one.get("onset") is not None]
    return max((bisect_left(range(rows), onset, key=label) for onset in onsets), default=None)


def written(model: Model) -> tuple[str, str]:
    """A model as the text of a model file, and the hash of that text."""
    text = json.dumps(model_content(model), indent=1)
    return text, hashlib.sha256(text.encode()).hexdigest()
