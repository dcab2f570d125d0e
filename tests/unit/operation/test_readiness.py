"""A service tells the system that started it that it is ready, and that it goes on."""

import socket
from pathlib import Path

import pytest

from rga.operation.readiness import ALIVE, READY, tell_system


def test_whoever_listens_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as system:
        system.bind(str(tmp_path / "n"))
        system.settimeout(5)
        monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "n"))
        tell_system(READY)
        tell_system(ALIVE)
        assert [system.recv(64), system.recv(64)] == [b"READY=1", b"WATCHDOG=1"]


def test_a_name_of_no_file_is_told(monkeypatch: pytest.MonkeyPatch) -> None:
    with socket.socket(socket.AF_UNIX, socket.SOCK_DGRAM) as system:
        system.bind("\0rga-readiness-test")
        system.settimeout(5)
        monkeypatch.setenv("NOTIFY_SOCKET", "@rga-readiness-test")
        tell_system(READY)
        assert system.recv(64) == b"READY=1"


def test_nobody_who_listens_is_no_fault(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("NOTIFY_SOCKET", str(tmp_path / "gone"))
    tell_system(READY)
    monkeypatch.delenv("NOTIFY_SOCKET")
    tell_system(READY)
