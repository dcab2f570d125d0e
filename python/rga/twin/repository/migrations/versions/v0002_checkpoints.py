"""The state that a run goes on from, written over by every step.

Detectors were kept anew by every step: the last one of each run is taken over.
"""

import sqlalchemy as sa
from alembic import op

revision = "0002"
down_revision = "0001"


def upgrade() -> None:
    op.create_table(
        "checkpoint",
        sa.Column("run_id", sa.Integer, autoincrement=False, nullable=False),
        sa.Column("name", sa.String(40), nullable=False),
        sa.Column("step", sa.Integer, nullable=False),
        sa.Column("data", sa.LargeBinary, nullable=False),
        sa.PrimaryKeyConstraint("run_id", "name", name="pk_checkpoint"),
        sa.ForeignKeyConstraint(
            ["run_id", "step"], ["step.run_id", "step.number"], name="fk_checkpoint_step"
        ),
    )
    op.execute(
        "INSERT INTO checkpoint (run_id, name, step, data) "
        "SELECT run_id, name, step, data FROM kept AS one WHERE name = 'synchrony' AND step = "
        "(SELECT MAX(step) FROM kept WHERE name = 'synchrony' AND run_id = one.run_id)"
    )
