"""What a diagnosis by modes and gauges together takes."""

import tempfile
import time
from pathlib import Path

from rga.diagnosis import diagnose
from rga.diagnosis.modal.candidates import modal_hypotheses
from rga.diagnosis.modal.readings import ModalReadings
from rga.diagnosis.modal.trials import ModalTrials
from rga.diagnosis.search.hypothesis import hypotheses
from rga.model import load_model
from rga.records.modal.read import load_modal_record
from rga_bench.measurement import Measurement
from rga_bench.modes.setting import ModesSetting
from rga_bench.swinging.campaign import Campaign
from rga_bench.swinging.case import draw_modal

KIND = "member_stiffness"
#: that it should take at most [s]
ASKED = 15.0


def diagnosis(setting: ModesSetting) -> list[Measurement]:
    """Windows of modes beside a record in which a member is soft: time of the processor."""
    case = draw_modal(
        setting.seed, structure=setting.structure, kind=KIND, welded=False,
        campaign=Campaign(windows=setting.windows), beside=True, rows=setting.rows,
    )  # fmt: skip
    with tempfile.TemporaryDirectory() as folder:
        case.write(folder)
        model, modes = Path(folder) / "model.json", Path(folder) / "modes.csv"
        size = _size(model, modes, setting)
        begun = time.process_time()
        diagnose(model, Path(folder) / "record.csv", modal=modes, seed=setting.seed)
        taken = time.process_time() - begun
    return [Measurement(size, "diagnosis", taken, "s").beside("asked for", ASKED, 1.0)]


def _size(model_file: Path, modes: Path, setting: ModesSetting) -> str:
    model = load_model(model_file)
    record = load_modal_record(modes, model)
    trials = ModalTrials(model, ModalReadings.of(model, record))
    tried = [
        *hypotheses(model, [*model.sensors], [*model.context]),
        *modal_hypotheses(trials),
    ]
    kinds = {(one.name, repr(one.place), *one.priors) for one in tried}
    return (
        f"{setting.windows} windows of {len(model.modes)} modes at {len(model.points)} points, "
        f"{setting.rows} rows of {len(model.sensors)} channels, {len(kinds)} hypotheses"
    )
