"""How much is measured."""

from dataclasses import dataclass


@dataclass(frozen=True)
class ModesSetting:
    """How much is measured, and on what.

    Attributes:
        seconds: that a figure is measured for.
        panels: along a side of the double-layer grid.
        samples: that are gone through in turn, and of which frequencies are compared.
        windows: in which modes were found that are diagnosed, beside rows of a record.
        rows: of it.
        structure: that is diagnosed.
        seed: of structures and samples.
        judged: whether figures are held against their targets.
    """

    seconds: float = 2.0
    panels: int = 64
    samples: int = 256
    windows: int = 500
    rows: int = 300
    structure: str = "roof"
    seed: int = 0
    judged: bool = True


def shorter(seed: int) -> ModesSetting:
    """What takes some seconds: too short to judge by."""
    return ModesSetting(0.05, 12, 16, 20, 60, "portal", seed, judged=False)
