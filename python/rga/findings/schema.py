"""Findings: what a diagnosis says, as it stands in findings.json."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, PrivateAttr

from rga.findings.arrays import DiagnosisArrays
from rga.findings.criteria import Criteria
from rga.findings.modal_arrays import ModalArrays
from rga.model.schema import Model
from rga.notebook import short_html

if TYPE_CHECKING:
    import polars as pl
    from matplotlib.axes import Axes

Interval = tuple[float, float]
Verdict = Literal["nothing_wrong", "named", "ambiguous", "partial", "unknown", "unidentifiable"]


class FindingsPart(BaseModel):
    model_config = ConfigDict(extra="forbid", allow_inf_nan=False)


class SensorGap(FindingsPart):
    """Gap of one sensor: mean squared residual over noise variance [-]."""

    before: float
    after: float


class HeldOut(FindingsPart):
    """Gap by the readings of blocks of rows that no step of the diagnosis saw.

    Attributes:
        before: of the model as given under the loads of the whole record: the change of the
            simulation is known in every row, what the extended model leaves in those blocks.
        after: of the extended model in those blocks.
        gain: before less after, with its 90 % interval.
    """

    before: float
    after: float
    gain: float
    gain_ci90: Interval


class Gap(FindingsPart):
    """The reality gap before and after the extension."""

    before: float
    after: float
    noise_floor: float = 1.0
    unit: str = "mean squared residual over noise variance"
    held_out: HeldOut
    by_sensor: dict[str, SensorGap]


class Cause(FindingsPart):
    """A cause: the effect that the model lacked.

    Attributes:
        effect: as it stands in the extended model.
        log_odds: against leaving this cause out, the number of places and kinds counted.
        d_prime: size of the effect under the whole covariance [-].
        d_perp: the same after projecting off the nearest rival [-].
        rivals: effects within `rivals.log_odds` of the criteria: the nearest of each other kind,
            the nearest first, then further places of these kinds and of its own.
        rivals_omitted: how many more there are.
        separated_by: in words: the sensor or load test that would separate it from its rivals.
        why: in words: what in the data shows it.
    """

    effect: dict[str, Any]
    onset: float | str | None = None
    onset_ci90: tuple[float | str, float | str] | None = None
    status: Literal["named", "ambiguous"]
    log_odds: float
    d_prime: float
    d_perp: float
    rivals: list[dict[str, Any]] = []
    rivals_omitted: int = Field(default=0, ge=0)
    separated_by: str = ""
    why: str = ""


class Unidentifiable(FindingsPart):
    """A kind and place whose largest physical value stays below the smallest d' of the criteria."""

    kind: str
    place: str
    d_prime_at_largest: float


class Unexplained(FindingsPart):
    """Structure that is left after the extension.

    Attributes:
        share: of the gap.
        looks_like: in words: what is left, or why the data decide too little.
        speaks_against: whether some of it speaks against the model; else the data decide too
            little.
    """

    share: float
    looks_like: str
    speaks_against: bool = True


class Explanation(FindingsPart):
    """An explanation that was tried, alone or with others.

    Attributes:
        words: the effects in words with their values.
        effects: as they would stand in a model.
        log_odds: against no effect at all; the prior counted.
        gap: on the rows that were fitted.
        gap_unseen_channels: on groups of channels left out in turn; None where not tried.
        remark: why it was kept or rejected.
    """

    words: str
    effects: list[dict[str, Any]]
    log_odds: float
    gap: float
    gap_unseen_channels: float | None = None
    remark: str = ""


class GroupGap(FindingsPart):
    """Measured over simulated by group of sensors, as percent off.

    Attributes:
        since: time from which on the rows are compared, where all causes begin late; else None.
    """

    group: str
    sensors: list[str]
    before_percent: float
    after_percent: float
    since: float | str | None = None


class FoundMode(FindingsPart):
    """A mode in the windows of a modal record.

    Attributes:
        frequency: median of the windows [Hz].
        scatter: of one window beside the others, as a share of the frequency.
        memory: correlation of the errors of a window and the next.
        found: share of the windows in which it was found.
        shape: mean of those measured, of length one, by point; empty: known by its frequency alone.
        shape_noise: what 1 - MAC of that mean is by noise.
    """

    frequency: float = Field(gt=0)
    scatter: float = Field(gt=0)
    memory: float = Field(ge=0, lt=1)
    found: float = Field(gt=0, le=1)
    shape: dict[str, float] = {}
    shape_noise: float = Field(default=0.0, ge=0)


class Windows(FindingsPart):
    """Windows of time in which modes were looked for.

    Attributes:
        count: how many.
        contexts: least and largest value of each context in them.
        modes: those that were found, by name.
    """

    count: int = Field(gt=0)
    contexts: dict[str, Interval] = {}
    modes: dict[str, FoundMode]


class Findings(FindingsPart):
    """What a diagnosis found: the verdict, the causes, the gain, and what stays unexplained.

    Attributes:
        misfits: sensors that work and do not fit the extended model as their like do.
        criteria: what decided the verdict; of findings that state none the default ones.
        record_sha256: hash of the file of the record, or of modes that were looked at alone.
        modal_sha256: hash of the file of modes that were looked at beside a record.
        windows: in which modes were measured, and how well; None without modes.
    """

    rga_findings: Literal[1] = 1
    verdict: Verdict
    gap: Gap
    causes: list[Cause] = []
    unidentifiable: list[Unidentifiable] = []
    unexplained: Unexplained
    explanations: list[Explanation] = []
    groups: list[GroupGap] = []
    contexts: dict[str, dict[str, Any]] = {}
    warnings: list[str] = []
    misfits: list[str] = []
    criteria: Criteria = Criteria()
    seed: int
    model_sha256: str
    record_sha256: str
    modal_sha256: str | None = None
    windows: Windows | None = None
    versions: dict[str, str] = Field(default_factory=dict)

    _account: DiagnosisArrays | None = PrivateAttr(default=None)
    _modes: ModalArrays | None = PrivateAttr(default=None)

    @property
    def account(self) -> DiagnosisArrays:
        """The arrays behind the findings, for the report."""
        if self._account is None:
            raise ValueError("these findings were read from a file: the arrays are not kept there")
        return self._account

    @property
    def has_record(self) -> bool:
        """Whether the arrays of a record are behind the findings."""
        return self._account is not None

    @property
    def modes(self) -> ModalArrays | None:
        """The modes behind the findings, for the report; None where none were looked at."""
        return self._modes

    @property
    def extended(self) -> Model:
        """The model with the causes that were found."""
        return self._modes.extended if self._modes is not None else self.account.extended

    def sentence(self) -> str:
        """The verdict in plain words."""
        from rga.findings.phrases import verdict_sentence

        return verdict_sentence(self)

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """The gap by sensor before and after the extension, in axes of matplotlib.

        Args:
            ax: axes; None: those of a new figure.
        """
        # What draws stands above the findings: it is reached through the front of the package.
        import rga

        return rga.plot_findings(self, ax)

    def to_frame(self) -> "pl.DataFrame":
        """The causes, one a row: effect, place, what is known of its size, log-odds, d' [-]."""
        import polars as pl

        from rga.findings.phrases import effect_words

        rows = [
            {
                "kind": str(one.effect.get("kind")),
                "effect": effect_words(one.effect),
                "status": one.status,
                "onset": None if one.onset is None else str(one.onset),
                "log_odds": one.log_odds,
                "d_prime": one.d_prime,
                "d_perp": one.d_perp,
                "rivals": len(one.rivals),
            }
            for one in self.causes
        ]
        words = dict.fromkeys(("kind", "effect", "status", "onset"), pl.String)
        numbers = dict.fromkeys(("log_odds", "d_prime", "d_perp"), pl.Float64)
        return pl.DataFrame(rows, schema={**words, **numbers, "rivals": pl.Int64})

    def _repr_html_(self) -> str:
        return short_html(self.verdict.replace("_", " "), self.sentence(), self.to_frame())

    def write(
        self, directory: str | Path, report: Callable[["Findings", Path], Path] | None = None
    ) -> Path:
        """Write findings.json and model.json to a directory, then report.html.

        Every file is written under a temporary name first and then renamed.

        Args:
            directory: is made where it is missing.
            report: writes another report than that of a diagnosis.

        Returns:
            The path of the report.

        Raises:
            ReportError: the report could not be drawn. Findings and model are there, and a line
                that says so in the place of the report.
        """
        # The writer stands above the findings: it is reached through the front of the package.
        import rga

        return rga.write_findings(self, directory, report)

    def to_json(self) -> str:
        """The content of findings.json."""
        return json.dumps(self.model_dump(mode="json"), indent=1, allow_nan=False)
