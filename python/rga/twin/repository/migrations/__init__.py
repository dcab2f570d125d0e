"""Brings the tables of a repository to where the code is."""

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from sqlalchemy import Connection, inspect, text

if TYPE_CHECKING:
    from alembic.script import ScriptDirectory

#: revision of the tables that the code reads and writes
CURRENT = "0004"
# A name of its own: the database of a server may hold another application's revisions.
VERSIONS = "rga_repository"
OPTIONS: dict[str, Any] = {"version_table": VERSIONS, "compare_type": True}


def state(connection: Connection) -> Literal["empty", "foreign", "older", "current", "newer"]:
    """Where the tables are: none, not a repository's, or a repository's against the code."""
    held = revision(connection)
    if held is None:
        return "foreign" if inspect(connection).get_table_names() else "empty"
    if held == CURRENT:
        return "current"
    known = {script.revision for script in _scripts().walk_revisions()}
    return "older" if held in known else "newer"


def revision(connection: Connection) -> str | None:
    """The revision of the tables; None where they are none of a repository."""
    if not inspect(connection).has_table(VERSIONS):
        return None
    held = connection.scalar(text(f"SELECT version_num FROM {VERSIONS}"))
    return None if held is None else str(held)


def upgrade(connection: Connection) -> None:
    """Run what is missing, within the transaction that is open; nothing where all is there."""
    # Most repositories are current, and alembic is heavy.
    from alembic.migration import MigrationContext
    from alembic.operations import Operations

    context = MigrationContext.configure(connection, opts=OPTIONS)
    scripts = _scripts()
    missing = list(scripts.iterate_revisions("heads", context.get_current_revision() or "base"))
    for script in reversed(missing):
        with Operations.context(context):
            script.module.upgrade()
        context.stamp(scripts, script.revision)


def _scripts() -> "ScriptDirectory":
    from alembic.script import ScriptDirectory

    return ScriptDirectory(Path(__file__).parent)
