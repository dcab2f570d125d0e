"""Settings of a run: the level of integration, and the figures that T1 and T2 go by."""

from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import BaseModel, ConfigDict, Field, model_validator

from rga.errors import InputError
from rga.findings.criteria import Criteria
from rga.inference.networks.settings import TrainingSettings
from rga.no_booleans import NO_BOOLEAN
from rga.settings_files import read_table, validated

Inference = Literal["auto", "joint", "networks", "amortised"]
Level = Literal["A", "B", "C"]
PolicyName = Literal["event", "time", "hybrid", "adaptive"]
Count = Annotated[int, Field(ge=1, strict=True)]


class Settings(BaseModel):
    """Settings of a run.

    Attributes:
        level: A calibrates once; B also detects out-of-sync states and recalibrates (T1); C also
            stores novel contexts (T2), and takes up what it learned under conditions that recur.
        inference: of contexts: `joint`, the joint posterior of contexts and structure, by which the
            twin is corrected; `networks`, the paper's, on the model as it is; `amortised`, networks
            on the corrected twin; or `auto`, the joint posterior where it can be had and predicts
            rows held out as well as the model as given, networks otherwise.
        calibration_rows: rows of the first calibration; None: a third of the record, 200 at most.
        packet: rows that arrive together; None: a 24th of the record.
        detector: of T1: `monitor`, whose false alarms come as rarely as `arl0` asks, or `window`,
            the paper's rule.
        arl0: rows between false alarms of the monitor, on average.
        window, z, persistence: the Gaussian window of the paper's rule: rows, width of its bound in
            standard deviations, and how many of the last rows must exceed it.
        policy: when levels B and C recalibrate: on an alarm (`event`), after every `interval`
            (`time`), on an alarm and after an interval without a recalibration (`hybrid`), or so
            with an interval that follows what recalibrations were worth (`adaptive`).
        interval: rows from one recalibration to the next, rounded up to whole packets; the first
            of the adaptive ones; None: a sixth of the record. `event` has none.
        settle: rows that are gathered after an alarm before a recalibration, and that one learns
            from at the least; None: a twelfth of the record.
        usual: a gap is as it was in the first calibration when it is less than in this share of
            stretches of as many rows, drawn from that calibration [-].
        growth: the diagnosis is asked again of a change that is in doubt when the record has grown
            by this factor; of a new alarm it is asked at once.
        adopt: what a diagnosis names becomes a version of the twin at once (`auto`), or a proposal
            that somebody accepts or rejects (`ask`).
        design_rows: simulations of the design phase.
        repository_z: width of the bound of T2 on the gap, in standard deviations.
        distinct: least distance of a novel context from all stored ones, in shares of the ranges
            of the contexts; None: what separates neighbours of the design phase.
        training: of the networks.
        criteria: of the diagnosis.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    level: Level = "C"
    inference: Inference = "auto"
    calibration_rows: Count | None = None
    packet: Count | None = None
    detector: Literal["monitor", "window"] = "monitor"
    arl0: Annotated[float, Field(ge=100, le=1e12), NO_BOOLEAN] = 10_000.0
    window: Annotated[int, Field(ge=2, le=1_000_000), NO_BOOLEAN] = 100
    z: Annotated[float, Field(gt=0, le=1e6), NO_BOOLEAN] = 4.0
    persistence: tuple[Count, Count] = (4, 6)
    policy: PolicyName = "event"
    interval: Count | None = None
    settle: Count | None = None
    usual: Annotated[float, Field(gt=0.5, lt=1), NO_BOOLEAN] = 0.99
    growth: Annotated[float, Field(gt=1, allow_inf_nan=False), NO_BOOLEAN] = 2.0
    adopt: Literal["ask", "auto"] = "auto"
    design_rows: Annotated[int, Field(ge=128, le=1_000_000), NO_BOOLEAN] = 4096
    repository_z: Annotated[float, Field(gt=0, le=1e6), NO_BOOLEAN] = 4.0
    distinct: Annotated[float, Field(gt=0, allow_inf_nan=False), NO_BOOLEAN] | None = None
    training: TrainingSettings = TrainingSettings()
    criteria: Criteria = Criteria()

    @model_validator(mode="after")
    def _some_of_more(self) -> "Settings":
        if self.persistence[0] > self.persistence[1]:
            raise ValueError(f"persistence {self.persistence}: more exceedances than rows")
        if self.persistence[1] > 64:
            raise ValueError(f"persistence {self.persistence}: more than 64 rows")
        if self.interval is not None and self.policy == "event":
            raise ValueError("policy 'event' has no interval: choose time, hybrid or adaptive")
        return self

    def pace(self, rows: int | None) -> "Pace":
        """What depends on the length of a record, in rows.

        Args:
            rows: of the record; None: it does not end, and these settings have to state them.

        Raises:
            InputError: the calibration wants more rows than there are, or they are not stated.

        >>> Settings().pace(480)
        Pace(calibration_rows=160, packet=20, settle=40, interval=80)
        """
        if rows is None:
            return self._stated_pace()
        wanted = self.calibration_rows or max(1, min(200, rows // 3))
        if wanted > rows:
            raise InputError(
                f"the calibration wants {wanted} rows, and the record has {rows}",
                "setting calibration_rows",
                "give fewer, or a longer record",
            )
        return Pace(
            wanted,
            self.packet or max(1, rows // 24),
            self.settle or max(1, rows // 12),
            self.interval or max(1, rows // 6),
        )

    def _stated_pace(self) -> "Pace":
        names = ["calibration_rows", "packet", "settle"]
        if self.policy != "event":
            names.append("interval")
        absent = [name for name in names if getattr(self, name) is None]
        if absent:
            raise InputError(
                "rows that go on arriving have no share to take",
                f"settings {', '.join(absent)}",
                "state each of them, in rows",
            )
        calibration, packet, settle = self.calibration_rows, self.packet, self.settle
        return Pace(calibration or 1, packet or 1, settle or 1, self.interval or 1)


def as_settings(given: Settings | str | Path | None) -> Settings:
    """Settings, read where their file (JSON or TOML) is given; the default ones where none are.

    Raises:
        InputError: the file cannot be read, a setting is unknown or impossible, or these are none.
    """
    if given is None:
        return Settings()
    if isinstance(given, Settings):
        return given
    if isinstance(given, str | Path):
        return validated(Settings, read_table(Path(given), "settings"), str(given), "settings")
    what = f"a {type(given).__name__} is no set of settings"
    raise InputError(what, "settings", "give Settings, or the path of their file")


@dataclass(frozen=True)
class Pace:
    """Rows of the first calibration, of a packet, and before a recalibration.

    Attributes:
        calibration_rows, packet: as of the settings.
        settle: between an alarm and a recalibration.
        interval: between recalibrations by the clock.
    """

    calibration_rows: int
    packet: int
    settle: int
    interval: int
