"""A plan: what to measure next, as it stands in a file."""

import json
from typing import TYPE_CHECKING, Any, Literal

from pydantic import BaseModel, ConfigDict, Field

from rga.notebook import short_html

if TYPE_CHECKING:
    import polars as pl
    from matplotlib.axes import Axes

Interval = tuple[float, float]


class PlanPart(BaseModel):
    model_config = ConfigDict(extra="forbid")


class Says(PlanPart):
    """What an explanation predicts of a measurement.

    Attributes:
        explanation: in words.
        value: [unit of the sensor].
        ci90: from what is not sure of the explanation, of members, gains and noise.
    """

    explanation: str
    value: float
    ci90: Interval


class Telling(PlanPart):
    """A change of one reading in which explanations differ.

    Attributes:
        sensor: its name, or where it goes.
        change: between which states.
    """

    sensor: str
    unit: str
    change: str
    says: list[Says]


class PlannedSensor(PlanPart):
    """A sensor to add, or a second instrument for a context.

    Attributes:
        words: where it goes.
        sensor: as it would stand in the model; None for an instrument.
        context: that an instrument measures.
        point: of an accelerometer, as it would stand among the model's points; None for others.
        noise: standard deviation of a reading [unit].
        cost: in strain gauges put on.
        tells: the readings that separate explanations most.
    """

    words: str
    sensor: dict[str, Any] | None
    context: str | None
    point: dict[str, Any] | None = None
    unit: str
    noise: float
    cost: float
    tells: list[Telling]


class PlannedTest(PlanPart):
    """A load test: a state whose readings are compared with those of another.

    Attributes:
        words: what is done.
        position: of the truck's first axle along its path [m]; None without a truck.
        contexts, against: that are brought about in the two states.
        cost: in strain gauges put on.
        tells: the readings that separate explanations most.
    """

    words: str
    position: float | None
    contexts: dict[str, float]
    against: dict[str, float]
    cost: float
    tells: list[Telling]


class PlannedTruck(PlanPart):
    """The truck of the tests, or the test weights where nothing drives on the structure.

    Attributes:
        loads, spacings: of its axles [kN] [m].
        paths: nodes, that share it.
        driven: whether it is a truck.
    """

    loads: list[float]
    spacings: list[float]
    paths: list[list[str]]
    driven: bool = True


class SimulatedTrials(PlanPart):
    """Drawn readings, half of them with each explanation true, and both explanations fitted.

    Attributes:
        won: share of draws in which the true one was likelier.
        clearly: share in which it was likelier by `rivals.log_odds` of the criteria or more.
    """

    draws: int
    won: float
    clearly: float


class Separation(PlanPart):
    """Two explanations, and how far the planned measurements separate them.

    Attributes:
        one, other: in words.
        log_odds: by which the record itself tells the first from the other; None where it was not
            put beside it.
        d_perp: difference that is left once either has imitated the other, in units of all errors.
        expected: chance that the true one wins by `rivals.log_odds` of the criteria.
        d_perp_at_best: with every sensor and every test that were thought of.
        separated: the plan is to separate them: it wins clearly in nine of ten draws.
        simulated: the check of that.
    """

    one: str
    other: str
    log_odds: float | None = None
    d_perp: float
    expected: float
    d_perp_at_best: float
    separated: bool
    simulated: SimulatedTrials


class Advised(PlanPart):
    """A sensor or load test that the findings advise.

    Attributes:
        words: what it is.
        planned: it is part of the plan.
        d_perp: with it alone, the smallest of the explanations that can be separated.
    """

    words: str
    planned: bool
    d_perp: float


class Ranked(PlanPart):
    """The best measurement of a kind, by itself.

    Attributes:
        kind: of sensor or of test.
        words: what it is.
        cost: in strain gauges put on.
        d_perp, expected: of every two explanations, in the order of the separations.
    """

    kind: str
    words: str
    cost: float
    d_perp: list[float]
    expected: list[float]


class Plan(PlanPart):
    """What to measure next, so that rival explanations are separated.

    Attributes:
        sentence: in plain words.
        sensors, tests: what to measure; both empty where nothing is to be gained.
        separations: of every two explanations.
        ranked: the best of each kind of measurement by itself, that which confuses least first.
        advised: what the findings advise, of which the choice takes what is as good as any.
        cost: of all, in strain gauges put on.
        budget: sensors and tests that were allowed.
    """

    rga_plan: Literal[1] = 1
    sentence: str
    sensors: list[PlannedSensor] = []
    tests: list[PlannedTest] = []
    truck: PlannedTruck | None = None
    separations: list[Separation] = []
    ranked: list[Ranked] = []
    advised: list[Advised] = []
    cost: float = 0.0
    budget: dict[str, int]
    warnings: list[str] = []
    seed: int
    model_sha256: str
    findings_sha256: str
    versions: dict[str, str] = Field(default_factory=dict)

    def plot(self, ax: "Axes | None" = None) -> "Axes":
        """How far the plan separates every two explanations, in axes of matplotlib.

        Args:
            ax: axes; None: those of a new figure.
        """
        # matplotlib takes long to load, and a plan is made without it.
        from rga.drawing.charts import plot_pairs

        return plot_pairs(
            [
                " | ".join(words.partition(":")[0] for words in (pair.one, pair.other))
                for pair in self.separations
            ],
            [pair.d_perp_at_best for pair in self.separations],
            [pair.d_perp for pair in self.separations],
            ("with all that was thought of", "with the plan"),
            "d\N{UP TACK}: difference in units of all errors",
            ax,
        )

    def to_frame(self) -> "pl.DataFrame":
        """Sensors and tests to make, one a row, with their cost in strain gauges put on."""
        import polars as pl

        parts: list[tuple[str, PlannedSensor | PlannedTest]] = [
            *(("sensor", one) for one in self.sensors),
            *(("test", one) for one in self.tests),
        ]
        told = ["; ".join(f"{t.sensor}, {t.change}" for t in one.tells) for _, one in parts]
        return pl.DataFrame(
            [
                pl.Series("measurement", [kind for kind, _ in parts], dtype=pl.String),
                pl.Series("words", [one.words for _, one in parts], dtype=pl.String),
                pl.Series("cost", [one.cost for _, one in parts], dtype=pl.Float64),
                pl.Series("tells", told, dtype=pl.String),
            ]
        )

    def _repr_html_(self) -> str:
        return short_html("plan", self.sentence, self.to_frame())

    def to_json(self) -> str:
        """The content of a plan's file."""
        return json.dumps(self.model_dump(mode="json"), indent=1, allow_nan=False)
