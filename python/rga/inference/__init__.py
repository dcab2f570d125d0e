"""Context inference: from sensor readings to the contexts that nothing measured."""

from typing import TYPE_CHECKING

from rga.lazy import listing, opening

if TYPE_CHECKING:
    from rga.inference.joint.infer import Joint, infer_jointly
    from rga.inference.joint.measured_contexts import MeasuredContexts
    from rga.inference.joint.structural_parameters import Unknowns
    from rga.inference.map.posterior_mode import Mode, posterior_mode
    from rga.inference.networks.context_network import ContextNetwork
    from rga.inference.networks.dataset import Samples
    from rga.inference.networks.settings import TrainingSettings
    from rga.inference.networks.training import train
    from rga.inference.rows import Rows
    from rga.inference.variables import Variables

__all__ = [
    "ContextNetwork",
    "Joint",
    "MeasuredContexts",
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

# They are opened on first use, so that a part is used without the others.
_HOMES = {
    "ContextNetwork": "rga.inference.networks.context_network",
    "Joint": "rga.inference.joint.infer",
    "MeasuredContexts": "rga.inference.joint.measured_contexts",
    "Mode": "rga.inference.map.posterior_mode",
    "Rows": "rga.inference.rows",
    "Samples": "rga.inference.networks.dataset",
    "TrainingSettings": "rga.inference.networks.settings",
    "Unknowns": "rga.inference.joint.structural_parameters",
    "Variables": "rga.inference.variables",
    "infer_jointly": "rga.inference.joint.infer",
    "posterior_mode": "rga.inference.map.posterior_mode",
    "train": "rga.inference.networks.training",
}
__getattr__ = opening(__name__, _HOMES)
__dir__ = listing(__name__, __all__)
