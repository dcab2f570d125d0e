"""What a twin that goes on for ever needs: states by pages, proposals, commands, messages by kind.

A state was one value: it is taken over as its only page.
"""

import sqlalchemy as sa
from alembic import op

revision = "0003"
down_revision = "0002"


def upgrade() -> None:
    op.execute("ALTER TABLE run RENAME COLUMN record_sha256 TO source")
    op.create_index("ix_message_run_id_kind_step", "message", ["run_id", "kind", "step"])
    op.create_table(
        "state_page",
        sa.Column("run_id", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("name", sa.String(40), nullable=False),
        sa.Column("page", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("run_id", "name", "page", name="pk_state_page"),
        sa.ForeignKeyConstraint(["run_id"], ["run.id"], name="fk_state_page_run"),
    )
    op.execute(
        "INSERT INTO state_page (run_id, name, page, data) "
        "SELECT run_id, name, 0, data FROM checkpoint"
    )
    op.drop_table("checkpoint")
    # What infers contexts was kept anew whenever it changed: the last of each is taken over.
    op.execute(
        "INSERT INTO state_page (run_id, name, page, data) "
        "SELECT run_id, name, 0, data FROM kept AS one "
        "WHERE (name IN ('learned', 'sound', 'given') OR name LIKE 'state %') AND step = "
        "(SELECT MAX(step) FROM kept WHERE name = one.name AND run_id = one.run_id)"
    )
    _of_steps(
        "proposal",
        sa.Column("number", sa.Integer, nullable=False),
        sa.Column("row", sa.Integer, nullable=False),
        sa.Column("words", sa.Text, nullable=False),
        sa.Column("effects", sa.Text, nullable=False),
        sa.Column("gain", sa.Float(53)),
        sa.Column("gain_low", sa.Float(53)),
        sa.Column("gain_high", sa.Float(53)),
    )
    _of_steps(
        "command",
        sa.Column("row", sa.Integer, nullable=False),
        sa.Column("kind", sa.Text, nullable=False),
        sa.Column("body", sa.Text, nullable=False),
        sa.Column("who", sa.Text, nullable=False),
        sa.Column("why", sa.Text, nullable=False),
        sa.Column("given_at", sa.String(40), nullable=False),
        sa.Column("outcome", sa.Text, nullable=False),
    )


def _of_steps(name: str, *columns: sa.Column[object]) -> None:
    op.create_table(
        name,
        sa.Column("run_id", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("step", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("ordinal", sa.Integer, autoincrement=False, nullable=False),
        *columns,
        sa.PrimaryKeyConstraint("run_id", "step", "ordinal", name=f"pk_{name}"),
        sa.ForeignKeyConstraint(
            ["run_id", "step"], ["step.run_id", "step.number"], name=f"fk_{name}_step"
        ),
    )
