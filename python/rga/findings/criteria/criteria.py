"""All criteria of a diagnosis, group by group."""

from pydantic import Field

from rga.findings.criteria.causes import (
    AdviceCriteria,
    ExplanationCriteria,
    NamingCriteria,
    RivalCriteria,
)
from rga.findings.criteria.channels import ChannelCriteria
from rga.findings.criteria.criterion import CriteriaGroup
from rga.findings.criteria.records import RecordCriteria, ZeroCriteria
from rga.findings.criteria.residuals import FitCriteria, StructureCriteria


class Criteria(CriteriaGroup):
    """What decides a verdict: the figures that findings go by.

    Every figure states its unit, what it decides and why it is what it is; `rga schema criteria`
    prints them. Numbers that only make a computation fast or exact are not among them.

    >>> Criteria.model_validate({"naming": {"log_odds": 9.2}}).naming.log_odds
    9.2
    """

    record: RecordCriteria = Field(RecordCriteria(), description="which rows are analysed")
    zeros: ZeroCriteria = Field(ZeroCriteria(), description="zeros that nobody declared")
    channels: ChannelCriteria = Field(ChannelCriteria(), description="channels that do not work")
    naming: NamingCriteria = Field(NamingCriteria(), description="when a cause is named")
    rivals: RivalCriteria = Field(
        RivalCriteria(), description="what a cause cannot be distinguished from"
    )
    fit: FitCriteria = Field(FitCriteria(), description="when a model does not fit the record")
    structure: StructureCriteria = Field(
        StructureCriteria(), description="patterns and curves that no cause explains"
    )
    explanations: ExplanationCriteria = Field(
        ExplanationCriteria(), description="remarks on explanations; what cannot be seen"
    )
    advice: AdviceCriteria = Field(
        AdviceCriteria(), description="what to measure next, in plans too"
    )

    def differing(self) -> dict[str, float]:
        """Figures that are not the default ones, by group and name.

        >>> Criteria.model_validate({"rivals": {"listed": 3}}).differing()
        {'rivals.listed': 3}
        """
        usual = Criteria().model_dump()
        return {
            f"{group}.{name}": value
            for group, figures in self.model_dump().items()
            for name, value in figures.items()
            if value != usual[group][name]
        }
