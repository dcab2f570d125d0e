"""The tables. Nothing stored is ever changed, so that the past can be read as it stood.

Only the state that a run goes on from is: nobody asks for that of the past.
"""

from typing import Any

from sqlalchemy import (
    BigInteger,
    Column,
    Float,
    ForeignKey,
    ForeignKeyConstraint,
    Index,
    Integer,
    MetaData,
    String,
    Table,
    Text,
)

from rga.twin.repository.columns import blob, checksum, text

metadata = MetaData(
    naming_convention={
        "pk": "pk_%(table_name)s",
        "fk": "fk_%(table_name)s_%(referred_table_name)s",
        "uq": "uq_%(table_name)s_%(column_0_name)s",
        "ix": "ix_%(table_name)s_%(column_0_N_name)s",
    }
)

run = Table(
    "run",
    metadata,
    Column("id", Integer, primary_key=True),
    Column("key", String(64), nullable=False, unique=True),
    Column("model_sha256", String(64), nullable=False),
    Column("source", String(64), nullable=False),
    Column("seed", BigInteger, nullable=False),
    Column("settings", Text, nullable=False),
    Column("begun_at", String(40), nullable=False),
)

# `row` is the last row of the record that this step or one before it was about.
step = Table(
    "step",
    metadata,
    Column("run_id", Integer, ForeignKey("run.id"), primary_key=True, autoincrement=False),
    Column("number", Integer, primary_key=True, autoincrement=False),
    Column("row", Integer, nullable=False),
    Column("written_at", String(40), nullable=False),
    checksum(),
)


def _stored(name: str, *columns: Column[Any] | Index) -> Table:
    """A table of what steps stored, in the order (step, ordinal)."""
    return Table(
        name,
        metadata,
        Column("run_id", Integer, primary_key=True, autoincrement=False),
        Column("step", Integer, primary_key=True, autoincrement=False),
        Column("ordinal", Integer, primary_key=True, autoincrement=False),
        *columns,
        checksum(),
        ForeignKeyConstraint(["run_id", "step"], ["step.run_id", "step.number"]),
    )


def _number(name: str) -> Column[Any]:
    return Column(name, Integer, nullable=False)


message = _stored(
    "message",
    text("kind"),
    _number("row"),
    Column("time", Text),
    text("body"),
    Column("written_at", String(40), nullable=False),
    Index(None, "run_id", "kind", "step"),
)

# Packets of rows: arrays are little-endian float64, row after row.
measured = _stored(
    "measured",
    _number("first_row"),
    _number("length"),
    Column("first_time", Float(53), nullable=False),
    blob("time"),
    blob("readings"),
    blob("contexts"),
    Index(None, "run_id", "first_row"),
    Index(None, "run_id", "first_time"),
)
simulated = _stored(
    "simulated",
    _number("version"),
    text("origin"),
    _number("row"),
    _number("length"),
    blob("contexts"),
    blob("readings"),
    blob("falling"),
)
inferred = _stored(
    "inferred",
    _number("version"),
    _number("first_row"),
    _number("length"),
    blob("contexts"),
    blob("spread"),
    Index(None, "run_id", "first_row"),
)
gap = _stored(
    "gap",
    _number("version"),
    _number("first_row"),
    _number("length"),
    blob("simulated"),
    blob("gaps"),
    Index(None, "run_id", "first_row"),
)

version = _stored(
    "version",
    _number("number"),
    _number("row"),
    text("model"),
    Column("model_sha256", String(64), nullable=False),
    text("causes"),
    Column("gain", Float(53)),
    Column("gain_low", Float(53)),
    Column("gain_high", Float(53)),
    text("status"),
    Index(None, "run_id", "number", unique=True),
)
in_force = _stored("in_force", _number("version"), _number("row"))
findings = _stored("findings", _number("row"), text("findings"))
event = _stored(
    "event",
    text("kind"),
    _number("row"),
    text("time"),
    text("words"),
    text("sensors"),
    Column("gap_before", Float(53)),
    Column("gap_after", Float(53)),
)
kept = _stored(
    "kept",
    text("name"),
    _number("row"),
    blob("data"),
    Index(None, "run_id", "name", "step"),
)

# A change of the model that a diagnosis proposes.
proposal = _stored(
    "proposal",
    _number("number"),
    _number("row"),
    text("words"),
    text("effects"),
    Column("gain", Float(53)),
    Column("gain_low", Float(53)),
    Column("gain_high", Float(53)),
)

# What people asked for, and what came of it.
command = _stored(
    "command",
    _number("row"),
    text("kind"),
    text("body"),
    text("who"),
    text("why"),
    Column("given_at", String(40), nullable=False),
    text("outcome"),
)

# What only a run that goes on needs, as its last step left it: pages of one size.
state_page = Table(
    "state_page",
    metadata,
    Column("run_id", Integer, ForeignKey("run.id"), primary_key=True, autoincrement=False),
    Column("name", String(40), primary_key=True),
    Column("page", Integer, primary_key=True, autoincrement=False),
    blob("data"),
    checksum(),
)

#: tables of what belongs to a run, with a checksum for every entry
OF_A_RUN = (
    step,
    message,
    measured,
    simulated,
    inferred,
    gap,
    version,
    in_force,
    findings,
    event,
    kept,
    proposal,
    command,
    state_page,
)
