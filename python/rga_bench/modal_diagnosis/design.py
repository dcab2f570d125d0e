"""The design of the challenge with modes: which cases are drawn, by seed, stratum and number.

A draw is a pure function of these three, and stands beside its null twin. Kinds go round in turn,
and so do campaigns; their numbers have no common divisor, so every kind meets every campaign.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple

from rga_bench.diagnosis.blind_draw import BlindDraw
from rga_bench.field import STRUCTURES
from rga_bench.swinging.campaign import Campaign
from rga_bench.swinging.case import ModalCase, draw_modal, fits
from rga_bench.swinging.hidden import OF_GAUGES, OF_MODES

#: hidden draws of a quick challenge; as many null twins stand beside them
QUICK = 4
#: share of the draws in each stratum: modes alone, and modes beside a record of gauges
STRATA = {"modal": 0.6, "mixed": 0.4}


class NamedCampaign(NamedTuple):
    """How modes were measured, and what it is called."""

    name: str
    campaign: Campaign


#: of modes alone; beside a record the first ones
CAMPAIGNS = (
    NamedCampaign("white", Campaign(memory=0.0)),
    NamedCampaign("memory 0.6", Campaign(memory=0.6)),
    NamedCampaign("40 % missing", Campaign(missing=0.4)),
    NamedCampaign("shapes swapped", Campaign(swapped=0.05)),
    NamedCampaign("frost", Campaign(weather=True)),
    NamedCampaign("clock 1 % fast", Campaign(clock=1.01)),
    NamedCampaign("16 windows", Campaign(windows=16)),
)
BESIDE = CAMPAIGNS[:3]


@dataclass(frozen=True)
class ModalDraw(BlindDraw):
    """One case of the challenge.

    >>> ModalDraw.parse("7-mixed-12-null")
    ModalDraw(seed=7, stratum='mixed', number=12, null=True)
    """

    strata = STRATA

    @property
    def measured(self) -> NamedCampaign:
        """How its modes were measured."""
        several = BESIDE if self.stratum == "mixed" else CAMPAIGNS
        return several[self.number % len(several)]

    @property
    def kind(self) -> str:
        """What is hidden in the draw, and not in its twin."""
        several = list(OF_MODES) + (list(OF_GAUGES) if self.stratum == "mixed" else [])
        return several[self.number % len(several)]

    @property
    def structure(self) -> str:
        """The structure that it stands on."""
        several = [name for name in STRUCTURES if fits(self.kind, name)]
        return several[int(self.random("structure").integers(len(several)))]

    def case(self) -> ModalCase:
        """The case itself."""
        rng = self.random("case")
        return draw_modal(
            int(rng.integers(2**31)),
            structure=self.structure,
            kind="null" if self.null else self.kind,
            welded=bool(rng.random() < 0.5),
            campaign=self.measured.campaign,
            beside=self.stratum == "mixed",
        )
