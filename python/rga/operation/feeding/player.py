"""Plays a record: each packet at its time, with the faults that were drawn."""

import time
from collections import Counter
from collections.abc import Callable
from dataclasses import replace

import numpy as np

from rga.operation.feeding.faults import Faults, garbage, script
from rga.operation.feeding.senders import Sender
from rga.operation.feeding.sent_record import SentRecord
from rga.operation.packets.native import write_packet
from rga.operation.packets.packet import MICROSECONDS


def play(
    record: SentRecord,
    sender: Sender,
    rows: int,
    speed: float,
    faults: Faults,
    told: Callable[[float], None] = lambda share: None,
) -> Counter[str]:
    """Send a record as a logger would.

    Args:
        record: that is sent.
        sender: takes its packets.
        rows: of a packet.
        speed: times as fast as it was measured; infinity: as fast as it goes.
        faults: that are drawn.
        told: called with the share that is sent.

    Returns:
        How many payloads of each kind were sent.
    """
    offset = round(faults.clock_offset * MICROSECONDS)
    edges = record.edges(rows)
    ends = (record.times[np.array(edges[1:]) - 1] - record.times[0]) / MICROSECONDS
    sendings = script(ends.tolist(), faults)
    sent: Counter[str] = Counter()
    since = time.monotonic()
    for k, one in enumerate(sendings):
        rest = one.due / speed - (time.monotonic() - since)
        if rest > 0:
            time.sleep(rest)
        if one.kind == "garbage":
            sender.send(garbage(one.packet, faults.seed), None)
        else:
            packet = record.packet(one.packet, *edges[one.packet : one.packet + 2])
            packet = replace(packet, times=packet.times + offset)
            sender.send(write_packet(packet), packet.number)
        sent[one.kind] += 1
        told((k + 1) / len(sendings))
    sender.finish()
    return sent
