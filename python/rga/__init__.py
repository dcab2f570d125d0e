"""Reality Gap Analysis of digital twins of truss and frame structures."""

from importlib.metadata import version
from typing import TYPE_CHECKING

from rga.lazy import opening

if TYPE_CHECKING:
    from rga.diagnosis import diagnose
    from rga.findings import Findings
    from rga.findings.criteria import Criteria, load_criteria
    from rga.findings.load import load_findings
    from rga.jobs.batch import diagnose_many
    from rga.jobs.run import run
    from rga.model import Effect, Model, load_model
    from rga.outputs import write_findings
    from rga.planning.planner import plan
    from rga.planning.result import Plan
    from rga.records import Record, RecordMapping, load_record
    from rga.simulation import Simulator
    from rga.twin import Twin

__version__ = version("rga")

# They are opened on first use, so that the command line starts without the heavy parts.
_HOMES = {
    "Criteria": "rga.findings.criteria",
    "Effect": "rga.model",
    "Findings": "rga.findings",
    "Model": "rga.model",
    "Plan": "rga.planning.result",
    "Record": "rga.records",
    "RecordMapping": "rga.records",
    "Simulator": "rga.simulation",
    "Twin": "rga.twin",
    "diagnose": "rga.diagnosis",
    "diagnose_many": "rga.jobs.batch",
    "load_criteria": "rga.findings.criteria",
    "load_findings": "rga.findings",
    "load_model": "rga.model",
    "load_record": "rga.records",
    "plan": "rga.planning.planner",
    "run": "rga.jobs.run",
    "write_findings": "rga.outputs",
}

__all__ = [
    "Criteria",
    "Effect",
    "Findings",
    "Model",
    "Plan",
    "Record",
    "RecordMapping",
    "Simulator",
    "Twin",
    "__version__",
    "diagnose",
    "diagnose_many",
    "load_criteria",
    "load_findings",
    "load_model",
    "load_record",
    "plan",
    "run",
    "write_findings",
]


__getattr__ = opening(__name__, _HOMES)
