"""Whether there is room on the disk of a service for what can wait."""

import shutil
from dataclasses import dataclass
from pathlib import Path

from rga.twin.repository.faults import RepositoryFault


@dataclass(frozen=True)
class DiskRoom:
    """The disk of a service.

    Below a share that has to be free, long steps of twins and the archive of packets wait, so that
    what is left is for what loggers send.

    Attributes:
        data: folder of the twins.
        least: share of its disk that has to be free.
    """

    data: Path
    least: float

    @property
    def free(self) -> int:
        """Bytes that are free.

        Raises:
            RepositoryFault: the disk cannot be looked at.
        """
        return self._measured()[0]

    @property
    def free_share(self) -> float:
        """Share that is free.

        Raises:
            RepositoryFault: the disk cannot be looked at.
        """
        free, total = self._measured()
        return free / total

    def is_enough(self) -> bool:
        """Whether as much is free as has to be.

        Raises:
            RepositoryFault: the disk cannot be looked at.
        """
        return self.free_share >= self.least

    def _measured(self) -> tuple[int, int]:
        """Bytes that are free, and all that there are."""
        try:
            found = shutil.disk_usage(self.data)
        except OSError as error:
            what, remedy = "the disk cannot be looked at", "see that the folder is there"
            raise RepositoryFault(what, str(self.data), remedy) from error
        return found.free, found.total
