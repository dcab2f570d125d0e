"""Criteria of causes: when one is named, what its rivals are, and what is said of others."""

from rga.findings.criteria.criterion import (
    Count,
    CriteriaGroup,
    Multiple,
    Positive,
    Share,
    criterion,
)


class NamingCriteria(CriteriaGroup):
    """When a cause is named."""

    log_odds: Positive = criterion(
        6.9,
        "log-odds",
        "what a cause must have over leaving it out, all places and kinds counted",
        "a thousand to one; the chance of a curve (structure.curve_chance) is the same",
    )
    most_causes: Count = criterion(
        5,
        "causes",
        "causes that are looked for at most",
        "judgement: a structure that needs more needs another model",
    )
    kept_with_free_slopes: Share = criterion(
        0.5,
        "-",
        "share of its log-odds that a cause must keep where slopes of responses are free",
        "judgement: what loses more lives by the slope, which is not what it was",
    )
    sensor_multiple: Multiple = criterion(
        2.0,
        "-",
        "multiple of log_odds from which on a cause at a sensor stands against held-out rows",
        "these rows are few: chance turns them against a true cause that is barely sure, hardly "
        "against one that is twice as sure",
    )
    group_against: Positive = criterion(
        4.6,
        "log-odds",
        "by how much a group of channels left out must speak against a cause that falls",
        "a hundred to one",
    )
    few_readings: Count = criterion(
        2,
        "readings",
        "a cause must be likelier than none without so many readings, those that speak most for it",
        "a spike lasts two rows at most (channels.longest_spike)",
    )


class RivalCriteria(CriteriaGroup):
    """What a cause cannot be distinguished from."""

    log_odds: Positive = criterion(
        4.6,
        "log-odds",
        "lead of a cause below which an alternative is its rival; what a plan has to reach",
        "a hundred to one",
    )
    may_hang: Positive = criterion(
        30.0,
        "log-odds",
        "lead up to which it may hang on one channel, where structure is left",
        "judgement: one channel seldom gives more; larger leads are not tried channel by channel",
    )
    predicts_better: Share = criterion(
        0.5,
        "-",
        "share of a cause's gap on channels left out below which its rival goes first",
        "judgement: half the gap is more than the choice of groups makes",
    )
    predicts_alike: Multiple = criterion(
        1.5,
        "-",
        "times the least such gap within which evidence decides between rivals again",
        "judgement: gaps of a few groups scatter by about as much",
    )
    listed: Count = criterion(
        8,
        "rivals",
        "rivals that findings list at most; the rest is counted",
        "kinds that pass for each other are fewer, and more places say no more than that the place "
        "is open",
    )


class ExplanationCriteria(CriteriaGroup):
    """Remarks on explanations that were tried, and what these data could not show."""

    predicts_better: Share = criterion(
        0.9,
        "-",
        "share of the named causes' gap on channels left out below which it is said that another "
        "predicts them better",
        "judgement: a remark, which decides no verdict",
    )
    unlikely: Positive = criterion(
        3.0,
        "prior standard deviations",
        "distance of a parameter from its median from which on it would be unlikely",
        "three in a thousand lie beyond it",
    )
    smallest_d_prime: Positive = criterion(
        3.0,
        "d'",
        "size of the largest physical value below which a kind and place is unidentifiable",
        "half of d'^2 is 4.5 log-odds, less than a name needs",
    )


class AdviceCriteria(CriteriaGroup):
    """What to measure next; a plan goes by those of its findings."""

    success: Share = criterion(
        0.9,
        "-",
        "chance of a lead of rivals.log_odds from which on a measurement separates rivals",
        "judgement: nine in ten pay for a gauge",
    )
    alike: Positive = criterion(
        0.5,
        "d_perp",
        "separation below which rivals predict the same everywhere",
        "the right one is then likelier in six of ten cases",
    )
    enough: Positive = criterion(
        5.5,
        "d_perp",
        "separation beyond which a plan buys nothing more",
        "97 % win by 4.6 log-odds",
    )
    heavy_truck: Multiple = criterion(
        1.1,
        "-",
        "times the largest strain under the model's loads from which on a truck is warned about",
        "judgement: a tenth is within what loads are known to",
    )
