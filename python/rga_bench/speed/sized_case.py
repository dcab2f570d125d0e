"""Cases of any size: the bridge of the case study with more panels, and gauges all over it."""

import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import numpy as np
import polars

from rga.model import Model, read_effect, read_model
from rga.records import Record, load_record
from rga.simulation import Simulator
from rga_bench.synthetic.bridges.case_study import SIDES, actions, contexts, drafted, low, steelwork

Hidden = Literal["nothing", "section loss", "bearing", "gain", "broken channel"]
#: deviation of every member from its drawing, of a displacement [mm] and of a strain [microstrain]
SCATTER, MILLIMETRES, MICROSTRAIN = 0.01, 0.15, 1.5
#: rows that are drawn at a time
PART = 250_000
#: what may be hidden; a broken channel shows one value from the middle of the record on
EFFECTS: dict[Hidden, dict[str, Any]] = {
    "section loss": {"kind": "member_stiffness", "member": "north.L4-L5", "factor": 0.6},
    "bearing": {"kind": "support_spring", "support": "east north", "dof": "ux", "stiffness": 3e7},
    "gain": {"kind": "sensor_gain", "sensor": "north z4", "factor": 0.8},
}


@dataclass(frozen=True)
class SizedCase:
    """A record of a bridge, all contexts measured.

    Attributes:
        rows, sensors, panels: how many there are; a panel has eleven members.
        hidden: what the model does not have.
        seed: of scatter, contexts and noise.
        spans: of the bridge, of as many panels each.
    """

    rows: int
    sensors: int
    panels: int
    hidden: Hidden
    seed: int
    spans: int = 1

    def model(self) -> Model:
        """The model as given, with as many sensors."""
        draft = drafted(f"footbridge of {self.panels} panels")
        steelwork(draft, self.panels, self.spans)
        contexts(draft, self.spans)
        actions(draft, self.panels, self.spans)
        moved = [f"{side} z{i}" for side in SIDES for i in range(1, self.panels)]
        for name in moved[: self.sensors // 3]:
            side, number = name.split(" z")
            draft.moves(name, low(side, int(number)), [0, 0, 1], MILLIMETRES)
        members = list(draft.model["members"])
        gauges = self.sensors - len(draft.model["sensors"])
        for place in np.linspace(0, len(members) - 1, gauges).astype(int):
            draft.strains(f"gauge {members[place]}", members[place], MICROSTRAIN)
        return read_model(draft.model, draft.model["name"])

    def draw(self) -> tuple[Model, Record]:
        """The model, and the record of a bridge that is not quite as drawn."""
        model = self.model()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "record.csv"
            polars.concat(self.tables(model)).write_csv(path)
            return model, load_record(path, model)

    def tables(self, model: Model) -> Iterator[polars.DataFrame]:
        """The columns of the record, so many rows at a time as fit into memory.

        Args:
            model: as `model` gives it.
        """
        rng = np.random.default_rng(self.seed)
        factors = np.exp(SCATTER * rng.normal(size=len(model.members)))
        built: dict[str, dict[str, Any]] = {
            f"as built {name}": {
                "kind": "member_stiffness",
                "member": name,
                "factor": float(factor),
            }
            for name, factor in zip(model.members, factors, strict=True)
        }
        if self.hidden in EFFECTS:
            built["hidden"] = EFFECTS[self.hidden]
        true = model.extended({name: read_effect(one, name) for name, one in built.items()})
        simulator, stuck = Simulator(true), None
        noise = [sensor.noise or 0.0 for sensor in model.sensors.values()]
        for first in range(0, self.rows, PART):
            rows = min(PART, self.rows - first)
            drawn = {name: rng.uniform(*one.range, rows) for name, one in model.context.items()}
            shown = simulator.predict(drawn)
            shown += noise * rng.normal(size=shown.shape)
            begins = max(0, self.rows // 2 - first)
            if self.hidden == "broken channel" and begins < rows:
                stuck = shown[begins, 1] if stuck is None else stuck
                shown[begins:, 1] = stuck
            columns = {**drawn, **dict(zip(model.sensors, shown.T, strict=True))}
            time = 3600.0 * np.arange(first, first + rows)
            yield polars.DataFrame({"time": time, **columns})
