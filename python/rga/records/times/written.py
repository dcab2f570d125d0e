"""How time stamps are written, from the stamps themselves."""

import re
from collections.abc import Sequence
from datetime import datetime
from itertools import pairwise
from statistics import median

import polars as pl

_STAMP = re.compile(
    r"(?P<date>(?P<a>\d{1,4})(?P<sign>[-./])(?P<b>\d{1,2}|[A-Za-z]{3})(?P=sign)(?P<c>\d{2,4}))"
    r"(?P<gap>[T ]+)?(?P<clock>(?P<hour>\d{1,2}):\d{2}(?P<second>:\d{2}(?P<point>[.,:])?\d*)?)?"
    r"(?P<half>\s*[AaPp][Mm])?"
)
_DECIMALS = re.compile(r":\d{2}(?P<point>[.,])\d")


def written_format(texts: Sequence[str]) -> str | None:
    """The strptime pattern of time stamps that are not ISO 8601.

    A date such as 03/04/2024 is read as its kin are that allow one order only, or as time then
    increases; where that leaves both orders, there is no pattern.

    >>> written_format(["01.09.2014 13:25:39"]), written_format(["9/13/2021 4:05:00 PM"])
    ('%d.%m.%Y %H:%M:%S', '%m/%d/%Y %I:%M:%S %p')
    >>> written_format(["03/04/2024 10:00", "03/04/2024 10:10"]) is None
    True
    """
    found = _STAMP.fullmatch(texts[0])
    if found is None or (found["clock"] and not found["gap"]):
        return None
    sign, gap = found["sign"], found["gap"] or ""
    rest = ""
    if found["clock"]:
        hour = "%I" if found["half"] else "%H"
        # Decimals may come and go: 10:00:00, 10:00:00.5.
        decimals = (_DECIMALS.search(text) for text in texts)
        point = found["point"] or next((one["point"] for one in decimals if one), "")
        second = f":%S{point}%f" if point else (":%S" if found["second"] else "")
        half = (" " if found["half"] and found["half"][0] == " " else "") + "%p"
        rest = f"{gap}{hour}:%M{second}" + (half if found["half"] else "")
    year = "%Y" if max(len(found["a"]), len(found["c"])) == 4 else "%y"
    month = "%b" if found["b"].isalpha() else "%m"
    if len(found["a"]) == 4:
        return f"%Y{sign}{month}{sign}%d{rest}"
    day_first, month_first = (
        f"{first}{sign}{second}{sign}{year}{rest}"
        for first, second in (("%d", month), ("%m", "%d"))
    )
    if sign == "." or month == "%b":
        return day_first
    numbers = [re.split(r"\D", text, maxsplit=2)[:2] for text in texts]
    if any(len(one) == 2 and one[0].isdigit() and int(one[0]) > 12 for one in numbers):
        return day_first
    if any(len(one) == 2 and one[1].isdigit() and int(one[1]) > 12 for one in numbers):
        return month_first
    grows = [_grows(texts, pattern) for pattern in (day_first, month_first)]
    if grows[0] != grows[1]:
        return day_first if grows[0] else month_first
    return None


def moments_by(texts: Sequence[str], pattern: str) -> list[datetime] | None:
    """Moments of many stamps at once; None where a pattern or a stamp wants a closer look.

    >>> moments_by(["01.02.2024 10:00:00.4"], "%d.%m.%Y %H:%M:%S.%f")
    [datetime.datetime(2024, 2, 1, 10, 0, 0, 400000)]
    """
    as_chrono = pattern.replace(".%f", "%.f").replace(",%f", "%.f")
    if "%f" in as_chrono or not set(re.findall("%(.)", pattern)) <= set("YymdHMSfbIp"):
        return None
    try:
        stamps = pl.Series(texts)
        if ",%f" in pattern:
            stamps = stamps.str.replace_all(",", ".", literal=True)
        read = stamps.str.to_datetime(as_chrono, strict=False, time_unit="us")
        return None if read.has_nulls() else read.to_list()
    except (pl.exceptions.PolarsError, ValueError):  # among these, years that Python has not
        return None


def _grows(texts: Sequence[str], pattern: str) -> bool:
    """Whether time increases from stamp to stamp within days, and from day to day."""
    moments = moments_by(texts, pattern)
    if moments is None or (moments[-1] - moments[0]).days < 1:
        return False
    steps = [(b - a).total_seconds() for a, b in pairwise(moments)]
    # A month taken for a day leaps by weeks at midnight.
    return min(steps) > 0 and median(steps) < 86400 and max(steps) < 20 * 86400
