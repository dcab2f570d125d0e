"""What lies beside the means of rows, as it is kept."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from sqlalchemy import select

from rga.operation.inbox import tables
from rga.twin.hardware.inbox import Inbox
from rga.twin.repository.table_file import values_of

_Floats = NDArray[np.float32]
_Counts = NDArray[np.uint32]


@dataclass(frozen=True)
class KeptCell:
    """The samples of a cell, by channel and measured context.

    Attributes:
        begin: of the cell, microseconds since 1970 (UTC).
        count: of samples.
        least, most: of them, NaN where there is none.
        conflicts: samples that were left out, as another value of the same moment came before.
    """

    begin: int
    count: _Counts
    least: _Floats
    most: _Floats
    conflicts: _Counts


def cells_after(inbox: Inbox, moment: int, most: int) -> list[KeptCell]:
    """The first cells that begin after a moment [µs since 1970], at most so many.

    Raises:
        InputError: the inbox cannot be read.
    """
    c = tables.cell.c
    chosen = select(tables.cell).where(c.begin > moment).order_by(c.begin).limit(most)
    cells = []
    with inbox.reading() as connection:
        for entry in connection.execute(chosen):
            kept = values_of(tables.cell, entry)
            cells.append(
                KeptCell(
                    kept["begin"],
                    np.frombuffer(kept["count"], "<u4"),
                    np.frombuffer(kept["least"], "<f4"),
                    np.frombuffer(kept["most"], "<f4"),
                    np.frombuffer(kept["conflicts"], "<u4"),
                )
            )
    return cells
