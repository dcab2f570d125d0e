"""One line of the table."""

from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Figure:
    """What was measured, and beside what.

    Attributes:
        case: heading that it stands under.
        name: what is measured.
        value: ours, in `unit`.
        unit: of the values: s, or something of which more is better.
        peer: what does the same in the same run, or nothing.
        peer_value: that of the peer; nothing where it is not installed.
        ratio: how many times as fast as the peer, or as good.
        least: what is asked of the ratio.
    """

    case: str
    name: str
    value: float
    unit: str = ""
    peer: str | None = None
    peer_value: float | None = None
    ratio: float | None = None
    least: float | None = None

    def beside(self, peer: str, value: float | None, least: float | None = None) -> "Figure":
        """The same with a peer; no value where that is not installed."""
        ratio = None
        if value is not None:
            ratio = value / self.value if self.unit == "s" else self.value / value
        return replace(self, peer=peer, peer_value=value, ratio=ratio, least=least)
