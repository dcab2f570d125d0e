"""What a change would do, from where a twin stands."""

from dataclasses import dataclass, field
from threading import Semaphore
from typing import Annotated, Any

import numpy as np
from fastapi import APIRouter, Depends, HTTPException
from pydantic import BaseModel, ConfigDict, Field

from rga.dashboard.access.may import may
from rga.dashboard.api.known_query import KnownQueryRoute
from rga.dashboard.api.readings import begun_twin
from rga.dashboard.api.served import OF_A_TWIN, PREFIX, TheTwin, answering
from rga.simulation.whatif import WhatIf, effect_of

#: answers that are worked out at once; who asks beyond that asks again
MOST = 2
_ROOM = Semaphore(MOST)
router = APIRouter(prefix=PREFIX, tags=["what if"], route_class=KnownQueryRoute)


class WhatIfQuestion(BaseModel):
    """A change.

    Attributes:
        settings: contexts after it, and `time` [s] where it matters.
        add: effects that the structure has besides, as in a model file.
    """

    model_config = ConfigDict(extra="forbid")

    settings: dict[str, Annotated[float, Field(strict=True)]] = Field(
        default_factory=dict, max_length=200
    )
    add: dict[str, dict[str, Any]] = Field(default_factory=dict, max_length=20)


@dataclass(frozen=True)
class ChangeOfSensor:
    """What a sensor reads before and after a change, in its unit; 90 % intervals where known."""

    unit: str
    before: float | None
    after: float | None
    after_ci90: tuple[float, float] | None
    change_ci90: tuple[float, float] | None


@dataclass(frozen=True)
class WhatIfAnswer:
    """What a change does: contexts on both sides, every sensor, and what is to be minded."""

    contexts_before: dict[str, float]
    contexts: dict[str, float]
    sensors: dict[str, ChangeOfSensor]
    warnings: list[str] = field(default_factory=list)


@router.post(
    "/twins/{twin}/whatif",
    responses=OF_A_TWIN | answering(413, 429),
    dependencies=[Depends(may("viewer"))],
)
def whatif(seen: TheTwin, question: WhatIfQuestion) -> WhatIfAnswer:
    """What contexts, or effects, do to every sensor."""
    twin = begun_twin(seen)
    add = {name: effect_of(content, name, "add") for name, content in question.add.items()}
    if not _ROOM.acquire(blocking=False):
        raise HTTPException(429, "others are being answered: ask again", {"Retry-After": "2"})
    try:
        # What lies far beyond all ranges ends in numbers that are none, which is said.
        with np.errstate(all="ignore"):
            return _answer(twin.whatif(question.settings, add))
    finally:
        _ROOM.release()


def _answer(found: WhatIf) -> WhatIfAnswer:
    sensors = {}
    for k, (name, unit) in enumerate(zip(found.sensors, found.units, strict=True)):
        after, change = (
            None if table is None else _interval(*table[k].tolist())
            for table in (found.after_ci90, found.change_ci90)
        )
        sensors[name] = ChangeOfSensor(
            unit, _number(found.before[k]), _number(found.after[k]), after, change
        )
    return WhatIfAnswer(found.contexts_before, found.contexts, sensors, found.warnings)


def _number(value: float) -> float | None:
    return float(value) if np.isfinite(value) else None


def _interval(low: float, high: float) -> tuple[float, float] | None:
    return (low, high) if np.isfinite([low, high]).all() else None
