"""Criteria of channels that do not work."""

from rga.findings.criteria.criterion import (
    Count,
    CriteriaGroup,
    Multiple,
    Positive,
    Share,
    criterion,
)


class ChannelCriteria(CriteriaGroup):
    """When a channel is broken, and how."""

    own_part: Positive = criterion(
        2.5,
        "usual size",
        "what a channel shows beyond loads and other channels, from which on it is broken",
        "measured: most sound channels of blind cases stay below 1.5, the worst of 100 records "
        "reached 2.2; broken ones mostly lie above 3",
    )
    own_part_alone: Share = criterion(
        0.9,
        "-",
        "the same of a channel that nothing compares with, as a share of its variation",
        "judgement: a tenth explained is as good as nothing",
    )
    works: Positive = criterion(
        1.8,
        "usual size",
        "own part up to which a channel that breaks later still works",
        "between what most sound channels show (1.5) and the worst of them (2.2)",
    )
    explained: Share = criterion(
        0.6,
        "-",
        "share of an own part that an effect of the structure must explain to be the reason",
        "judgement: more than half, with a margin",
    )
    largest_jump: Positive = criterion(
        6.0,
        "large offset of such a sensor",
        "jump of a level from which on a channel is broken rather than offset",
        "beyond what a search for a sensor_offset reaches",
    )
    spiking_share: Share = criterion(
        0.25,
        "-",
        "share of rows with large own parts up to which a channel spikes; with more it is erratic",
        "judgement: what is off in every fourth row is no spike",
    )
    lone_spike: Positive = criterion(
        36.0,
        "robust standard deviations",
        "distance from the best fit by the loads from which on a short run is no reading",
        "far beyond heavy tails, which the noise model draws in by itself",
    )
    longest_spike: Count = criterion(
        2, "rows", "rows that such a run lasts at most", "what stays away for longer has moved"
    )
    repeats: Share = criterion(
        0.5,
        "-",
        "share of rows that repeat the one before exactly, from which on a channel is stuck",
        "judgement: no noise that a gauge resolves repeats itself so often",
    )
    still_rows: Count = criterion(
        10,
        "rows",
        "rows that a channel repeats itself up to the last, or another channel, to be broken",
        "judgement; readings of coarse steps need more (still_chance)",
    )
    still_chance: Multiple = criterion(
        4.0,
        "-",
        "times the longest run that chance allows of coarse readings",
        "judgement: a margin over the expected longest run",
    )
    still_moves: Share = criterion(
        0.2,
        "-",
        "share of its variation that the simulation has meanwhile",
        "judgement: with less nothing says that the channel should move",
    )
    dead: Share = criterion(
        0.05,
        "-",
        "share of the expected variation below which a channel is dead",
        "no cause takes nineteen twentieths off a response",
    )
    dead_gain: Share = criterion(
        0.05,
        "-",
        "gain below which a cause at a sensor is reported as a dead channel",
        "as for dead",
    )
    scale: Multiple = criterion(
        8.0,
        "-",
        "times the response of its like from which on a channel has a wrong unit or range; its "
        "square below them",
        "no single cause changes a response so much, and units differ by tens at least",
    )
    scale_correlation: Share = criterion(
        0.8,
        "-",
        "correlation with the simulation from which on a channel shows its scale",
        "judgement: at 0.8 two thirds of the variance are in common",
    )
    scale_variation: Share = criterion(
        0.1,
        "-",
        "simulated variation of a channel, as a share of its like's, that a scale needs",
        "judgement: smaller responses are mostly those of something else",
    )
    returns: Share = criterion(
        0.15,
        "-",
        "share of its largest reading by which a channel may be off behind a crossing",
        "dynamics and bearings leave a few percent",
    )
    fewest_for_own_response: Count = criterion(
        4,
        "channels",
        "channels below which none is reported to have a response of its own",
        "fewer do not show what the channels have in common",
    )
