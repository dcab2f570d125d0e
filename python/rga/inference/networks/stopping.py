"""When a training has gone on for long enough."""

import math
from collections.abc import Callable

from rga.inference.networks.context_network import ContextNetwork

#: looks in a row that may bring nothing better
PATIENCE = 6


class Stopping:
    """Keeps the network that does best on rows that it does not learn from (Prechelt, 1998).

    Args:
        held_out: how wrong a network is on them; the least is the best.
    """

    def __init__(self, held_out: Callable[[ContextNetwork], float]) -> None:
        self._held_out = held_out
        self._least, self._kept, self._vain = math.inf, b"", 0

    def enough(self, network: ContextNetwork) -> bool:
        """Look at the network; whether the last looks brought nothing better."""
        found = self._held_out(network)
        self._vain += 1
        if found < self._least:
            self._least, self._kept, self._vain = found, network.to_bytes(), 0
        return self._vain > PATIENCE

    def best(self, last: ContextNetwork) -> ContextNetwork:
        """The best network that was looked at, the last one too; this one, if none is judged."""
        self.enough(last)
        if not self._kept:
            return last
        return ContextNetwork.from_bytes(self._kept)
