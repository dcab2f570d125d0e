"""A criterion: a figure with its unit, what it decides, and why it is what it is."""

from typing import Annotated, Any

from pydantic import BaseModel, ConfigDict, Field

Positive = Annotated[float, Field(gt=0, strict=True, allow_inf_nan=False)]
Share = Annotated[float, Field(gt=0, le=1, strict=True)]
Multiple = Annotated[float, Field(ge=1, strict=True, allow_inf_nan=False)]
Count = Annotated[int, Field(ge=1, le=1_000_000, strict=True)]


class CriteriaGroup(BaseModel):
    """Criteria of one question; a group is given with those of its figures that differ."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def criterion(value: float, unit: str, decides: str, reason: str) -> Any:
    """A field of a group.

    Args:
        value: by default.
        unit: of it; "-": none.
        decides: what it decides, in words.
        reason: the source of the value, the experiment behind it, or why it was chosen.
    """
    said = {"unit": unit, "reason": reason}
    return Field(default=value, description=decides, json_schema_extra={**said})
