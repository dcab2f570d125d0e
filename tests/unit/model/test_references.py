"""Names in a model: what no file, page or message can hold is refused, all of it at once."""

from typing import Any

import pytest

from rga.errors import InputError
from rga.model import read_model


def renamed(content: dict[str, Any], sensor: str, **more: Any) -> dict[str, Any]:
    """The model with its first sensor under another name."""
    first, *others = content["sensors"].items()
    return {**content, "sensors": {sensor: first[1], **dict(others)}, **more}


@pytest.mark.parametrize(
    "name", ["\ud800", "two\nlines", "line\u2028", "bell\x07", "x" * 201, "right\u202eleft"]
)
def test_names_that_nothing_can_hold_are_refused(small_bridge: dict[str, Any], name: str) -> None:
    for content in (renamed(small_bridge, name), renamed(small_bridge, "D1", name=name)):
        with pytest.raises(InputError, match="is no name: write at most 200") as refused:
            read_model(content, "model")
        str(refused.value).encode()


@pytest.mark.parametrize("name", ["Brücke 7–β", "東橋", "[/bold]<script>&", "x" * 200])
def test_others_are_taken(small_bridge: dict[str, Any], name: str) -> None:
    assert name in read_model(renamed(small_bridge, name), "model").sensors


def test_all_are_told(small_bridge: dict[str, Any]) -> None:
    content = renamed(small_bridge, "a\tb", name="c\nd")
    with pytest.raises(InputError) as refused:
        read_model(content, "model")
    assert "'a\\tb'" in str(refused.value)
    assert "'c\\nd'" in str(refused.value)
