"""Contexts in, sensor values out."""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from rga.arrays import FloatArray
from rga.errors import InputError
from rga.lazy import needing_extras
from rga.model import as_model
from rga.model.effect import Effect, Values, seconds
from rga.model.readings import Readings
from rga.model.schema import Model
from rga.model.structure import Structure, build_structure
from rga.simulation.assembly import Assembly
from rga.simulation.contexts import Contexts, contexts_by_name
from rga.simulation.derivatives.forward import jacobian, pull_back
from rga.simulation.dispatch import ResponsePlan, answer
from rga.simulation.memory import Followed, Memory, Trail, hindrance

if TYPE_CHECKING:
    from rga.simulation.derivatives.torch_layer import DifferentiableSimulator


@dataclass(frozen=True)
class Response:
    """The response of a structure, before any sensor reads it.

    Attributes:
        contexts: the contexts, float[rows] each.
        values: parameters of every effect, by name, float[rows] each.
        quantities: what each sensor is to read, float[rows, sensors] in the sensors' units.
        plan: the path that led there.
    """

    contexts: Values
    values: dict[str, Values]
    quantities: FloatArray
    plan: ResponsePlan


class Simulator:
    """The simulation of a model with all of its effects.

    The response is linear in the loads, so one solve for every load pattern serves all rows that
    share a structure: y = Q R with the coefficients Q[rows, patterns] and the responses
    R[patterns, sensors]. Where a few stiffnesses differ they are condensed; other rows whose
    structural parameters differ are solved apart (`ResponsePlan`).

    Args:
        model: the structure with its effects and sensors, or its file.

    Attributes:
        model: itself.
        assembly: the structures that parameters of its effects make.
    """

    def __init__(self, model: Model | str | Path, _structure: Structure | None = None) -> None:
        self.model = as_model(model)
        self._structure = build_structure(self.model) if _structure is None else _structure
        self.assembly = Assembly(self.model, self._structure, self.resolve)

    def extended(self, effects: Mapping[str, Effect]) -> "Simulator":
        """A simulator of the same structure with more effects; what is condensed serves both."""
        if not effects:
            return self
        found = Simulator(self.model.extended(dict(effects)), self._structure)
        found.assembly.prepared = self.assembly.prepared
        return found

    def calm(self, values: dict[str, Values]) -> "Simulator":
        """The same without what gives every row a structure of its own, or corners or memory.

        Args:
            values: of all parameters, as `resolve` gives them.
        """
        kept = {}
        for name, effect in self.model.effects.items():
            if effect.structural:
                structure = self._structure.copy()
                effect.change_structure(structure, {k: c[-1] for k, c in values[name].items()})
                varies = any(np.ptp(column) > 0 for column in values[name].values())
                if varies or not structure.linear:
                    continue
            kept[name] = effect
        if len(kept) == len(self.model.effects):
            return self
        return Simulator(self.model.model_copy(update={"effects": kept}), self._structure)

    @cached_property
    def driven(self) -> dict[str, list[str]]:
        """Context variables that drive effects of the model, with the names of these effects."""
        found: dict[str, list[str]] = {}
        for name, effect in self.model.effects.items():
            for context in sorted(effect.drivers()):
                found.setdefault(context, []).append(name)
        return found

    @property
    def needed(self) -> set[str]:
        """Context variables that drive effects of the model."""
        return set(self.driven)

    def predict(self, contexts: Contexts) -> FloatArray:
        """Simulated sensor values.

        Args:
            contexts: context variables in their units, and `time` [s] where an onset, a lag, a
                drift or friction needs it; every one float[rows], or a number for all rows. A table
                of them (polars, pandas) does as well.

        Returns:
            float[rows, sensors] in the units of the sensors, in the order of the model.

        Raises:
            InputError: a context is missing, not finite, or of another length.
            UnstableStructureError: the structure can move; names node and direction.
        """
        return self._predict(contexts, Trail(self.model.effects))

    def follow(self, contexts: Contexts, memory: Memory | None = None) -> Followed:
        """Simulated sensor values of the next rows of a record, which follow those before.

        Rows that are followed, in packets of any size, read what `predict` has for all of them
        together, but for rounding; the cost of a packet does not grow with the rows before it. Only
        the way that an `axle_load` heads shows from the row before a packet on, not from all rows.

        Args:
            contexts: of these rows, as for `predict`; they do not begin before the last row.
            memory: of the rows before; None: these are the first.

        Returns:
            The readings, and the memory with which the next rows are followed.

        Raises:
            InputError: as `predict`; rows of this model cannot be followed (`hindrance`), or the
                memory is that of other effects.
            UnstableStructureError: as `predict`.
        """
        if self.hindrance:
            raise InputError(self.hindrance, "rows that are followed", "mend it, or use `predict`")
        trail = Trail.behind(self.model, memory)
        return Followed(self._predict(contexts, trail), trail.memory)

    @cached_property
    def hindrance(self) -> str:
        """Why rows of the model cannot be followed without those before; empty where they can."""
        return hindrance(self.model)

    def _predict(self, contexts: Contexts, trail: Trail) -> FloatArray:
        # What overflows is told below, with its row.
        with np.errstate(over="ignore", invalid="ignore", divide="ignore"):
            response = self._respond(contexts, trail)
            shown = self.read(response, trail.effects)
        # A faulty sensor shows NaN of a sound structure.
        lost = np.argwhere(~np.isfinite(response.quantities) | np.isinf(shown))
        if len(lost):
            row, column = lost[0]
            raise InputError(
                f"sensor {list(self.model.sensors)[column]!r} would read no finite number",
                f"contexts, row {row + 1}",
                "check the sizes of contexts and effects",
            )
        return shown

    def respond(self, contexts: Contexts) -> Response:
        """The response of the structure, before any sensor reads it.

        Args:
            contexts: as for `predict`, with the same errors.
        """
        return self._respond(contexts, Trail(self.model.effects))

    def _respond(self, contexts: Contexts, trail: Trail) -> Response:
        table = self._table(contexts)
        values = self.resolve(table, trail.effects)
        request = self.assembly.request(values, len(table["time"]), trail.friction)
        plan, quantities = answer(request)
        return Response(table, values, quantities * self._structure.per_si, plan)

    def parameters(self, contexts: Mapping[str, ArrayLike]) -> dict[str, Values]:
        """Parameters of all effects, by name, float[rows] each.

        Args:
            contexts: as for `predict`, with the same errors.
        """
        return self.resolve(self._table(contexts))

    def plan(self, contexts: Contexts) -> ResponsePlan:
        """The path that `predict` takes for these contexts: the cheapest exact one."""
        return self.respond(contexts).plan

    def read(self, response: Response, more: Mapping[str, Effect] | None = None) -> FloatArray:
        """What the sensors show of a response, float[rows, sensors] in their units.

        Args:
            response: of this model, or of the same model with other effects on its sensors.
            more: effects that the model does not have, or in place of those of the same names.
        """
        return self.zeroed(self.shown(response, more))

    def shown(self, response: Response, more: Mapping[str, Effect] | None = None) -> Readings:
        """What the sensors show, before the logger's zero is taken off (`zeroed`)."""
        time, values = response.contexts["time"], response.values
        rows = len(time)
        readings = Readings(
            values=response.quantities.copy(),
            columns={name: number for number, name in enumerate(self.model.sensors)},
            time=time,
            temperature_change=sum(
                (v["delta"] for v in values.values() if "delta" in v), np.zeros(rows)
            ),
        )
        for name, effect in {**self.model.effects, **(more or {})}.items():
            if effect.overrides("change_readings"):
                own = values[name] if name in values else effect.values(response.contexts, rows)
                effect.change_readings(readings, own)
        return readings

    def load_coefficients(self, contexts: Contexts) -> FloatArray:
        """Coefficients of all load patterns: what any linear structure responds to.

        Args:
            contexts: as for `predict`.

        Returns:
            float[rows, patterns].
        """
        table = self._table(contexts)
        loads = self.assembly.loads(self._structure, self.resolve(table))
        none = np.zeros((len(table["time"]), 0))
        return np.column_stack([none, *(load.coefficient for load in loads)])

    def jacobian(self, contexts: Contexts) -> FloatArray:
        """Derivatives of the sensors by the context variables of the model.

        Args:
            contexts: as for `predict`.

        Returns:
            float[rows, sensors, contexts]; exact where loads and stiffnesses follow the contexts,
            by central differences over 1e-4 of each range elsewhere.
        """
        return jacobian(self, self._table(contexts))

    def pull_back(self, contexts: Contexts, gradients: ArrayLike) -> FloatArray:
        """Derivatives of a function of the sensors by the context variables: the adjoint.

        Args:
            contexts: as for `predict`.
            gradients: derivatives of the function by the sensors, float[rows, sensors].

        Returns:
            float[rows, contexts]: the gradients times the Jacobian, at the cost of a sample.

        Raises:
            InputError: as `predict`; gradients of another shape, or not finite.
        """
        table = self._table(contexts)
        given = _numbers("gradients", gradients)
        shape = (len(table["time"]), len(self.model.sensors))
        if given.shape != shape or not np.isfinite(given).all():
            raise InputError(
                f"the gradients have the shape {list(given.shape)}, or are not all finite",
                "the adjoint of the simulation",
                f"give finite float{list(shape)}",
            )
        return pull_back(self, table, given)

    @property
    def reads_plainly(self) -> bool:
        """Whether sensors show what the structure does and nothing else."""
        effects, sensors = self.model.effects.values(), self.model.sensors.values()
        plain = not any(effect.overrides("change_readings") for effect in effects)
        return plain and all(sensor.zero is None for sensor in sensors)

    def as_torch(self, time: ArrayLike | None = None) -> "DifferentiableSimulator":
        """The simulation as a torch module: contexts in the order of the model in, sensors out.

        Args:
            time: clock of the rows [s], float[rows], where the model needs one.
        """
        # Torch is heavy, and most uses of a simulator do without it.
        with needing_extras():
            from rga.simulation.derivatives.torch_layer import DifferentiableSimulator

        return DifferentiableSimulator(self, None if time is None else np.asarray(time, float))

    def _table(self, contexts: Contexts) -> Values:
        named = contexts_by_name(contexts, self.model.context)
        given = {name: _numbers(name, value) for name, value in named.items()}
        rows = max((len(column) for column in given.values()), default=1)
        if not rows:
            raise InputError("there is no row", "contexts", "give a value or more of each")
        table = {}
        for name in ("time", *self.model.context):
            if name == "time" and name not in given:
                table[name] = np.zeros(rows)
                continue
            if name not in given:
                if name in self.driven:
                    raise InputError(
                        f"the context {name!r} is missing",
                        "contexts",
                        f"give a value a row; on the command line one for all, --contexts {name}=",
                    )
                continue
            column = given[name]
            if column.ndim != 1 or len(column) not in (1, rows):
                raise InputError(
                    f"the context {name!r} has shape {column.shape}",
                    "contexts",
                    f"give {rows} values",
                )
            if not np.isfinite(column).all():
                row = int(np.flatnonzero(~np.isfinite(column))[0])
                raise InputError(
                    f"the context {name!r} is not a number",
                    f"contexts, row {row + 1}",
                    "give a finite value",
                )
            table[name] = np.broadcast_to(column, rows)
        return table

    def resolve(
        self, measured: Values, going_on: Mapping[str, Effect] | None = None
    ) -> dict[str, Values]:
        """Parameters of all effects, row by row, as the true contexts and the effects make them.

        Args:
            measured: contexts and time, float[rows] each.
            going_on: the effects, where they go on from rows before.
        """
        effects, rows = going_on or self.model.effects, len(measured["time"])
        true = dict(measured)
        for effect in effects.values():
            if effect.overrides("change_contexts"):
                effect.change_contexts(true, effect.values(measured, rows))
        values = {name: effect.values(true, rows) for name, effect in effects.items()}
        # What the structure follows is known once lags have acted on it.
        for name, effect in sorted(effects.items(), key=lambda named: named[1].structural):
            if effect.overrides("change_values"):
                effect.change_values(values, values[name], measured["time"])
        return values

    def zeroed(self, readings: Readings) -> FloatArray:
        """Readings less the logger's zero, float[rows, sensors]; in place."""
        for name, place in readings.columns.items():
            sensor = self.model.sensors[name]
            if sensor.zero is not None:
                first, last = (seconds(moment) for moment in sensor.zero)
                column = readings.values[:, place]
                lead_in = (readings.time >= first) & (readings.time <= last)
                if lead_in.any():
                    column -= column[lead_in].mean()
        return readings.values


def _numbers(name: str, value: ArrayLike) -> FloatArray:
    try:
        given = np.atleast_1d(np.asarray(value))
        # Numbers that Python holds as objects do as well; dates, switches and texts are none.
        if given.dtype.kind not in "iufO":
            raise TypeError
        return given.astype(float)
    except (TypeError, ValueError, OverflowError):
        remedy = "give a number, or one a row"
        raise InputError(f"the context {name!r} holds no numbers", "contexts", remedy) from None
