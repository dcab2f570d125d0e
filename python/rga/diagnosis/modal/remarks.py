"""In words: how an explanation that was tried stands to what is named."""

from rga.findings.criteria import Criteria

#: log-odds that are as good as the same
SAME = 0.05


def rival_words(behind: float, whole: float, criteria: Criteria) -> str:
    """Of a rival.

    Args:
        behind: log-odds by which it is behind, at least.
        whole: the same by all that is known, what is usual of its parameters among it.
        criteria: say what is near.

    >>> rival_words(20.0, 44.0, Criteria())
    'rejected (-20.0 log-odds by the data alone)'
    """
    words = "rejected"
    if behind < criteria.rivals.log_odds:
        words = "cannot be separated from what is named"
    alone = " by the data alone" if behind < whole - SAME else ""
    return f"{words} ({-behind:+.1f} log-odds{alone})"


def apart_words(behind: float, whole: float) -> str:
    """Of the nearest explanation that is rejected: by what the modes tell it from what is named.

    Args:
        behind, whole: as for `rival_words`.

    >>> apart_words(41.0, 41.0)
    'these modes tell them apart by 41 log-odds'
    >>> apart_words(11.0, 15.0)
    'these modes tell them apart by 11 log-odds alone, by 15 with what is usual of their parameters'
    """
    words = f"these modes tell them apart by {behind:.0f} log-odds"
    if not behind < whole - SAME:
        return words
    return f"{words} alone, by {whole:.0f} with what is usual of their parameters"
