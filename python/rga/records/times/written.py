"""How time stamps are written, from the stamps themselves."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from datetime import datetime

import numpy as np
import polars as pl

_STAMP = re.compile(
    r"(?P<date>(?P<a>\d{1,4})(?P<sign>[-./])(?P<b>\d{1,2}|[A-Za-z]{3})(?P=sign)(?P<c>\d{2,4}))"
    r"(?P<gap>[T ]+)?(?P<clock>(?P<hour>\d{1,2}):\d{2}(?P<second>:\d{2}(?P<point>[.,:])?\d*)?)?"
    r"(?P<half>\s*[AaPp][Mm])?"
)
#: 24:00, with or without its seconds
_LATE = r"(?P<before>^|[T ])24:00(?P<rest>(:00([.,:]0+)?)?([^0-9:.,].*)?)$"
_DECIMALS = re.compile(r":\d{2}(?P<point>[.,])\d")


def written_format(texts: Sequence[str]) -> str | None:
    """The strptime pattern of time stamps that are not ISO 8601; None where there is not just one.

    >>> written_format(["01.09.2014 13:25:39"]), written_format(["9/13/2021 4:05:00 PM"])
    ('%d.%m.%Y %H:%M:%S', '%m/%d/%Y %I:%M:%S %p')
    >>> written_format(["03/04/2024 10:00", "03/04/2024 10:10"]) is None
    True
    """
    formats = possible_formats(texts)
    return formats[0] if len(formats) == 1 else None


def without_late_midnights(texts: Sequence[str]) -> tuple[list[str], list[int]]:
    """Stamps with midnight at the beginning of a day, and the rows in which it was at the end.

    >>> without_late_midnights(["2024-03-05 23:00", "2024-03-05 24:00"])
    (['2024-03-05 23:00', '2024-03-05 00:00'], [1])
    """
    stamps = pl.Series(texts)
    late = stamps.str.contains(_LATE).arg_true().to_list()
    if not late:
        return list(texts), []
    return stamps.str.replace(_LATE, "${before}00:00${rest}").to_list(), late


def possible_formats(texts: Sequence[str]) -> list[str]:
    """The strptime patterns by which time stamps that are not ISO 8601 can be read.

    A date such as 03/04/2024, or 24/01/05 with a year of two digits, is read in the one order that
    all stamps allow, or else in the one by which time goes on in its usual step at midnight. Where
    that leaves several orders, all of them are given.

    >>> possible_formats(["24/01/05 10:00"])
    ['%d/%m/%y %H:%M', '%y/%m/%d %H:%M']
    >>> possible_formats(["24/01/05 23:50", "24/01/06 00:00"]), possible_formats(["noon"])
    (['%y/%m/%d %H:%M'], [])
    """
    found = _STAMP.fullmatch(texts[0])
    if found is None or (found["clock"] and not found["gap"]):
        return []
    rest = _rest(found, texts)
    sign = found["sign"]
    year = "%Y" if max(len(found["a"]), len(found["c"])) == 4 else "%y"
    if found["b"].isalpha():
        order = ("%Y", "%b", "%d") if len(found["a"]) == 4 else ("%d", "%b", year)
        return [sign.join(order) + rest]
    orders = [("%Y", "%m", "%d")] if len(found["a"]) == 4 else _orders(texts, sign, year)
    patterns = [sign.join(order) + rest for order in orders]
    if len(patterns) < 2:
        return patterns
    going = {one: _Going.of(read) for one in patterns if (read := _read(texts, one)) is not None}
    forward = [one for one, rows in going.items() if rows.forward]
    if len(forward) == 1 and going[forward[0]].near:
        return forward
    steady = [one for one in forward if going[one].steady]
    if len(steady) == 1:
        return steady
    return forward if len(forward) > 1 else patterns


def _rest(found: re.Match[str], texts: Sequence[str]) -> str:
    """The pattern of what follows the date in a stamp."""
    if not found["clock"]:
        return ""
    hour = "%I" if found["half"] else "%H"
    # Decimals may come and go: 10:00:00, 10:00:00.5.
    decimals = (_DECIMALS.search(text) for text in texts)
    point = found["point"] or next((one["point"] for one in decimals if one), "")
    second = f":%S{point}%f" if point else (":%S" if found["second"] else "")
    half = (" " if found["half"] and found["half"][0] == " " else "") + "%p"
    return f"{found['gap']}{hour}:%M{second}" + (half if found["half"] else "")


def _orders(texts: Sequence[str], sign: str, year: str) -> list[tuple[str, str, str]]:
    """Orders of day, month and year of which no stamp has a number that is too large."""
    numbers = pl.Series(texts).str.extract_groups(r"^(\d{1,2})[-./](\d{1,2})[-./](\d{2,4})")
    largest = [numbers.struct.field(key).cast(pl.Int64).max() for key in ("1", "2", "3")]
    day, month = 31, 12
    orders = [(("%d", "%m", year), (day, month, 9999))]
    if sign != ".":
        orders.append((("%m", "%d", year), (month, day, 9999)))
    if year == "%y":
        orders.append((("%y", "%m", "%d"), (99, month, day)))
    possible = [
        order
        for order, most in orders
        if all(one <= limit for one, limit in zip(largest, most, strict=True))  # type: ignore[operator]
    ]
    # Where none fits all stamps, the first that does not is found by its line.
    return possible or [orders[0][0]]


def moments_by(texts: Sequence[str], pattern: str) -> list[datetime] | None:
    """Moments of many stamps at once; None where a pattern or a stamp wants a closer look.

    >>> moments_by(["01.02.2024 10:00:00.4"], "%d.%m.%Y %H:%M:%S.%f")
    [datetime.datetime(2024, 2, 1, 10, 0, 0, 400000)]
    """
    try:
        read = _read(texts, pattern)
        return None if read is None else read.to_list()
    except ValueError:  # years that Python has not
        return None


def _read(texts: Sequence[str], pattern: str) -> pl.Series | None:
    as_chrono = pattern.replace(".%f", "%.f").replace(",%f", "%.f")
    if "%f" in as_chrono or not set(re.findall("%(.)", pattern)) <= set("YymdHMSfbIp"):
        return None
    try:
        stamps = pl.Series(texts)
        if ",%f" in pattern:
            stamps = stamps.str.replace_all(",", ".", literal=True)
        read = stamps.str.to_datetime(as_chrono, strict=False, time_unit="us")
    except pl.exceptions.PolarsError:
        return None
    return None if read.has_nulls() else read


@dataclass(frozen=True)
class _Going:
    """How time goes from row to row in one reading of the stamps.

    Attributes:
        forward: it never runs back, but for the hour of an autumn night.
        near: it never leaps by weeks, as a month or a year taken for a day does.
        steady: it goes on at some midnight in its usual step, which is less than a day.
    """

    forward: bool
    near: bool
    steady: bool

    @classmethod
    def of(cls, moments: pl.Series) -> "_Going":
        steps = moments.diff().drop_nulls().dt.total_microseconds().to_numpy() / 1e6
        if len(steps) == 0:
            return cls(forward=False, near=False, steady=False)
        usual = float(np.median(steps))
        midnight = np.diff(moments.dt.date().to_physical().to_numpy()) != 0
        going_on = midnight & (steps > 0) & (steps <= 2 * usual)
        return cls(
            forward=bool(steps.min() >= -3600),
            near=bool(steps.max() < 20 * 86400),
            steady=usual < 86400 and bool(going_on.any()),
        )
