"""The middleware: hands every packet of the hardware interface to all who listen."""

from collections.abc import Callable
from typing import Protocol

from rga.twin.messages.hardware import Packet

Listener = Callable[[Packet], None]


class Middleware(Protocol):
    """What a broker between the hardware interface and the twin must offer."""

    def subscribe(self, listener: Listener) -> None:
        """Hand every further packet to a listener."""

    def publish(self, packet: Packet) -> None:
        """Hand a packet to all listeners; returns when the last of them has taken it."""


class InProcess:
    """Middleware within one process: listeners are called in the order of their subscription.

    >>> heard = []
    >>> middleware = InProcess()
    >>> middleware.subscribe(heard.append)
    >>> middleware.publish("packet")
    >>> heard
    ['packet']
    """

    def __init__(self) -> None:
        self._listeners: list[Listener] = []

    def subscribe(self, listener: Listener) -> None:
        self._listeners.append(listener)

    def publish(self, packet: Packet) -> None:
        for listener in self._listeners:
            listener(packet)
