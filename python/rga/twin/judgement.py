"""What came of a recalibration: do contexts explain the rows, or is the model in doubt?"""


def judged(
    rows: str,
    before: float,
    after: float,
    usual: float,
    changes: tuple[str, ...] | None,
    novel: bool,
) -> tuple[bool, str]:
    """Whether the model is in doubt after a recalibration, and what came of it in words.

    Args:
        rows: that it was about, in words.
        before, after: gap over the gap to expect [-].
        usual: what it stays below on stretches of the calibration [-].
        changes: of structure and sensors, by which the gap came down; None: what was learned
            infers contexts alone.
        novel: the rows have contexts that none before them had.
    """
    expected = (
        f"times what noise and scatter let expect (stretches of the calibration stay below "
        f"{usual:.2f})"
    )
    if after > usual:
        return True, (
            f"no contexts explain {rows}, nor does learning from them: the gap is {after:.2f} "
            f"{expected}; the model is in doubt"
        )
    if before <= usual:
        return False, f"contexts explain {rows}: the gap is {after:.2f} {expected}"
    if changes is not None and (changes or not novel):
        how = " and ".join(changes) or "many small changes of structure and sensors"
        return True, (
            f"no contexts explain {rows}: the gap is {before:.2f} {expected}, and falls to "
            f"{after:.2f} with {how}; the model is in doubt"
        )
    new = " have contexts that none had before" if novel else ""
    return False, (
        f"{rows}{new}: learning from them took the gap from {before:.2f} to {after:.2f} {expected}"
    )
