"""Cases of any size: the bridge of the case study with more panels, and gauges all over it."""

import tempfile
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
    """

    rows: int
    sensors: int
    panels: int
    hidden: Hidden
    seed: int

    def model(self) -> Model:
        """The model as given, with as many sensors."""
        draft = drafted(f"footbridge of {self.panels} panels")
        steelwork(draft, self.panels)
        contexts(draft)
        actions(draft, self.panels)
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
        model, table = self.table()
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "record.csv"
            table.write_csv(path)
            return model, load_record(path, model)

    def table(self) -> tuple[Model, polars.DataFrame]:
        """The model, and the columns of the record."""
        rng = np.random.default_rng(self.seed)
        model = self.model()
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
        drawn = {name: rng.uniform(*one.range, self.rows) for name, one in model.context.items()}
        shown = Simulator(true).predict(drawn)
        noise = [sensor.noise or 0.0 for sensor in model.sensors.values()]
        shown += noise * rng.normal(size=shown.shape)
        if self.hidden == "broken channel":
            shown[self.rows // 2 :, 1] = shown[self.rows // 2, 1]
        columns = {**drawn, **dict(zip(model.sensors, shown.T, strict=True))}
        return model, polars.DataFrame({"time": 3600.0 * np.arange(self.rows), **columns})
