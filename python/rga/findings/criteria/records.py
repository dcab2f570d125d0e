"""Criteria of records: rows, warnings, and zeros that nobody declared."""

from typing import Annotated

from pydantic import Field, model_validator

from rga.errors import InputError
from rga.findings.criteria.criterion import (
    Count,
    CriteriaGroup,
    Multiple,
    Positive,
    Share,
    criterion,
)
from rga.quantities import counted


class RecordCriteria(CriteriaGroup):
    """Which rows are analysed, and what of a record is warned about."""

    most_rows: Count = criterion(
        800,
        "rows",
        "rows that are analysed at most; more are thinned evenly",
        "the cost of a diagnosis grows with them, and noise remembers from row to row",
    )
    few_rows: Count = criterion(
        60,
        "rows",
        "rows below which a warning says that noise and intervals are rough",
        "a standard deviation by 60 independent rows is known to a tenth (1 / sqrt(2 n))",
    )
    least_rows: Annotated[Count, Field(ge=12)] = criterion(
        12,
        "rows",
        "rows below which a record is refused",
        "of fewer no two blocks are held out",
    )
    loaded_rows: Count = criterion(
        10,
        "rows",
        "rows under load below which a record of few rows is too short to decide",
        "of ten rows two are held out and eight fitted; judgement: fewer confirm no cause",
    )
    unit_correlation: Share = criterion(
        0.8,
        "-",
        "correlation with the simulation from which on a channel shows its unit",
        "judgement: at 0.8 two thirds of the variance are in common",
    )
    unit_factor: Multiple = criterion(
        30.0,
        "-",
        "how much larger or smaller readings are than simulated where units are warned about",
        "between the factors that causes reach (below 10) and those of units (25.4, 100, 1000)",
    )
    still_share: Share = criterion(
        0.1,
        "-",
        "last share of the record over which a context repeats one value, to be warned about",
        "judgement: a tenth of a record is more than a calm",
    )
    limit_share: Share = criterion(
        0.1,
        "-",
        "share of rows in which a context may stand at the limit of its instrument, at most",
        "judgement: what stands there longer is how the structure is used",
    )
    denied_channels: Count = criterion(
        3,
        "channels",
        "channels that jump in one row, at least, for the row to be left aside",
        "two gauges of one cable may jump together",
    )
    denied_share: Share = criterion(
        0.2,
        "-",
        "share of the channels that jump in one row, at least, for the row to be left aside",
        "judgement: faults of loggers and cables are seen in fewer",
    )

    far_outside: Positive = criterion(
        1.0,
        "width of the range",
        "how far outside its range a measured context is no measurement, in a part of the rows",
        "a range is stated for what may act; what lies beyond it twice is another unit",
    )
    repeated_rows: Count = criterion(
        8,
        "rows",
        "rows on end that all channels repeat from earlier ones, or lack at the end, to be a fault "
        "of the logger",
        "judgement: noise that is resolved repeats no row, and outages of a few rows are usual",
    )
    faulty_share: Share = criterion(
        0.1,
        "-",
        "share of rows without a true context or reading for such a reason, and of channels that "
        "end early, from which on a record is not called explained",
        "judgement: what happened in a tenth of it could hide",
    )

    silent_share: Share = criterion(
        0.5,
        "-",
        "share of channels without any reading from which on a record is not called explained",
        "judgement: less than half of what was mounted to see it sees too little",
    )

    def check_length(self, rows: int) -> None:
        """Refuse a record that is too short for a diagnosis (InputError).

        >>> RecordCriteria().check_length(11)
        Traceback (most recent call last):
        rga.errors.InputError: the record has 11 rows (record): a diagnosis needs 12 at least
        """
        if rows < self.least_rows:
            raise InputError(
                f"the record has {counted(rows, 'row')}",
                "record",
                f"a diagnosis needs {self.least_rows} at least",
            )

    @model_validator(mode="after")
    def _least_below_most(self) -> "RecordCriteria":
        if self.least_rows > self.most_rows:
            raise ValueError(f"least_rows {self.least_rows} is above most_rows {self.most_rows}")
        return self


class ZeroCriteria(CriteriaGroup):
    """Channels that start from values of their own, or are zeroed again in mid-record."""

    offset: Positive = criterion(
        10.0,
        "standard deviations of the noise",
        "offset of a channel that counts as one",
        "neither chance nor the memory of noise makes so much",
    )
    share_of_channels: Share = criterion(
        0.5,
        "-",
        "share of the working channels that must be off",
        "fewer are faults of their own",
    )
    share_that_jumps: Share = criterion(
        0.3,
        "-",
        "share of the working channels that must jump in one row, for a logger started anew",
        "judgement: the channels of one card of several",
    )
    fewest_channels: Count = criterion(
        4,
        "channels",
        "number of channels that must be off at least",
        "fewer are faults of their own",
    )
    most_causes: Count = criterion(
        3,
        "causes",
        "causes of the vocabulary that may share offsets, which then are no zeros",
        "judgement: records with more causes at once are rare",
    )
    left_by_causes: Share = criterion(
        0.2,
        "-",
        "share of the offsets' squares that these causes must leave, for zeros of their own",
        "judgement: what explains four fifths is the likelier reason",
    )
    one_cause: Share = criterion(
        0.95,
        "-",
        "share of the squares of a jump that one cause alone must make, to be no new zero; that "
        "most_causes must make where the channels do not jump to zero",
        "a new zero undoes what several loads have done, and resembles no single cause so much",
    )
    reading_zero: Share = criterion(
        0.9,
        "-",
        "channels that must read zero at a new zero, as a share of those that should not",
        "a logger zeroes all channels; a tenth is left to channels that do not work",
    )
    near_zero: Positive = criterion(
        4.0,
        "standard deviations of the sensor's noise",
        "how near zero such a channel must read",
        "beyond it lies one reading of noise in 16 000",
    )
    far_from_zero: Positive = criterion(
        8.0,
        "standard deviations of a shift of level",
        "how far from zero it should read",
        "what a context's error of one row makes is no new zero",
    )
    shift_share: Share = criterion(
        0.3,
        "-",
        "share by which the shift of level may miss what should have been read",
        "judgement: a wrong model misses a response by less",
    )
    shift_deviations: Positive = criterion(
        2.0,
        "standard deviations of a shift of level",
        "what it may miss beside",
        "two standard deviations are chance",
    )
