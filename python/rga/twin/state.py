"""The state of the digital twin, which follows from the responses alone."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace

from rga.twin.calibration.correction import Correction
from rga.twin.messages.queries import R1, R5, Response
from rga.twin.versions import Effects


@dataclass(frozen=True)
class TwinState:
    """What the twin holds; it follows from the responses alone.

    Attributes:
        version: number of the model version in force; 0 before the first response.
        versions: effects of every version beyond the model as given.
        corrections: what the last calibration of each version has found of structure and sensors.
        latent: context variables that are inferred.
        row: row of the record at which the twin stands.
        context, simulated: of that row, by name.
    """

    version: int = 0
    versions: Mapping[int, Effects] = field(default_factory=dict)
    corrections: Mapping[int, Correction | None] = field(default_factory=dict)
    latent: tuple[str, ...] = ()
    row: int | None = None
    context: Mapping[str, float] = field(default_factory=dict)
    simulated: Mapping[str, float] = field(default_factory=dict)


def follow(state: TwinState, response: Response, channels: tuple[str, ...]) -> TwinState:
    """The state after a response. Nothing else changes the twin."""
    if isinstance(response, R1) and response.adequate:
        number = response.version
        return replace(
            state,
            version=number,
            versions={**state.versions, number: response.effects},
            corrections={**state.corrections, number: response.correction},
            latent=response.latent,
        )
    if isinstance(response, R5):
        last = response.simulated[-1].tolist() if len(response.simulated) else []
        simulated = dict(zip(channels, last, strict=bool(last)))
        row = response.first + response.rows - 1
        return replace(state, row=row, context=response.context, simulated=simulated)
    return state
