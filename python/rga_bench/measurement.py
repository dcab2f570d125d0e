"""One line of a table of measurements."""

from dataclasses import dataclass, replace

HEADINGS = ("what", "measured", "beside", "there", "times as good", "at least")


@dataclass(frozen=True)
class Measurement:
    """What was measured, and beside what.

    Attributes:
        case: heading that it stands under.
        name: what is measured.
        value: ours, in `unit`.
        unit: of the values: s, or something of which more is better.
        peer: what does the same in the same run, or nothing.
        peer_value: that of the peer; nothing where it is not installed.
        ratio: how many times as fast as the peer, or as good.
        least: that the ratio should be at least.
    """

    case: str
    name: str
    value: float
    unit: str = ""
    peer: str | None = None
    peer_value: float | None = None
    ratio: float | None = None
    least: float | None = None

    def beside(self, peer: str, value: float | None, least: float | None = None) -> "Measurement":
        """The same with a peer; no value where that is not installed."""
        ratio = None
        if value is not None:
            ratio = value / self.value if self.unit == "s" else self.value / value
        return replace(self, peer=peer, peer_value=value, ratio=ratio, least=least)

    def cells(self) -> list[str]:
        """What stands under the headings."""
        cells = [self.name, _value(self.value, self.unit), self.peer or ""]
        if self.peer is None:
            cells.append("")
        elif self.peer_value is None:
            cells.append("not installed")
        else:
            cells.append(_value(self.peer_value, self.unit))
        cells.append("" if self.ratio is None else digits(self.ratio))
        if self.least is None:
            return [*cells, ""]
        mark = "" if self.ratio is None else " ✓" if self.ratio >= self.least else " ✗"
        return [*cells, f"{self.least:.2g}{mark}"]


def _value(value: float, unit: str) -> str:
    """Three digits, and a unit that suits them."""
    if unit == "/s":
        big, name = (1e6, " million") if value >= 1e6 else (1.0, "")
        return f"{digits(value / big)}{name}/s"
    if unit == "s":
        scale, name = next(
            (scale, name)
            for scale, name in ((1.0, "s"), (1e3, "ms"), (1e6, "us"))
            if value * scale >= 1.0 or name == "us"
        )
        return f"{digits(value * scale)} {name}"
    return f"{digits(value)} {unit}".rstrip()


def digits(value: float) -> str:
    """Three of them."""
    if value >= 1e3:
        rounded = float(f"{value:.3g}")
        return f"{rounded:,.0f}".replace(",", " ")
    return f"{value:.3g}"
