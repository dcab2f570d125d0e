"""A bridge whose contexts are all measured, and a record of it."""

from collections.abc import Callable
from typing import Any

import pytest

from live_streams import sinking
from rga.model import Model, read_model
from rga.records import Record

Given = tuple[Model, Record]


@pytest.fixture(scope="session")
def sound(measured_bridge: dict[str, Any], measured_record: Callable[..., Record]) -> Given:
    """A model, and a record in which nothing happens."""
    model = read_model(measured_bridge, "measured bridge")
    return model, sinking(model, measured_record, 100, sinks=False)


@pytest.fixture(scope="session")
def sinks(sound: Given, measured_record: Callable[..., Record]) -> Given:
    """The same, with a bearing that sinks."""
    return sound[0], sinking(sound[0], measured_record, 100)
