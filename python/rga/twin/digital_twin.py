"""The digital twin: its information model, its simulation model, and the state they are in."""

from dataclasses import dataclass

import numpy as np

from rga.errors import InputError
from rga.inference.networks.design_samples import design
from rga.model import Model
from rga.simulation import Simulator
from rga.twin.calibration.correction import Correction
from rga.twin.hardware.interface import Station
from rga.twin.messages.queries import Q1, Q3, Q5, R1, R3, R5, Response
from rga.twin.simulation_model import SimulationModel, mounted
from rga.twin.state import TwinState, follow
from rga.twin.versions import Effects, extended

#: contexts at which the sensors are asked what they see
TRIAL_CONTEXTS = 64


class DigitalTwin:
    """The one proxy of the structure: others read it, query it, and change it by responses alone.

    Args:
        model: as it was given; versions add effects to it.
        station: what is mounted on the structure.
    """

    def __init__(self, model: Model, station: Station) -> None:
        self.given = model
        self.station = station
        self.state = TwinState()
        self._simulations: dict[int, SimulationModel] = {}

    def accept(self, response: Response) -> None:
        """Take a response over."""
        if isinstance(response, R1) and response.correction != self.correction(response.version):
            self._simulations.pop(response.version, None)
        self.state = follow(self.state, response, self.station.channels)

    def answer(self, query: Q1 | Q3 | Q5) -> R1 | R3 | R5:
        """The response to a query; the twin itself stays as it is."""
        if isinstance(query, Q1):
            return self._adequacy(query)
        simulation = self.simulation(query.version)
        return simulation.draw(query) if isinstance(query, Q3) else simulation.follow(query)

    @property
    def effects(self) -> Effects:
        """What the version in force has beyond the model as given."""
        return self.state.versions[self.state.version]

    def model(self, version: int | None = None) -> Model:
        """The model of a version, of the one in force by default, without its correction."""
        return extended(self.given, self.state.versions[version or self.state.version])

    def correction(self, version: int | None = None) -> Correction | None:
        """What was found of structure and sensors under a version, the one in force by default."""
        return self.state.corrections.get(version or self.state.version)

    def simulation(self, version: int | None = None) -> "SimulationModel":
        """The simulation model of a version, of the one in force by default."""
        number = version or self.state.version
        if number not in self._simulations:
            self._simulations[number] = SimulationModel(
                self.model(number), self.station, self.correction(number)
            )
        return self._simulations[number]

    def _adequacy(self, query: Q1) -> R1:
        state = self.state
        number, effects = max(1, state.version), state.versions.get(state.version, {})
        correction = query.correction or state.corrections.get(number)
        if query.restore is not None:
            number, effects = query.restore, state.versions.get(query.restore, {})
            correction = state.corrections.get(number)
        elif query.effects is not None:
            number, effects, correction = max(state.versions) + 1, query.effects, None
        latent: tuple[str, ...] = ()
        blind: tuple[str, ...] = ()
        missing: list[str] = []
        if query.restore is not None and query.restore not in state.versions:
            missing.append(f"there is no version {query.restore}")
        try:
            model = extended(self.given, effects)
            latent, blind, lacks = InformationModel(model, self.station).check(query)
            missing += lacks
        except InputError as error:
            missing.append(str(error))
        return R1(
            row=query.row,
            version=number,
            effects=effects,
            correction=correction,
            adequate=not missing,
            missing=tuple(missing),
            latent=latent,
            blind=blind,
        )


@dataclass(frozen=True)
class InformationModel:
    """What the twin knows of the structure, its sensors and its contexts."""

    model: Model
    station: Station

    def check(self, query: Q1) -> tuple[tuple[str, ...], tuple[str, ...], list[str]]:
        """Latent contexts that can be inferred, those that no channel sees, and what is missing.

        Raises:
            InputError: the model cannot be simulated.
        """
        missing = [
            f"a sensor {name!r}" for name in query.channels if name not in self.model.sensors
        ]
        missing += [
            f"a context variable {name!r}"
            for name in query.measured
            if name not in self.model.context
        ]
        if not query.channels:
            missing.append("a sensor that the record holds")
        if missing:
            return (), (), missing
        model = mounted(self.model, query.channels)
        latent = [
            name
            for name in model.context
            if name in Simulator(model).needed and name not in query.measured
        ]
        seen = self._seen(model, latent)
        if latent and not any(seen[name] for name in latent):
            missing.append(f"a sensor that sees {' or '.join(latent)}")
        return (
            tuple(name for name in latent if seen[name]),
            tuple(name for name in latent if not seen[name]),
            missing,
        )

    def _seen(self, model: Model, latent: list[str]) -> dict[str, bool]:
        """Whether the whole range of a context moves some channel by more than its noise."""
        if not latent:
            return {}
        origin = self.station.origin
        trial = design(model, TRIAL_CONTEXTS, latent=latent, seed=0, time=origin)
        table = dict(zip(model.context, trial.contexts.T, strict=True))
        slopes = Simulator(model).jacobian({**table, "time": origin})
        width = np.array([high - low for low, high in (v.range for v in model.context.values())])
        reach = np.nan_to_num(np.abs(slopes)).max(axis=0) * width
        noise = np.array([sensor.noise or 0.0 for sensor in model.sensors.values()])
        visible = (reach > np.maximum(noise[:, None], 1e-9)).any(axis=0)
        found = dict(zip(model.context, visible.tolist(), strict=True))
        return {name: found[name] for name in latent}
