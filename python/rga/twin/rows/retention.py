"""Readings that a twin keeps, where somebody has asked for the latest alone."""

from collections.abc import Sequence

from rga.twin.archive import Archive
from rga.twin.past.chosen_past import BEGINNINGS
from rga.twin.rows.recent import RecentRows
from rga.twin.run_state import Standing

#: rows that are forgotten at a time, at the least
AT_ONCE = 32
#: rows on either side of what happened to a twin that are kept, so that it can be dated
ABOUT = 100


def forget_what_is_old(standing: Standing, archive: Archive, rows: RecentRows) -> None:
    """Forget readings of rows that are older than those to be kept, within the step that is open.

    Those of the first calibration stay, those about alarms and versions, and all that an open
    alarm is about. Rows are forgotten many at a time, in whole packets, so that it costs little
    a row.

    Args:
        standing: says how many are to be kept, and which are forgotten.
        archive: keeps them.
        rows: holds the latest in memory.
    """
    if standing.keep is None or not standing.calibrated:
        return
    end = standing.row - standing.keep
    if standing.since is not None:
        end = min(end, standing.since)
    begun = max(standing.forgotten, standing.calibrated)
    if end < begun + AT_ONCE:
        return
    packets = archive.run.packets(begun, end)
    marks = [one.row for one in archive.run.events() if one.kind in BEGINNINGS]
    for first, behind in _on_end(packets, marks):
        archive.forget(first, behind)
        rows.forget(first, behind)
        standing.forgotten_rows += ((first, behind),)
    if packets:
        standing.forgotten = packets[-1][1]
    standing.forgotten_rows = joined(standing.forgotten_rows)


def _on_end(packets: Sequence[tuple[int, int]], marks: Sequence[int]) -> list[tuple[int, int]]:
    """Stretches of the packets that are about no mark.

    >>> _on_end([(0, 50), (50, 100), (100, 150), (400, 450)], [220])
    [(0, 100), (400, 450)]
    """
    return list(
        joined(
            [
                (first, behind)
                for first, behind in packets
                if not any(first - ABOUT < mark < behind + ABOUT for mark in marks)
            ]
        )
    )


def joined(stretches: Sequence[tuple[int, int]]) -> tuple[tuple[int, int], ...]:
    """Stretches in their order, those that touch as one.

    >>> joined([(0, 10), (10, 20), (30, 40)])
    ((0, 20), (30, 40))
    """
    whole: list[tuple[int, int]] = []
    for first, behind in stretches:
        if whole and whole[-1][1] == first:
            whole[-1] = (whole[-1][0], behind)
        else:
            whole.append((first, behind))
    return tuple(whole)
