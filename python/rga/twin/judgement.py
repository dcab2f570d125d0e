"""What came of a recalibration: do contexts explain the rows, or is the model in doubt?"""

#: a gap that stays below so many times what noise and scatter let expect is small: what hides in
#: it is no larger than they
SMALL = 4.0


def unsettled(gap: float) -> tuple[str, ...]:
    """In words, that a calibration leaves a large gap; nothing of a small one.

    Args:
        gap: over the gap to expect [-].

    >>> unsettled(1.3)
    ()
    """
    if not gap > SMALL:
        return ()
    words = (
        f"the gap is {gap:.3g} times what noise and scatter let expect: model or sensors are wrong "
        "from the beginning, and a change has to be larger than that to show"
    )
    return (words,)


def judged(
    rows: str,
    before: float,
    after: float,
    usual: float,
    changes: tuple[str, ...] | None,
    novel: bool,
    inferred: bool,
) -> tuple[bool, str]:
    """Whether the model is in doubt after a recalibration, and what came of it in words.

    Args:
        rows: that it was about, in words.
        before, after: gap over the gap to expect [-].
        usual: what it stays below on stretches of the calibration [-].
        changes: of structure and sensors, by which the gap came down; None: what was learned
            infers contexts alone.
        novel: the rows have contexts that none before them had.
        inferred: contexts are; otherwise all are measured.
    """
    expected = (
        f"times what noise and scatter let expect (stretches of the calibration stay below "
        f"{usual:.3g})"
    )
    contexts = "no contexts explain" if inferred else "measured contexts do not explain"
    if after > usual:
        learning = ", nor does learning from them" if inferred else ""
        return True, (
            f"{contexts} {rows}{learning}: the gap is {after:.3g} {expected}; the model is in doubt"
        )
    if usual > SMALL:
        return True, (
            f"whether {rows} are as before cannot be seen: the gap is {after:.3g} {expected}, "
            "which is so large that a change hides in it; the model is in doubt"
        )
    if before <= usual:
        explained = "contexts explain" if inferred else "measured contexts explain"
        return False, f"{explained} {rows}: the gap is {after:.3g} {expected}"
    if changes is not None and (changes or not novel):
        how = " and ".join(changes) or "many small changes of structure and sensors"
        return True, (
            f"{contexts} {rows}: the gap is {before:.3g} {expected}, and falls to {after:.3g} "
            f"with {how}; the model is in doubt"
        )
    new = " have contexts that none had before" if novel else ""
    return False, (
        f"{rows}{new}: learning from them took the gap from {before:.3g} to {after:.3g} {expected}"
    )
