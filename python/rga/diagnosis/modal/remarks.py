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
