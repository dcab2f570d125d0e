"""Parameters of effects: their values in a model file, and their priors."""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Annotated, Any, Protocol

import numpy as np
from pydantic import AfterValidator, BaseModel, ConfigDict, Field

from rga.arrays import FloatArray
from rga.no_booleans import NO_BOOLEAN

#: infinite and undefined ones among them
AnyNumber = Annotated[float, NO_BOOLEAN]
#: beyond which squares and products are no numbers
LARGEST, SMALLEST = 1e30, 1e-30


def _not_huge(value: float) -> float:
    if abs(value) > LARGEST:
        raise ValueError(f"no structure has {value:g}: correct it, or its unit")
    return value


def _not_tiny(value: float) -> float:
    if value < SMALLEST:
        raise ValueError(f"no structure has {value:g}: correct it, or its unit")
    return value


NOT_HUGE = AfterValidator(_not_huge)
Number = Annotated[float, Field(allow_inf_nan=False), NOT_HUGE, NO_BOOLEAN]
NotNegative = Annotated[float, Field(ge=0, allow_inf_nan=False), NOT_HUGE, NO_BOOLEAN]
AboveZero = Annotated[
    float, Field(gt=0, allow_inf_nan=False), NOT_HUGE, AfterValidator(_not_tiny), NO_BOOLEAN
]


#: change of a factor by one unit of a context beyond which it is a slip: of per cent for a share
STEEPEST = 5.0


class Driven(BaseModel):
    """A parameter that follows a context variable: times * (context - minus).

    With a kink it follows two lines that meet there, as what freezes does: at + below * (context -
    kink) below the kink, and at + above * (context - kink) above it.

    Attributes:
        context: name of the variable.
        times, minus: as above.
        log10: the variable is a decimal logarithm: times * 10 ** (context - minus).
        kink: value of the context at which the lines meet; None: there is one line.
        below, above: slopes on either side of the kink, zero where they are left out.
        at: the parameter at the kink; left out, the value at which its effect does nothing.
    """

    model_config = ConfigDict(extra="forbid", frozen=True)
    context: str
    times: Number = 1.0
    minus: Number = 0.0
    log10: bool = False
    kink: Number | None = None
    below: Number = 0.0
    above: Number = 0.0
    at: Number | None = None

    def mistake(self, neutral: float | None) -> str:
        """What cannot be meant, of a parameter with this neutral value; empty where all can."""
        if self.kink is None and (self.below or self.above or self.at is not None):
            return "below, above and at hold about a kink: give kink too"
        if self.kink is None:
            return ""
        if self.times != 1.0 or self.minus or self.log10:
            return "times, minus and log10 say nothing where there is a kink: give below and above"
        if self.at is None and (neutral is None or not np.isfinite(neutral)):
            return "give 'at', the parameter at the kink"
        steepest = max(self.below, self.above, key=abs)
        if neutral == 1.0 and abs(steepest) > STEEPEST:
            return (
                f"the factor changes by {abs(steepest):g} with every unit of {self.context!r}: "
                "give below and above as shares of one, such as -0.01"
            )
        return ""

    def follow(self, context: FloatArray, neutral: float | None = None) -> FloatArray:
        """The parameter at values of the context.

        Args:
            context: float[rows].
            neutral: value at which the effect does nothing; None where there is none.

        >>> Driven(context="bearing", minus=-3.0, log10=True).follow(np.array([4.0]))
        array([10000000.])
        >>> frost = Driven(context="air", kink=0.0, below=-0.01)
        >>> frost.follow(np.array([-10.0, 0.0, 10.0]), neutral=1.0)
        array([1.1, 1. , 1. ])
        """
        if self.kink is None:
            moved = context - self.minus
            return np.asarray(self.times * (10.0**moved if self.log10 else moved))
        warmer = context - self.kink
        at = neutral if self.at is None else self.at
        assert at is not None  # where there is none, the model states one
        return np.asarray(at + np.where(warmer > 0.0, self.above, self.below) * warmer)


class Estimated(BaseModel):
    """A parameter that a diagnosis found, with its 90 % credible interval."""

    model_config = ConfigDict(extra="forbid", frozen=True)
    value: Number
    ci90: tuple[AnyNumber, AnyNumber]


#: 95 % point of the standard normal distribution
NORMAL_90 = 1.6448536269514722
Value = Number | Driven | Estimated


@dataclass(frozen=True)
class Parameter:
    """Marks a field of an effect as a parameter.

    Attributes:
        unit: unit of the value, "-" for a pure number.
        neutral: the value at which the effect does nothing; before an onset the effect has it.
            None for a parameter that an onset leaves alone.
        least: smallest value that a model may state; None where there is none.
    """

    unit: str
    neutral: float | None
    least: float | None = None


@dataclass(frozen=True)
class Place:
    """Marks a field of an effect as its place: the part of the model that it names.

    Attributes:
        of: "member", "group", "node", "support", "mass", "sensor", "context", "effect",
            "material", "point", "mode", or "" for a word that stands in no part of the model (a
            degree of freedom, a direction).
    """

    of: str


class Prior(Protocol):
    """The prior of a parameter, as a map from a standard normal variable z."""

    def value(self, z: float) -> float: ...

    def z(self, value: float) -> float: ...

    @property
    def trials(self) -> tuple[float, ...]: ...


@dataclass(frozen=True)
class Normal:
    """A value that may lie on either side of `centre`.

    Attributes:
        trials: z at which a screening looks.
        tail: of values more than one standard deviation away, as for a `Factor`.

    >>> Normal(0.0, 2.0).value(1.5)
    3.0
    >>> round(Normal(0.0, 1.0, tail=0.5).z(15.0), 1)
    6.3
    """

    centre: float
    spread: float
    trials: tuple[float, ...] = (0.1,)
    tail: float = 0.0

    def value(self, z: float) -> float:
        return self.centre + self.spread * _with_tail(z, self.tail)

    def z(self, value: float) -> float:
        return _without_tail((value - self.centre) / self.spread, self.tail)

    def times(self, scale: float) -> "Normal":
        """The same of a value that is counted in a scale."""
        return replace(self, centre=self.centre * scale, spread=self.spread * scale)

    def __str__(self) -> str:
        return _likely(self)


@dataclass(frozen=True)
class Factor:
    """A positive factor, log-normal about one.

    Attributes:
        spread: standard deviation of its logarithm where that is small.
        tail: of values more than one standard deviation away, which are likelier the larger it
            is; 0: log-normal. What is lost altogether remains possible.

    >>> Factor(0.3).value(0.0), str(Factor(0.3))
    (1.0, '0.61 to 1.6')
    >>> round(Factor(0.2).z(0.05), 1), round(Factor(0.2, tail=0.5).z(0.05), 1)
    (-15.0, -6.3)
    """

    spread: float
    tail: float = 0.0

    def value(self, z: float) -> float:
        return float(np.exp(self.spread * _with_tail(z, self.tail)))

    def z(self, value: float) -> float:
        return _without_tail(float(np.log(value)) / self.spread, self.tail)

    @property
    def trials(self) -> tuple[float, ...]:
        return (-1.0, 1.0)

    def __str__(self) -> str:
        return _likely(self)


@dataclass(frozen=True)
class Positive:
    """A positive value known to within some powers of e about its median.

    Attributes:
        trials: z at which a screening looks; few where places are many.

    >>> Positive(100.0, 2.0).value(0.0)
    100.0
    """

    median: float
    spread: float
    trials: tuple[float, ...] = (-1.5, -0.5, 0.5, 1.5)

    def value(self, z: float) -> float:
        return float(self.median * np.exp(self.spread * z))

    def z(self, value: float) -> float:
        return float(np.log(value / self.median)) / self.spread

    def times(self, scale: float) -> "Positive":
        """The same of a value that is counted in a scale."""
        return Positive(self.median * scale, self.spread, self.trials)

    def __str__(self) -> str:
        return _likely(self)


def _with_tail(z: float, tail: float) -> float:
    """z, and farther out from one standard deviation on.

    As in Jones and Pewsey: Sinh-arcsinh distributions, Biometrika 96, 2009.
    """
    far = max(abs(z) - 1.0, 0.0) if tail else 0.0
    beyond = np.sinh(tail * far) / tail if far else 0.0
    return float(np.copysign(abs(z) - far + beyond, z))


def _without_tail(usual: float, tail: float) -> float:
    beyond = max(abs(usual) - 1.0, 0.0) if tail else 0.0
    far = float(np.arcsinh(tail * beyond)) / tail if beyond else 0.0
    return float(np.copysign(abs(usual) - beyond + far, usual))


def _likely(prior: Prior) -> str:
    """The central 90 % of a prior, two digits."""
    low, high = (float(f"{prior.value(z):.2g}") for z in (-NORMAL_90, NORMAL_90))
    return f"{low:g} to {high:g}"


def resolve(
    value: Value, contexts: Mapping[str, FloatArray], rows: int, neutral: float | None = None
) -> FloatArray:
    """Values of a parameter, one a row.

    Args:
        value: the parameter as it stands in the model.
        contexts: context variables, float[rows] each.
        rows: number of rows.
        neutral: value at which the effect does nothing; None where there is none.

    Returns:
        float[rows], in the parameter's unit.
    """
    if isinstance(value, Driven):
        return value.follow(contexts[value.context], neutral)
    return np.full(rows, value.value if isinstance(value, Estimated) else value)


def listed(place: str | list[str] | None) -> list[str]:
    """The parts that a place names: one, several that share a parameter, or none.

    >>> listed("east"), listed(["east", "west"]), listed(None)
    (['east'], ['east', 'west'], [])
    """
    return [place] if isinstance(place, str) else list(place or [])


def marks(annotation: Any, kind: type) -> Any:
    """The mark of the given kind in the metadata of a field, or None."""
    return next((mark for mark in annotation.metadata if isinstance(mark, kind)), None)
