"""Context inference: from sensor readings to the contexts that nothing measured."""

from rga.inference.joint import Joint, infer_jointly
from rga.inference.network import ContextNetwork
from rga.inference.posterior_mode import Mode, posterior_mode
from rga.inference.rows import Rows
from rga.inference.samples import Samples
from rga.inference.settings import TrainingSettings
from rga.inference.training import train
from rga.inference.unknowns import Unknowns
from rga.inference.variables import Variables

__all__ = [
    "ContextNetwork",
    "Joint",
    "Mode",
    "Rows",
    "Samples",
    "TrainingSettings",
    "Unknowns",
    "Variables",
    "infer_jointly",
    "posterior_mode",
    "train",
]
