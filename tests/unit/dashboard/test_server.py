"""Connections that say nothing, or too much, are closed; others are answered all the while."""

import socket
import time
from collections.abc import Iterator
from pathlib import Path
from threading import Thread
from typing import Any

import pytest
from fastapi import FastAPI, Request

from rga.dashboard.bounded_body import BoundedBody
from rga.dashboard.server import BoundedProtocol, listening_socket, server_of
from rga.errors import InputError
from rga.operation.configuration import ServiceSettings

#: how long anything is waited for [s]
PATIENCE = 60.0


@pytest.fixture
def port(monkeypatch: pytest.MonkeyPatch) -> Iterator[int]:
    """Of a server that waits for a fraction of a second."""
    monkeypatch.setattr(BoundedProtocol, "look", 0.2)
    app = FastAPI()
    app.add_middleware(BoundedBody, longest=0.3)

    @app.post("/bytes")
    async def count(request: Request) -> int:
        return len(await request.body())

    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        number = int(free.getsockname()[1])
    settings = ServiceSettings(listen=f"127.0.0.1:{number}")
    server = server_of(app, settings)
    thread = Thread(target=server.run, args=[[listening_socket(settings)]])
    thread.start()
    while not server.started:
        assert thread.is_alive()
        time.sleep(0.01)
    yield number
    server.should_exit = True
    thread.join()


def caller(port: int, said: bytes = b"") -> socket.socket:
    """Somebody who calls, and says something."""
    found = socket.create_connection(("127.0.0.1", port), PATIENCE)
    found.sendall(said)
    return found


def call(length: int) -> bytes:
    return f"POST /bytes HTTP/1.1\r\nHost: here\r\nContent-Length: {length}\r\n\r\n".encode()


@pytest.mark.parametrize("said", [b"", b"POST /bytes HTTP/1.1\r\nHost: he"])
def test_who_does_not_say_what_they_want_is_left(port: int, said: bytes) -> None:
    with caller(port, said) as slow:
        assert slow.recv(1) == b""


def test_a_second_call_that_does_not_end_is_left(port: int) -> None:
    with caller(port, call(2) + b"12") as slow:
        assert slow.recv(1000).startswith(b"HTTP/1.1 200")
        slow.sendall(b"POST /bytes HTTP/1.1\r\n")
        while slow.recv(1000):
            pass


def test_a_body_that_does_not_end_is_broken_off(port: int) -> None:
    with caller(port, call(1000) + b"1") as slow, caller(port, call(2) + b"12") as quick:
        assert quick.recv(1000).startswith(b"HTTP/1.1 200")
        assert slow.recv(1000).startswith(b"HTTP/1.1 408")


@pytest.mark.parametrize(("length", "status"), [(256 * 1024, b"200"), (256 * 1024 + 1, b"413")])
def test_a_large_body_is_broken_off(port: int, length: int, status: bytes) -> None:
    with caller(port, call(length) + b"x" * length) as large:
        assert large.recv(12) == b"HTTP/1.1 " + status


def test_large_headers_are_broken_off(port: int) -> None:
    with caller(port, b"POST /bytes HTTP/1.1\r\nX: " + b"x" * 100_000) as large:
        assert large.recv(1000).startswith(b"HTTP/1.1 400")


@pytest.mark.parametrize("content", [None, "no certificate"])
def test_files_of_tls_that_are_none_are_told(tmp_path: Path, content: Any) -> None:
    if content is not None:
        (tmp_path / "c.pem").write_text(content, "utf-8")
    files = {"certificate": tmp_path / "c.pem", "key": tmp_path / "c.pem"}
    with pytest.raises(InputError, match="TLS cannot begin"):
        server_of(FastAPI(), ServiceSettings(**files))


@pytest.mark.parametrize("listen", ["192.0.2.1:8471", "a.b.invalid:80"])
def test_an_address_that_is_none_is_told(listen: str) -> None:
    with pytest.raises(InputError, match="nothing can listen there") as refused:
        listening_socket(ServiceSettings(listen=listen))
    assert repr(listen) in str(refused.value)
    with socket.create_server(("127.0.0.1", 0)) as free:
        port = free.getsockname()[1]
    listening_socket(ServiceSettings(listen=f"127.0.0.1:{port}")).close()
