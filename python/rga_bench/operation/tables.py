"""What was measured of live operation, as tables."""

from collections.abc import Sequence

from rga_bench.operation.kills import Losses
from rga_bench.operation.pages import PageCost
from rga_bench.operation.rates import DENSE, Rate
from rga_bench.operation.unreadable import Unreadable
from rga_bench.text_table import TextTable

#: readings a second of a dense bridge
READINGS = DENSE[0] * DENSE[1]


def rate_table(found: Sequence[Rate]) -> TextTable:
    """What a packet costs."""
    rows = [
        [
            f"{one.packets:,}",
            f"{one.size:,}",
            f"{one.values:,}",
            f"{one.bare:,.0f}",
            f"{one.durable:,.0f}",
            f"{one.ratio:.2f}",
            f"{one.durable * one.values:,.0f}",
            f"{100 * READINGS / (one.durable * one.values):.2g}",
        ]
        for one in found
    ]
    headings = ["packets", "bytes", "readings in each", "bare [1/s]", "durable [1/s]", "ratio"]
    headings += ["readings [1/s]", "of a core for 84 x 250 Hz [%]"]
    return TextTable("What a packet costs", headings, rows, numbers=True)


def loss_table(found: Sequence[Losses]) -> TextTable:
    """What is lost."""
    rows = [
        [one.killed]
        + [
            f"{number:,}"
            for number in (
                one.times, one.packets, one.lost, one.doubled, one.unaccounted, one.differing,
            )
        ]
        for one in found
    ]  # fmt: skip
    headings = ["killed", "times", "packets", "lost", "doubled", "unaccounted", "rows that differ"]
    return TextTable("What is lost", headings, rows, numbers=True)


def unreadable_table(one: Unreadable) -> TextTable:
    """What becomes of payloads that cannot be read, and of those between them."""
    numbers = (one.packets, one.kept, one.garbage, one.aside, one.unaccounted)
    headings = ["packets", "kept", "unreadable", "kept aside", "unaccounted"]
    return TextTable("What cannot be read", headings, [[f"{n:,}" for n in numbers]], numbers=True)


def page_parts(found: Sequence[PageCost]) -> list[TextTable | str]:
    """What a page costs, and why a column is empty."""
    rows = [
        [
            str(one.sensors),
            f"{one.weight / 1e3:.0f}",
            f"{1e3 * one.latest:.1f}",
            f"{one.told:.2f}",
            "-" if one.drawn is None else f"{one.drawn:.2f}",
            str(one.viewers),
            f"{1e3 * one.alone:.0f}",
            f"{1e3 * one.together:.0f}",
            f"{one.slowest:.2f}",
        ]
        for one in found
    ]
    headings = ["sensors", "page [kB]", "latest [ms]", "told in [s]", "drawn in [s]", "viewers"]
    headings += ["row with 1 [ms of a core]", "with all [ms of a core]", "all see it in [s]"]
    lacking = sorted({one.lacking for one in found if one.lacking})
    said = [f"No row was looked at in a browser: {reason}." for reason in lacking]
    return [TextTable("What is seen", headings, rows, numbers=True), *said]
