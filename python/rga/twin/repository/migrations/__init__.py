"""Brings the tables of a repository to where the code is."""

from pathlib import Path
from typing import Any, Literal

from alembic.migration import MigrationContext
from alembic.operations import Operations
from alembic.script import ScriptDirectory
from sqlalchemy import Connection, inspect

# A name of its own: the database of a server may hold another application's revisions.
OPTIONS: dict[str, Any] = {"version_table": "rga_repository", "compare_type": True}


def state(connection: Connection) -> Literal["empty", "foreign", "older", "current", "newer"]:
    """Where the tables are: none, not a repository's, or a repository's against the code."""
    held = revision(connection)
    if held is None:
        return "foreign" if inspect(connection).get_table_names() else "empty"
    scripts = _scripts()
    if held == scripts.get_current_head():
        return "current"
    known = {script.revision for script in scripts.walk_revisions()}
    return "older" if held in known else "newer"


def revision(connection: Connection) -> str | None:
    """The revision of the tables; None where they are none of a repository."""
    return MigrationContext.configure(connection, opts=OPTIONS).get_current_revision()


def upgrade(connection: Connection) -> None:
    """Run what is missing, within the transaction that is open; nothing where all is there."""
    context = MigrationContext.configure(connection, opts=OPTIONS)
    scripts = _scripts()
    missing = list(scripts.iterate_revisions("heads", context.get_current_revision() or "base"))
    for script in reversed(missing):
        with Operations.context(context):
            script.module.upgrade()
        context.stamp(scripts, script.revision)


def _scripts() -> ScriptDirectory:
    return ScriptDirectory(Path(__file__).parent)
