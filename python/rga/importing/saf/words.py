"""Words of SAF in cells that choose among a few: one that is not known is refused by its cell."""

from rga.importing.draft import ModelDraft
from rga.importing.sheets import SheetRow

#: words of each column in small letters, the first of which stands for an empty cell
WORDS: dict[str, tuple[str, ...]] = {
    "behaviour in analysis": (
        "standard", "axial force only", "compression only", "tension only",
    ),
    "lcs": ("y by vector", "z by vector", "y by point", "z by point"),
    "coordinate system": ("global", "local"),
    "coordinate definition": ("absolute", "relative"),
    "origin": ("from start", "from end"),
    "extent": ("full", "span"),
    "location": ("length", "projection"),
    "distribution": ("uniform", "trapez"),
    "position": ("both", "begin", "end"),
}  # fmt: skip


def word(row: SheetRow, column: str, draft: ModelDraft) -> str:
    """The word of a cell in small letters; that of an empty cell where it is not known."""
    known = WORDS[column]
    found = " ".join(row.text(column).lower().split())
    if found and found not in known:
        draft.notes.refuse(
            f"{row.where}, column {column!r}", f"{found!r} is not one of {', '.join(known)}",
            "correct it", "partial",
        )  # fmt: skip
    return found if found in known else known[0]
