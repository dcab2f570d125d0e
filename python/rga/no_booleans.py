"""Numbers in files: true and false are none, which Python would take for 1 and 0."""

from typing import Any

from pydantic import BeforeValidator


def _no_boolean(given: Any) -> Any:
    if isinstance(given, bool):
        raise ValueError(f"{str(given).lower()} is no number")
    return given


#: Marks the type of a number that a file gives; it stands last, so that JSON Schema has the bounds.
NO_BOOLEAN = BeforeValidator(_no_boolean)
