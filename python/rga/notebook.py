"""What a notebook shows of an object: a sentence and the head of its table."""

from html import escape
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import polars as pl

ROWS, COLUMNS, LETTERS = 8, 10, 60


def short_html(title: str, sentence: str, frame: "pl.DataFrame") -> str:
    """A title, a sentence and the first and last rows of a table, as HTML.

    Args:
        title, sentence: any text; what would be markup is escaped.
        frame: the table.

    >>> import polars as pl
    >>> short_html("<truss>", "1 member", pl.DataFrame({"member": ["<b>"]})).count("&lt;")
    2
    """
    import polars as pl

    with pl.Config(
        tbl_rows=ROWS,
        tbl_cols=COLUMNS,
        fmt_str_lengths=LETTERS,
        tbl_hide_dataframe_shape=True,
        tbl_hide_column_data_types=True,
    ):
        table = frame._repr_html_() if frame.height else ""
    return f"<div><b>{escape(title)}</b><br>{escape(sentence)}{table}</div>"
