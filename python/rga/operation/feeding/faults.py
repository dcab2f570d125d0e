"""What goes wrong between a logger and a service, drawn from a seed."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BaseModel, ConfigDict, Field

from rga.operation.settings_types import Duration
from rga.settings_files import read_table, validated

Share = Annotated[float, Field(ge=0, le=1, allow_inf_nan=False)]
Kind = Literal["packet", "duplicate", "late", "garbage"]


class Faults(BaseModel):
    """Shares of the packets to which something happens.

    Attributes:
        seed: of the draws.
        duplicate: are sent again.
        out_of_order: come up to `out_of_order_by` behind their time [s].
        late: come `late_by` behind their time [s].
        garbage: as many payloads that are none are sent between them.
        clock_offset: by which the logger's clock is ahead [s].
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    seed: Annotated[int, Field(ge=0, lt=2**63, strict=True)] = 0
    duplicate: Share = 0.0
    out_of_order: Share = 0.0
    out_of_order_by: Duration = Field("60 s", validate_default=True)
    late: Share = 0.0
    late_by: Duration = Field("1 h", validate_default=True)
    garbage: Share = 0.0
    clock_offset: Annotated[float, Field(ge=-1e9, le=1e9)] = 0.0


def read_faults(path: Path) -> Faults:
    """Faults from a file (TOML or JSON).

    Raises:
        InputError: it cannot be read, or a key is unknown or wrong.
    """
    return validated(Faults, read_table(path, "faults"), str(path), "faults")


@dataclass(frozen=True)
class Sending:
    """One payload on its way.

    Attributes:
        due: when it is sent, on the clock of the record [s].
        kind: what it is.
        packet: number of the packet that it is, or that it is sent beside.
    """

    due: float
    kind: Kind
    packet: int


def script(times: Sequence[float], faults: Faults) -> list[Sending]:
    """When each packet is sent, and what is sent beside it.

    Args:
        times: of the end of each packet, on the clock of the record [s], rising.
        faults: that are drawn.

    >>> [one.kind for one in script([0.0, 1.0], Faults(duplicate=1.0))].count("duplicate")
    2
    """
    draw = np.random.default_rng(faults.seed)
    sendings = []
    for packet, time in enumerate(times):
        late, behind = draw.random() < faults.late, 0.0
        if late:
            behind = faults.late_by
        elif draw.random() < faults.out_of_order:
            behind = float(draw.uniform(0.0, faults.out_of_order_by))
        sendings.append(Sending(time + behind, "late" if late else "packet", packet))
        if draw.random() < faults.duplicate:
            again = float(draw.uniform(0.0, faults.out_of_order_by))
            sendings.append(Sending(time + behind + again, "duplicate", packet))
        if draw.random() < faults.garbage:
            sendings.append(Sending(time, "garbage", packet))
    return sorted(sendings, key=lambda one: one.due)


def garbage(packet: int, seed: int) -> bytes:
    """Bytes that are no packet, the same for the same packet and seed."""
    draw = np.random.default_rng((seed, packet))
    return b"\xc1" + draw.bytes(int(draw.integers(0, 200)))
