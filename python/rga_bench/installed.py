"""What is measured beside rga is optional."""

from collections.abc import Callable
from typing import TypeVar

Made = TypeVar("Made")


class NotInstalledError(Exception):
    """A peer is optional, and is not there."""


def present(make: Callable[[], Made]) -> Made | None:
    """A peer; nothing where it is not installed."""
    try:
        return make()
    except NotInstalledError:
        return None
