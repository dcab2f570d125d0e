"""What became of every packet."""

from dataclasses import dataclass


@dataclass(frozen=True)
class Account:
    """Packets of a source that arrived within an hour, or of more than one.

    Attributes:
        received: by the source.
        used: all their rows are sealed.
        duplicate: they had come before; nothing of them is kept.
        late: the rows that they are of were sealed before; they are kept, and not used live.
        partly_late: of those used or waiting, the ones that begin before what was sealed.
        refused: they cannot be read, or their clock is wrong; they are kept aside.
        waiting: for the rows that they are of.

    >>> Account(received=5, used=2, duplicate=1, waiting=1).difference
    1
    """

    received: int = 0
    used: int = 0
    duplicate: int = 0
    late: int = 0
    partly_late: int = 0
    refused: int = 0
    waiting: int = 0

    @property
    def difference(self) -> int:
        """Packets of which nothing is known: always 0, or something is broken."""
        known = self.used + self.duplicate + self.late + self.refused + self.waiting
        return self.received - known

    def __add__(self, other: "Account") -> "Account":
        return Account(**{name: value + getattr(other, name) for name, value in vars(self).items()})
