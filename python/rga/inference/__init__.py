"""Context inference: from sensor readings to the contexts that nothing measured."""

from rga.inference.network import ContextNetwork
from rga.inference.samples import Samples
from rga.inference.settings import TrainingSettings
from rga.inference.training import train
from rga.inference.variables import Variables

__all__ = ["ContextNetwork", "Samples", "TrainingSettings", "Variables", "train"]
