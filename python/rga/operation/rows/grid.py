"""The cells in time of which each makes a row, and when they are final."""

from collections.abc import Collection, Mapping
from dataclasses import dataclass

from rga.operation.rows.cells import cell_of


@dataclass(frozen=True)
class Grid:
    """The cells in time of which each makes a row.

    Attributes:
        every: length of a cell [µs].
        lateness: by which a source may send samples after others of later times [µs].
    """

    every: int
    lateness: int

    def final_until(
        self, latest: Mapping[str, int | None], silent: Collection[str] = ()
    ) -> int | None:
        """Moment before which no more samples are waited for; None: all may still come.

        A row waits until every source is past its end by the lateness. One that is silent is
        waited for no longer; where all are, the row that they were in is final too.

        Args:
            latest: moment that each source has sent [µs since 1970]; None: it has sent nothing.
            silent: sources that nothing has been heard of for too long.

        >>> grid = Grid(every=60, lateness=10)
        >>> grid.final_until({"a": 130, "b": 300}), grid.final_until({"a": 129})
        (120, 60)
        >>> grid.final_until({"a": 30, "b": 300}, ["a"]), grid.final_until({"a": 30}, ["a"])
        (240, 60)
        >>> grid.final_until({"a": None, "b": 300})
        """
        sent = [moment for moment in latest.values() if moment is not None]
        speaking = [moment for source, moment in latest.items() if source not in silent]
        if not sent or None in speaking:
            return None
        if not speaking:
            return cell_of(max(sent), self.every) + self.every
        return cell_of(min(one for one in speaking if one is not None) - self.lateness, self.every)
