"""Criteria of what is left: a model that does not fit, and structure that no cause explains."""

from rga.findings.criteria.criterion import (
    Count,
    CriteriaGroup,
    Multiple,
    Positive,
    Share,
    criterion,
)

_JCSS = "JCSS Probabilistic Model Code, part 3.2 (steel)"


class FitCriteria(CriteriaGroup):
    """When a model, extended or not, does not fit the record: then nothing is called right."""

    members: Share = criterion(
        0.05,
        "-",
        "plausible spread of EA of members",
        f"{_JCSS}: modulus 3 %; judgement: area of a section 4 %, together 5 %",
    )
    gains: Share = criterion(
        0.02,
        "-",
        "plausible spread of gains of channels",
        "gauge factor 1 %; its alignment, amplifier and cable together 2 %",
    )
    responses: Share = criterion(
        0.01,
        "-",
        "plausible spread of what a linear structure does otherwise",
        "judgement: secondary bending and eccentricities of a sound truss",
    )
    implausible: Multiple = criterion(
        1.5,
        "-",
        "times the plausible spread from which on an estimate of it hides something else",
        "the spread of a dozen channels is known to a fifth",
    )
    deviations: Positive = criterion(
        4.0,
        "standard deviations of noise, contexts and plausible spread",
        "by how much a channel or group reads more or less than simulated, to be a misfit",
        "no channel of a hundred lies beyond it by chance",
    )
    held_out_gap: Multiple = criterion(
        2.0,
        "noise variances",
        "gap on held-out rows above which residuals are no noise",
        "measured: as-built scatter is not in the gap; sound records of the practice cases reach "
        "1.9, and members that are off by 3 to 7 % leave more than 2",
    )
    unseen_rise: Multiple = criterion(
        1.5,
        "-",
        "gap on groups of channels left out that speak against causes of the structure, with these "
        "over without, from which on the record is not called explained",
        "judgement: a true cause brings it down or leaves it; causes that undo each other on the "
        "channels fitted raise it",
    )
    begun_together: Count = criterion(
        3,
        "channels",
        "channels with a cause of their own that begins within ten rows of the others', from which "
        "on a logger that was started anew is as likely",
        "judgement: gauges that come loose do so one by one",
    )
    stated_noise: Multiple = criterion(
        4.0,
        "-",
        "times its stated noise from which on a channel varies by what no load explains",
        "measured: sound records of blind cases reach 2, rarely 3",
    )
    wandering_noise: Multiple = criterion(
        2.5,
        "-",
        "the same of a channel that remembers more than 0.8 from one row to the next",
        "judgement: noise of an amplifier does not wander; sound channels reach 1.6",
    )
    broken_share: Share = criterion(
        0.33,
        "-",
        "share of channels that do not work from which on a record is not called explained",
        "judgement: a third of the channels are those of a logger, which fails as a whole, and "
        "the rest may not see what they saw",
    )

    @property
    def plausible(self) -> tuple[float, float, float]:
        """Plausible spread of members, gains and responses [-]."""
        return self.members, self.gains, self.responses


class StructureCriteria(CriteriaGroup):
    """Structure in the residuals: patterns that sensors share, and curves over contexts."""

    share: Share = criterion(
        0.02,
        "-",
        "share of the innovations' variance that patterns must take to be structure left",
        "judgement: less changes no gap that is reported with two digits",
    )
    pattern_margin: Multiple = criterion(
        1.25,
        "-",
        "times the largest eigenvalue that independent noise gives, from which on sensors share a "
        "pattern",
        "the edge is that of Marchenko and Pastur (1967), the margin for its scatter",
    )
    most_patterns: Count = criterion(
        3,
        "patterns",
        "patterns of unknown origin at most",
        "judgement: more cannot be distinguished",
    )
    bend: Positive = criterion(
        7.0,
        "standard deviations",
        "size from which on the response to a context bends",
        "judgement: many bends are tried, and the covariance of a bend is an estimate",
    )
    curve_chance: Share = criterion(
        1e-3,
        "-",
        "chance below which the channels go with the square of a context, or of their own reading",
        "one in a thousand, as that at which a cause is named; test of Ramsey (1969)",
    )
    follows: Share = criterion(
        0.4,
        "-",
        "rank correlation from which on a pattern is said to follow a context, or to remember",
        "judgement: of 50 independent rows one in 250 reaches it",
    )
    swings: Share = criterion(
        0.2,
        "-",
        "share of a pattern's variance in one period from which on it is said to swing",
        "judgement: of noise no period takes so much over 100 rows",
    )
