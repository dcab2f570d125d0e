"""Readings that a twin keeps, where somebody has asked for the latest alone."""

from rga.twin.archive import Archive
from rga.twin.rows.recent import RecentRows
from rga.twin.run_state import Standing

#: rows that are forgotten at a time, at the least
AT_ONCE = 32


def forget_what_is_old(standing: Standing, archive: Archive, rows: RecentRows) -> None:
    """Forget readings of rows that are older than those to be kept, within the step that is open.

    Those of the first calibration stay, and all that an alarm is about. Rows are forgotten many at
    a time, in whole packets, so that it costs little a row.

    Args:
        standing: says how many are to be kept, and how many are forgotten.
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
    end = archive.forget(begun, end)
    rows.forget(begun, end)
    standing.forgotten = end
