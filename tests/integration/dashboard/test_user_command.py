"""`rga user`: who may come in, and tokens that are shown once."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.dashboard.access import tables
from rga.dashboard.access.roles import Who
from rga.dashboard.access.sessions import Sessions
from rga.dashboard.access.tokens import Tokens
from rga.dashboard.access.users import Users
from rga.operation.service_file import service_file
from served.bridges import configured

PASSWORD = "four words of mine"


@pytest.fixture
def configuration(tmp_path: Path, small_bridge: dict[str, Any]) -> Path:
    (tmp_path / "password").write_text(f"{PASSWORD}\n", "utf-8")
    return configured(tmp_path, {"east": small_bridge, "west": small_bridge})


def test_a_user_comes_and_goes(configuration: Path, rga: Callable[..., Any]) -> None:
    secret = ("--password-file", configuration.with_name("password"))
    done = rga("user", configuration, "add", "Ada", "--role", "operator", *secret)
    assert (done.code, done.err) == (0, "")
    assert PASSWORD not in done.out
    with service_file(configuration.parent / "data", tables.metadata) as file:
        assert Users(file).all() == {"Ada": "operator"}
        assert Users(file).knows("Ada", PASSWORD)
        assert not Users(file).knows("Ada", f"{PASSWORD}\n")
        again = rga("user", configuration, "add", "Ada", *secret)
        assert (again.code, "there is a user of this name" in again.err) == (2, True)
        assert rga("user", configuration, "remove", "Ada").code == 0
        assert Users(file).all() == {}
    assert rga("user", configuration, "remove", "Ada").code == 2


def test_a_token_is_shown_once(configuration: Path, rga: Callable[..., Any]) -> None:
    done = rga("user", configuration, "token", "logger", "--role", "ingest", "--twin", "east")
    assert done.code == 0
    with service_file(configuration.parent / "data", tables.metadata) as file:
        secret = done.out.strip()
        assert Tokens(file).who_has(secret) == Who("logger", "ingest", "east")
        assert Tokens(file).who_has(f"{secret}x") is None
        assert rga("user", configuration, "remove", "logger").code == 0
        assert Tokens(file).who_has(secret) is None


def test_users_and_tokens_are_listed_without_secrets(
    configuration: Path, rga: Callable[..., Any]
) -> None:
    assert "no users" in rga("user", configuration, "list").out
    secret = ("--password-file", configuration.with_name("password"))
    rga("user", configuration, "add", "Ada", "--role", "operator", *secret)
    token = rga("user", configuration, "token", "logger", "--twin", "east").out.strip()
    done = rga("user", configuration, "list")
    assert done.code == 0
    assert done.out.splitlines() == ["operator Ada", "ingest   logger, a token for twin east"]
    assert token not in done.out


def test_another_password_ends_the_sessions(configuration: Path, rga: Callable[..., Any]) -> None:
    secret = configuration.with_name("password")
    rga("user", configuration, "add", "Ada", "--password-file", secret)
    with service_file(configuration.parent / "data", tables.metadata) as file:
        session = Sessions(file).begin("Ada")
        secret.write_text("five other words of mine", "utf-8")
        done = rga("user", configuration, "password", "Ada", "--password-file", secret)
        assert (done.code, done.err) == (0, "")
        assert Users(file).knows("Ada", "five other words of mine")
        assert not Users(file).knows("Ada", PASSWORD)
        assert Sessions(file).user_of(session) is None


@pytest.mark.parametrize(
    "arguments",
    [
        ("token", "logger"),
        ("token", "logger", "--twin", "north"),
        ("token", "logger", "--twin", "east", "--role", "admin"),
        ("add", "Ada", "--role", "king"),
        ("add", " Ada"),
        ("add", "Ada", "--password-file", "of no file"),
        ("add", "Ada"),
        ("remove", "nobody"),
        ("dismiss", "Ada"),
        ("password", "nobody", "--password-file", "of no file"),
        ("password", "Ada"),
        ("list", "Ada"),
        ("add",),
    ],
)
def test_what_cannot_be_done_is_told(
    configuration: Path, rga: Callable[..., Any], arguments: tuple[str, ...]
) -> None:
    done = rga("user", configuration, *arguments)
    assert done.code == 2
    assert "Traceback" not in done.err
    with service_file(configuration.parent / "data", tables.metadata) as file:
        assert not Users(file).exist
        assert Tokens(file).all() == []
