"""Axles that the lever rule carries where members could, and axles that never reach their path."""

from collections.abc import Iterator
from itertools import pairwise

import numpy as np

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.model.effects.loads.axle_load import AxleLoad
from rga.model.schema import Model


def axles(over: OverRanges) -> Iterator[Finding]:
    """Axles between nodes that frame members join; axles beside their path in every row."""
    model = over.model
    frames = {frozenset(one.nodes) for one in model.members.values() if one.kind == "frame"}
    for name, effect in model.effects.items():
        if not isinstance(effect, AxleLoad):
            continue
        where = parts("effect", [name])
        joined = [pair for pair in pairwise(effect.path) if frozenset(pair) in frames]
        if effect.carried_by == "nodes" and joined:
            yield Finding(
                "note",
                where,
                f"frame members join {len(joined)} of {len(effect.path) - 1} pairs of nodes of its "
                "path, and axles between these are shared by the nodes: they bend no member",
                'give "carried_by": "members" where axles stand on these members',
            )
        length = _length(model, effect.path)
        stands = over.simulator.resolve(over.contexts)[name]["position"]
        behind = max(map(abs, effect.offsets), default=0.0)
        if stands.max() + behind < 0 or stands.min() - behind > length:
            yield Finding(
                "warning",
                where,
                f"its first axle stands at {stands.min():g} to {stands.max():g} m over the ranges, "
                f"and the path reaches from 0 to {length:.4g} m: no axle is ever on it",
                "check the range and the unit [m] of what drives its position",
            )


def _length(model: Model, path: list[str]) -> float:
    points = np.array([model.nodes[node] for node in path])
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
