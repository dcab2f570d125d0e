"""Reality Gap Analysis of digital twins of truss and frame structures."""

from importlib.metadata import version
from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga.building import ModelBuilder
    from rga.checking import check
    from rga.diagnosis import diagnose, diagnose_modes
    from rga.drawing import draw, plot_model, plot_results
    from rga.drawing.charts import plot_findings, plot_record
    from rga.errors import InputError
    from rga.findings import Findings
    from rga.findings.criteria import Criteria, load_criteria
    from rga.findings.load import load_findings
    from rga.importing import ImportedModel, import_model
    from rga.jobs.batch import diagnose_many
    from rga.jobs.live import LiveTwin, live
    from rga.jobs.run import run
    from rga.jobs.run_modes import run_modes
    from rga.jobs.worker import Worker
    from rga.model import Effect, Model, load_model
    from rga.outputs import write_findings
    from rga.planning.planner import plan
    from rga.planning.result import Plan
    from rga.records import Record, RecordMapping, load_record
    from rga.records.modal.results import modal_record
    from rga.simulation import Modes, Results, Simulator, modes, results
    from rga.twin import Twin

__version__ = version("rga")

# They are opened on first use, so that the command line starts without the heavy parts.
_HOMES = {
    "Criteria": "rga.findings.criteria",
    "Effect": "rga.model",
    "Findings": "rga.findings",
    "InputError": "rga.errors",
    "LiveTwin": "rga.jobs.live",
    "ImportedModel": "rga.importing",
    "Model": "rga.model",
    "ModelBuilder": "rga.building",
    "Modes": "rga.simulation",
    "Plan": "rga.planning.result",
    "Record": "rga.records",
    "RecordMapping": "rga.records",
    "Results": "rga.simulation",
    "Simulator": "rga.simulation",
    "Twin": "rga.twin",
    "Worker": "rga.jobs.worker",
    "check": "rga.checking",
    "diagnose": "rga.diagnosis",
    "diagnose_many": "rga.jobs.batch",
    "diagnose_modes": "rga.diagnosis",
    "draw": "rga.drawing",
    "import_model": "rga.importing",
    "live": "rga.jobs.live",
    "load_criteria": "rga.findings.criteria",
    "load_findings": "rga.findings",
    "load_model": "rga.model",
    "load_record": "rga.records",
    "modal_record": "rga.records.modal.results",
    "modes": "rga.simulation",
    "plan": "rga.planning.planner",
    "plot_findings": "rga.drawing.charts",
    "plot_model": "rga.drawing",
    "plot_results": "rga.drawing",
    "plot_record": "rga.drawing.charts",
    "results": "rga.simulation",
    "run": "rga.jobs.run",
    "run_modes": "rga.jobs.run_modes",
    "write_findings": "rga.outputs",
}

__all__ = [
    "Criteria",
    "Effect",
    "Findings",
    "ImportedModel",
    "InputError",
    "LiveTwin",
    "Model",
    "ModelBuilder",
    "Modes",
    "Plan",
    "Record",
    "RecordMapping",
    "Results",
    "Simulator",
    "Twin",
    "Worker",
    "__version__",
    "check",
    "diagnose",
    "diagnose_many",
    "diagnose_modes",
    "draw",
    "import_model",
    "live",
    "load_criteria",
    "load_findings",
    "load_model",
    "load_record",
    "modal_record",
    "modes",
    "plan",
    "plot_findings",
    "plot_model",
    "plot_record",
    "plot_results",
    "results",
    "run",
    "run_modes",
    "write_findings",
]


__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
