"""Solvers that rga is measured beside; each does the same job as well as it can."""

from collections.abc import Callable
from typing import Protocol, TypeVar

from rga.model.parameter import FloatArray


class Peer(Protocol):
    """Samples of a truss of which every stiffness varies."""

    @property
    def rows(self) -> int:
        """Samples of a batch that suits it."""

    def respond(self, factors: FloatArray, coefficients: FloatArray) -> FloatArray:
        """Outputs [n, o] of n samples, as `_core.Refactored.respond`."""


class NotInstalledError(Exception):
    """A peer is optional, and is not there."""


AnyPeer = TypeVar("AnyPeer", bound=Peer)


def present(make: Callable[[], AnyPeer]) -> AnyPeer | None:
    """A peer; nothing where it is not installed."""
    try:
        return make()
    except NotInstalledError:
        return None
