"""Files that hold several tables: which one is read."""

from collections.abc import Sequence
from pathlib import Path
from typing import TypeVar

from rga.errors import InputError

T = TypeVar("T")


def chosen_block(
    blocks: Sequence[T], said: Sequence[str], wanted: int | None, path: Path
) -> tuple[T, list[str]]:
    """The table that is read, and a note of the others.

    Args:
        blocks: tables of the file.
        said: what is in each, in words.
        wanted: number of the one that is read, counted from 1; None: the first.
        path: the file, for an error.

    Raises:
        InputError: there is no such block.

    >>> chosen_block(["a", "b"], ["2 rows", "9 rows"], None, Path("r.dat"))
    ('a', ['block 1 of 2 is read; block 2 has 9 rows: block = ... in import.toml reads another'])
    """
    number = 1 if wanted is None else wanted
    if number > len(blocks):
        raise InputError(
            f"block = {number}, but the file has {len(blocks)}", str(path), "give one that is there"
        )
    if len(blocks) == 1 or wanted is not None:
        return blocks[number - 1], []
    others = "; ".join(f"block {k} has {words}" for k, words in enumerate(said, 1) if k != number)
    note = f"block {number} of {len(blocks)} is read; {others}: block = ... in import.toml reads"
    return blocks[number - 1], [f"{note} another"]
