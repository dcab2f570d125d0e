"""Tells the system that started a service that it is ready, and that it goes on (`sd_notify`)."""

import os
import socket

#: what systemd understands
READY, ALIVE = "READY=1", "WATCHDOG=1"


def tell_system(state: str) -> None:
    """Tell systemd a state of the service; nothing where nobody listens.

    Args:
        state: `READY` or `ALIVE`.

    >>> tell_system(ALIVE)
    """
    address = os.environ.get("NOTIFY_SOCKET")
    if not address:
        return
    # A name that begins with @ is one of no file.
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM | socket.SOCK_NONBLOCK) as told:
        try:
            told.sendto(state.encode(), address.replace("@", "\0", 1))
        except OSError:
            # Who is not told begins the service anew: there is nothing better to do here.
            return
