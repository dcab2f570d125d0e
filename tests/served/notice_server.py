"""A server on this machine that notices are sent to: it fails, hangs or takes them."""

import json
import re
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager
from http.server import BaseHTTPRequestHandler, ThreadingHTTPServer
from threading import Event, Thread
from typing import Literal

Mood = Literal["takes", "fails", "takes and fails", "hangs"]
_ID = re.compile(r"notice ([0-9a-f-]{36})$")


class NoticeServer(ThreadingHTTPServer):
    """What was sent here.

    Attributes:
        mood: what becomes of the next messages.
        taken: titles and bodies of the messages that were taken in, by their id.
        sent: how often each was sent.
    """

    daemon_threads = True

    def __init__(self) -> None:
        super().__init__(("127.0.0.1", 0), _Handler)
        self.mood: Mood = "takes"
        self.taken: dict[str, tuple[str, str]] = {}
        self.sent: Counter[str] = Counter()
        self.ended = Event()

    @property
    def url(self) -> str:
        """Its address, as apprise takes it, with short patience."""
        return f"json://127.0.0.1:{self.server_address[1]}/?rto=0.3&cto=0.3"

    @property
    def bodies(self) -> list[str]:
        """What was taken in."""
        return [body for _, body in self.taken.values()]


class _Handler(BaseHTTPRequestHandler):
    server: NoticeServer

    def do_POST(self) -> None:
        said = json.loads(self.rfile.read(int(self.headers["Content-Length"])))
        title, body = said["title"], said["message"]
        found = _ID.search(body)
        assert found is not None
        self.server.sent[found[1]] += 1
        mood = self.server.mood
        if mood.startswith("takes"):
            self.server.taken[found[1]] = title, body
        if mood == "hangs":
            self.server.ended.wait(5)
            return
        self.send_response(500 if mood.endswith("fails") else 200)
        self.end_headers()

    def log_message(self, *_: object) -> None:
        """Nothing is written."""


@contextmanager
def notice_server() -> Iterator[NoticeServer]:
    """A server while it is needed."""
    with NoticeServer() as server:
        Thread(target=server.serve_forever, args=[0.01], daemon=True).start()
        try:
            yield server
        finally:
            server.ended.set()
            server.shutdown()
