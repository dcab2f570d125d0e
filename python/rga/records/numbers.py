"""Numbers as loggers write them: decimal comma, thousands, and words for a missing value."""

import re
from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
import polars as pl
from numpy.typing import NDArray

from rga.arrays import FloatArray

#: what stands for a missing value in any file; Campbell Scientific writes NAN and INF, HBM
#: Overrange, spreadsheets #N/A. Codes that are numbers are missing only where they are stated.
MISSING_WORDS = frozenset({
    "NAN", "NaN", "nan", "INF", "-INF", "+INF", "-", "--", "---", "#N/A", "#NV", "#DIV/0!", "null",
    "NULL", "OVLD", "OL", "OFL", "Overrange", "OverRange", "OVERRANGE", "overrange", "Overflow",
    "OVERFLOW", "Overload", "OVERLOAD", "Underrange", "UnderRange", "UNDERRANGE", "1.#QNAN",
    "-1.#IND", "1.#INF", "-1.#INF", "1.#IO", "1.#R", "n/a", "N/A", "#NA",
})  # fmt: skip
#: signs that part thousands and nothing else
THOUSANDS = " '’\u00a0\u202f\u2009"
#: the sign of subtraction, which typesetters take for that of a negative number
MINUS = "\u2212"
#: signs of a number: looking at one takes their square
LONGEST = 400
_LEADING = r"[+-]?[1-9][0-9]{0,2}"
_GROUPED = re.compile(rf"{_LEADING}([{THOUSANDS}]\d{{3}})+([.,]\d*)?")


@dataclass(frozen=True)
class Notation:
    """How a file writes numbers.

    Attributes:
        decimal: sign before decimals.
        thousands: sign between thousands, where there may be any beside blanks and apostrophes.
        doubtful: whether the decimal sign may be one of thousands as well.
    """

    decimal: str = "."
    thousands: str = ""
    doubtful: bool = False


def numbers_of(
    series: pl.Series, notation: Notation, missing: tuple[str, ...] = ()
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Numbers of a column, float[n], NaN where a value is missing; and where a cell holds none.

    >>> cells = pl.Series(["1.234,5", "Overrange", None, "-9999", "x"])
    >>> numbers_of(cells, Notation(",", "."), ("-9999",))
    (array([1234.5,    nan,    nan,    nan,    nan]), array([False, False, False, False,  True]))
    """
    if series.dtype != pl.String:
        read = np.array(series.cast(pl.Float64).fill_null(np.nan).to_numpy(), dtype=float)
        return _without(read, missing), np.zeros(len(read), dtype=bool)
    cells = _plain(series, notation)
    values = cells.cast(pl.Float64, strict=False)
    odd = (values.is_null() & cells.is_not_null()) | values.is_infinite().fill_null(False)
    bad = np.zeros(len(series), dtype=bool)
    read = np.array(values.fill_null(np.nan).to_numpy(), dtype=float)
    if odd.any():
        rows = odd.arg_true().to_numpy()
        meanings = {cell: _meaning(cell, notation, missing) for cell in set(series.gather(rows))}
        for row in rows:
            meaning = meanings[series[int(row)]]
            bad[row] = meaning is None
            read[row] = np.nan if meaning is None else meaning
    return _without(read, missing), bad


def missing_words(
    series: pl.Series, notation: Notation, missing: tuple[str, ...] = ()
) -> dict[str, int]:
    """What stands in a column for missing values, and in how many rows.

    >>> missing_words(pl.Series(["1", "NAN", "-9999,0", "NAN"]), Notation(","), ("-9999",))
    {'NAN': 2, '-9999': 1}
    """
    found: dict[str, int] = {}
    codes = {code: number for code in missing if (number := _code(code)) is not None}
    if series.dtype == pl.String:
        words = sorted({*MISSING_WORDS, *missing} - codes.keys())
        found = dict(series.filter(series.is_in(words)).value_counts(sort=True).iter_rows())
    if codes:
        read, _ = numbers_of(series, notation)
        found |= {code: int((read == number).sum()) for code, number in codes.items()}
    return {word: rows for word, rows in found.items() if rows}


def notation_of(cells: Iterable[str], decimal: str | None, thousands: str | None) -> Notation:
    """How numbers are written, from some of them.

    Args:
        cells: some cells, among them texts that are no numbers.
        decimal, thousands: where they are stated.

    >>> notation_of(["7,90E-2", "x", "12"], None, None)
    Notation(decimal=',', thousands='', doubtful=False)
    >>> notation_of(["1.234,5", "12"], None, None), notation_of(["1,234"], None, None).doubtful
    (Notation(decimal=',', thousands='.', doubtful=False), True)
    """
    if decimal is not None:
        return Notation(decimal, thousands or "")
    grouped = {".": 0, ",": 0}
    marked = {".": 0, ",": 0}
    maybe = 0
    for cell in (one.replace(MINUS, "-") for one in cells if len(one) <= LONGEST):
        both = re.fullmatch(r"[+-]?[\d.,]*\d[\d.,]*([eEdD][+-]?\d+)?", cell)
        if both is None:
            continue
        mantissa = re.split("[eEdD]", cell)[0]
        last = max(mantissa.rfind("."), mantissa.rfind(","))
        if last < 0:
            continue
        sign = mantissa[last]
        other = "," if sign == "." else "."
        if other in mantissa:
            if re.fullmatch(rf"{_LEADING}([{other}]\d{{3}})+[{sign}]\d*", mantissa):
                marked[sign] += 1
                grouped[other] += 1
        elif mantissa.count(sign) > 1:
            if re.fullmatch(rf"{_LEADING}([{sign}]\d{{3}})+", mantissa):
                grouped[sign] += 1
        else:
            marked[sign] += 1
            maybe += bool(re.fullmatch(r"[+-]?[1-9]\d{0,2},\d{3}", cell))
    if thousands:
        comma = thousands == "." or (thousands != "," and marked[","] > 0)
        return Notation("," if comma else ".", thousands)
    if grouped["."] and not marked["."]:
        return Notation(",", ".")
    if marked[","] > marked["."] and not grouped[","]:
        doubtful = maybe == marked[","] and not grouped["."]
        return Notation(",", "." if grouped["."] else "", doubtful)
    return Notation(".", "," if grouped[","] else "")


def _plain(series: pl.Series, notation: Notation) -> pl.Series:
    """Cells with a decimal point and no thousands; those that mix signs hold no number."""
    if series.str.contains(MINUS, literal=True).any():
        series = series.str.replace_all(MINUS, "-", literal=True)
    if notation.thousands and (held := series.str.contains(notation.thousands, literal=True)).any():
        # A sign that does not part groups of three digits is none of thousands.
        frame = pl.DataFrame({"cell": series, "held": held})
        cell = pl.col("cell")
        ungrouped = cell.str.replace_all(notation.thousands, "", literal=True)
        meant = pl.when(cell.str.contains(f"^{_grouped(notation)}$")).then(ungrouped)
        series = frame.select(
            pl.when("held").then(meant.otherwise("?" + cell)).otherwise(cell).alias(series.name)
        ).to_series()
    if notation.decimal != ",":
        return series
    both = series.str.contains(".", literal=True)
    plain = series.str.replace(",", ".", literal=True)
    if both.any():
        marked = pl.DataFrame({"plain": plain, "series": series, "both": both})
        # A point in a file of decimal commas may part thousands: it is not taken for either.
        unclear = pl.lit("?") + pl.col("series")
        chosen = pl.when(pl.col("both")).then(unclear).otherwise(pl.col("plain"))
        return marked.select(chosen.alias(series.name)).to_series()
    return plain


def _grouped(notation: Notation) -> str:
    """Pattern of a number whose thousands are parted: 1.234.567,8."""
    thousands, decimal = re.escape(notation.thousands), re.escape(notation.decimal)
    return rf"{_LEADING}({thousands}[0-9]{{3}})+({decimal}[0-9]*)?([eEdD][+-]?[0-9]+)?"


def _meaning(cell: str, notation: Notation, missing: tuple[str, ...]) -> float | None:
    """The number that an odd cell says, NaN where it says that it is missing, None: nothing."""
    if cell in MISSING_WORDS or cell in missing:
        return float("nan")
    cell = cell.replace(MINUS, "-")
    if _GROUPED.fullmatch(cell):
        cell = re.sub(f"[{THOUSANDS}]", "", cell)
    if notation.thousands and notation.thousands in cell:
        if not re.fullmatch(_grouped(notation), cell):
            return None
        cell = cell.replace(notation.thousands, "")
    if notation.decimal == ",":
        if "." in cell:
            return None
        cell = cell.replace(",", ".")
    # Fortran writes 1D+3; Python reads 1_000, which no logger writes.
    cell = re.sub("[dD]", "e", cell)
    try:
        return None if "_" in cell or not cell.isascii() else float(cell)
    except ValueError:
        return None


def _without(read: FloatArray, missing: tuple[str, ...]) -> FloatArray:
    """Numbers without those that are stated to stand for a missing value."""
    for code in missing:
        if (stated := _code(code)) is not None:
            read = np.where(read == stated, np.nan, read)
    return read


def _code(word: str) -> float | None:
    """The number that is stated to stand for a missing value; None: it is a word."""
    try:
        return float(word.replace(",", "."))
    except ValueError:
        return None
