"""A network that can be slow, be cut, or lose what is sent without a word."""

import socket
import time
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from threading import Event, Thread
from typing import Literal

#: what becomes of what is sent: it is passed on, connections end, or nothing ever arrives
State = Literal["whole", "cut", "half open"]


class Relay:
    """Passes on what is sent between a port of its own and another one of this machine.

    Args:
        target: the other port.

    Attributes:
        port: that others connect to.
        delay: of everything that is passed on [s].
        lost: connections of which both ends believe that they last.
    """

    def __init__(self, target: int) -> None:
        self._target, self._state = target, "whole"
        self.delay, self.lost = 0.0, 0
        self._server = socket.create_server(("127.0.0.1", 0))
        self.port = int(self._server.getsockname()[1])
        self._ways: list[tuple[Event, tuple[socket.socket, ...]]] = []
        Thread(target=self._accept, daemon=True).start()

    def become(self, state: State) -> None:
        """Change what becomes of what is sent; a connection that was lost stays lost."""
        self._state = state
        if state == "whole":
            return
        for lost, ends in self._ways:
            self.lost += not lost.is_set()
            lost.set()
            if state == "cut":
                _end(ends)

    def close(self) -> None:
        """End everything."""
        _end([self._server])
        self.become("cut")

    def _accept(self) -> None:
        with suppress(OSError):
            while True:
                caller, _ = self._server.accept()
                if self._state == "cut":
                    caller.close()
                    continue
                target = socket.create_connection(("127.0.0.1", self._target))
                lost = Event()
                if self._state == "half open":
                    lost.set()
                self._ways.append((lost, (caller, target)))
                for one, other in ((caller, target), (target, caller)):
                    Thread(target=self._pass_on, args=[lost, one, other], daemon=True).start()

    def _pass_on(self, lost: Event, one: socket.socket, other: socket.socket) -> None:
        with suppress(OSError):
            while sent := one.recv(65_536):
                time.sleep(self.delay)
                if not lost.is_set():
                    other.sendall(sent)
            if not lost.is_set():
                _end([other])


def _end(ends: tuple[socket.socket, ...] | list[socket.socket]) -> None:
    for one in ends:
        with suppress(OSError):
            one.shutdown(socket.SHUT_RDWR)
        one.close()


@contextmanager
def relay_to(target: int) -> Iterator[Relay]:
    """A network to a port while it is needed."""
    relay = Relay(target)
    try:
        yield relay
    finally:
        relay.close()
