"""A checksum for every entry: what is there is taken to be whole."""

import sqlalchemy as sa
from alembic import op

from rga.twin.repository.checksum import COLUMN, checksum

revision = "0004"
down_revision = "0003"

OF_STEPS = ("run_id", "step", "ordinal")
KEYS = {
    "step": ("run_id", "number"),
    "state_page": ("run_id", "name", "page"),
} | dict.fromkeys(
    (
        "message", "measured", "simulated", "inferred", "gap", "version", "in_force", "findings",
        "event", "kept", "proposal", "command",
    ),
    OF_STEPS,
)  # fmt: skip


def upgrade() -> None:
    connection = op.get_bind()
    for name, key in KEYS.items():
        op.add_column(
            name, sa.Column(COLUMN, sa.BigInteger, nullable=False, server_default=sa.text("0"))
        )
        any_entry = sa.select(sa.literal(1)).select_from(sa.table(name)).limit(1)
        if connection.scalar(any_entry) is None:
            # To look up how a table is made takes long, and every new repository comes by here.
            continue
        table = sa.Table(name, sa.MetaData(), autoload_with=connection)
        order = [table.c[column] for column in key]
        for place in connection.execute(sa.select(*order)).all():
            own = sa.and_(*(column == value for column, value in zip(order, place, strict=True)))
            entry = connection.execute(sa.select(table).where(own)).one()
            connection.execute(
                sa.update(table).where(own).values({COLUMN: checksum(entry._asdict())})
            )
