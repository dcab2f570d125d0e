"""Runs, steps, and what steps store."""

from typing import Any

import sqlalchemy as sa
from alembic import op

revision = "0001"
down_revision = None

KEY = ("run_id", "step", "ordinal")


def upgrade() -> None:
    op.create_table(
        "run",
        sa.Column("id", sa.Integer, nullable=False),
        sa.Column("key", sa.String(64), nullable=False),
        sa.Column("model_sha256", sa.String(64), nullable=False),
        sa.Column("record_sha256", sa.String(64), nullable=False),
        sa.Column("seed", sa.BigInteger, nullable=False),
        sa.Column("settings", sa.Text, nullable=False),
        sa.Column("begun_at", sa.String(40), nullable=False),
        sa.PrimaryKeyConstraint("id", name="pk_run"),
        sa.UniqueConstraint("key", name="uq_run_key"),
    )
    op.create_table(
        "step",
        sa.Column("run_id", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("number", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("row", sa.Integer, nullable=False),
        sa.Column("written_at", sa.String(40), nullable=False),
        sa.PrimaryKeyConstraint("run_id", "number", name="pk_step"),
        sa.ForeignKeyConstraint(["run_id"], ["run.id"], name="fk_step_run"),
    )
    create(
        "message",
        text("kind"),
        number("row"),
        sa.Column("time", sa.Text),
        text("body"),
        sa.Column("written_at", sa.String(40), nullable=False),
    )
    create(
        "measured",
        number("first_row"),
        number("length"),
        sa.Column("first_time", sa.Float(53), nullable=False),
        blob("time"),
        blob("readings"),
        blob("contexts"),
    )
    create(
        "simulated",
        number("version"),
        text("origin"),
        number("row"),
        number("length"),
        blob("contexts"),
        blob("readings"),
        blob("falling"),
    )
    create(
        "inferred",
        number("version"),
        number("first_row"),
        number("length"),
        blob("contexts"),
        blob("spread"),
    )
    create(
        "gap",
        number("version"),
        number("first_row"),
        number("length"),
        blob("simulated"),
        blob("gaps"),
    )
    create(
        "version",
        number("number"),
        number("row"),
        text("model"),
        sa.Column("model_sha256", sa.String(64), nullable=False),
        text("causes"),
        sa.Column("gain", sa.Float(53)),
        sa.Column("gain_low", sa.Float(53)),
        sa.Column("gain_high", sa.Float(53)),
        text("status"),
    )
    create("in_force", number("version"), number("row"))
    create("findings", number("row"), text("findings"))
    create(
        "event",
        text("kind"),
        number("row"),
        text("time"),
        text("words"),
        text("sensors"),
        sa.Column("gap_before", sa.Float(53)),
        sa.Column("gap_after", sa.Float(53)),
    )
    create("kept", text("name"), number("row"), blob("data"))
    for table in ("measured", "inferred", "gap"):
        index(table, "first_row")
    index("measured", "first_time")
    index("version", "number", unique=True)
    index("kept", "name", "step")


def create(name: str, *columns: sa.Column[Any]) -> None:
    op.create_table(
        name,
        *(sa.Column(part, sa.Integer, autoincrement=False, nullable=False) for part in KEY),
        *columns,
        sa.PrimaryKeyConstraint(*KEY, name=f"pk_{name}"),
        sa.ForeignKeyConstraint(
            ["run_id", "step"], ["step.run_id", "step.number"], name=f"fk_{name}_step"
        ),
    )


def number(name: str) -> sa.Column[Any]:
    return sa.Column(name, sa.Integer, nullable=False)


def text(name: str) -> sa.Column[Any]:
    return sa.Column(name, sa.Text, nullable=False)


def blob(name: str) -> sa.Column[Any]:
    return sa.Column(name, sa.LargeBinary, nullable=False)


def index(table: str, *columns: str, unique: bool = False) -> None:
    names = ["run_id", *columns]
    op.create_index(f"ix_{table}_{'_'.join(names)}", table, names, unique=unique)
