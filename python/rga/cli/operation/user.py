"""`rga user`: who may come in to a service, and by which tokens programs do."""

import sys
from enum import StrEnum
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from rga.cli.operation.serve import ConfigurationFile

if TYPE_CHECKING:
    from rga.dashboard.access.users import Users
    from rga.operation.configuration import Configuration
    from rga.twin.repository.table_file import TableFile

#: bytes of a file that holds a password
LARGEST_PASSWORD = 4096


class UserAction(StrEnum):
    """What is done."""

    add = "add"
    remove = "remove"
    token = "token"
    list = "list"
    password = "password"


Name = Annotated[
    str | None,
    typer.Argument(metavar="NAME", help="Of the user, or of the token; list takes none."),
]
RoleName = Annotated[
    str | None,
    typer.Option(
        "--role",
        help="Of a user: viewer, operator or admin; of a token: ingest, read or operate.",
    ),
]
TwinName = Annotated[
    str | None, typer.Option("--twin", metavar="NAME", help="The twin that a token is for.")
]
PasswordFile = Annotated[
    Path | None,
    typer.Option(
        "--password-file", metavar="FILE", help="Holds the password; left out, it is asked for."
    ),
]


def user(
    configuration: ConfigurationFile,
    action: Annotated[UserAction, typer.Argument(metavar="add|remove|token|list|password")],
    name: Name = None,
    role: RoleName = None,
    twin: TwinName = None,
    password_file: PasswordFile = None,
) -> None:
    """Let a user in to a service, or no more, make a token, which is shown once, or list them.

    Another password ends the sessions of its user.
    """
    from rga.dashboard.access import tables
    from rga.dashboard.access.users import Users
    from rga.operation.configuration import read_configuration
    from rga.operation.service_file import service_file

    chosen = read_configuration(configuration)
    if (name is None) != (action is UserAction.list):
        raise typer.BadParameter("list takes no NAME" if name else f"{action} takes a NAME")
    with service_file(chosen.service.data, tables.metadata) as file:
        if name is None:
            _list(file)
        elif action is UserAction.password:
            users = Users(file)
            users.check_is_there(name)
            users.change_password(name, _password(name, password_file))
            typer.echo(f"{name} has another password; open sessions have ended.")
        elif action is UserAction.token:
            _make_token(file, chosen, name, role or "ingest", twin)
        elif action is UserAction.add:
            _add(Users(file), name, role or "viewer", password_file)
        else:
            _remove(file, name)


def _add(users: "Users", name: str, role: str, password_file: Path | None) -> None:
    from rga.dashboard.access.roles import role_named

    chosen = role_named(role, f"user {name!r}")
    users.check_is_new(name)
    users.add(name, chosen, _password(name, password_file))
    typer.echo(f"{name} may come in as {chosen}.")


def _list(file: "TableFile") -> None:
    from rga.dashboard.access.tokens import Tokens
    from rga.dashboard.access.users import Users

    users, tokens = sorted(Users(file).all().items()), Tokens(file).all()
    for name, role in users:
        typer.echo(f"{role:<8} {name}")
    for one in tokens:
        typer.echo(f"{one.purpose:<8} {one.name}, a token for twin {one.twin}")
    if not users and not tokens:
        typer.echo("There are no users and no tokens: whoever is at this machine may do all.")


def _remove(file: "TableFile", name: str) -> None:
    from rga.dashboard.access.tokens import Tokens
    from rga.dashboard.access.users import Users

    tokens = Tokens(file)
    if name in [one.name for one in tokens.all()]:
        tokens.remove(name)
        typer.echo(f"The token {name} is good for nothing any more.")
        return
    Users(file).remove(name)
    typer.echo(f"{name} may come in no more.")


def _make_token(
    file: "TableFile", configuration: "Configuration", name: str, role: str, twin: str | None
) -> None:
    from rga.dashboard.access.roles import purpose_named
    from rga.dashboard.access.tokens import Tokens
    from rga.errors import InputError

    known = [one.name for one in configuration.twin]
    if twin is None and len(known) == 1:
        twin = known[0]
    if twin not in known:
        what = "a token is for one twin" if twin is None else f"there is no twin {twin!r}"
        raise InputError(what, "--twin", f"name one of {', '.join(known)}")
    secret = Tokens(file).make(name, purpose_named(role, f"token {name!r}"), twin)
    typer.echo(secret)
    typer.echo("It is shown this once. Programs send it as RGA_TOKEN.", err=True)


def _password(name: str, file: Path | None) -> str:
    """The password of a file, or as somebody types it.

    Raises:
        InputError: the file cannot be read, or nobody is there to type.
    """
    from rga.bounded_files import bytes_of
    from rga.errors import InputError

    if file is not None:
        try:
            lines = bytes_of(file, "password", LARGEST_PASSWORD).decode().splitlines()
        except UnicodeDecodeError:
            raise InputError("this is no text", str(file), "write the password in UTF-8") from None
        return lines[0] if lines else ""
    if not sys.stdin.isatty():
        raise InputError(
            "nobody is there to type the password", "the terminal", "give --password-file"
        )
    typed: str = typer.prompt(f"Password of {name}", hide_input=True, confirmation_prompt=True)
    return typed
