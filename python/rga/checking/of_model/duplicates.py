"""Nodes at one place that are not joined, and members between the same nodes."""

from collections.abc import Iterator

import numpy as np
import scipy

from rga.checking.finding import MOST_NAMED, Finding, named, parts
from rga.checking.over_ranges import OverRanges

#: distance of nodes at one place, as a share of the size of the structure
SAME_PLACE = 1e-6


def duplicates(over: OverRanges) -> Iterator[Finding]:
    """Nodes that stand at one place without a tie or spring; members that stand twice."""
    model = over.model
    names = list(model.nodes)
    points = np.array(list(model.nodes.values()), dtype=float).reshape(-1, 3)
    if len(points):
        size = float(np.ptp(points, axis=0).max())
        near = scipy.spatial.cKDTree(points / (size or 1.0)).query_pairs(SAME_PLACE)
        together = {frozenset(tie.nodes) for tie in model.ties}
        together |= {frozenset((one.node, one.to or "")) for one in model.springs}
        apart = [
            pair
            for pair in sorted(tuple(sorted(pair)) for pair in near)
            if frozenset(names[k] for k in pair) not in together
        ]
        for one, other in apart[:MOST_NAMED]:
            yield Finding(
                "warning",
                parts("node", [names[one], names[other]]),
                "they stand at one place and are not joined: members of one do not meet those of "
                "the other",
                "make one node of them, or join them by a tie or a spring",
            )
        if len(apart) > MOST_NAMED:
            more = f"{len(apart) - MOST_NAMED} more pairs stand at one place"
            yield Finding("warning", "nodes", more, "make one node of each pair")
    between: dict[frozenset[str], list[str]] = {}
    for name, member in model.members.items():
        between.setdefault(frozenset(member.nodes), []).append(name)
    twice = [same for same in between.values() if len(same) > 1]
    for same in twice[:MOST_NAMED]:
        yield Finding(
            "warning",
            parts("member", same),
            f"they join the same nodes {named(model.members[same[0]].nodes)}: their stiffnesses "
            "add up",
            "take one out, unless they are two in the structure",
        )
    if len(twice) > MOST_NAMED:
        more = f"{len(twice) - MOST_NAMED} more pairs of nodes are joined by several members"
        yield Finding("warning", "members", more, "take out those that stand twice")
