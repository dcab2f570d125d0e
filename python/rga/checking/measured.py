"""A record beside what the model says of it: simulated once for all checks."""

from dataclasses import dataclass, field
from functools import cached_property

from rga.arrays import FloatArray, IntArray
from rga.checking.over_ranges import OverRanges
from rga.diagnosis.data.observations import Data
from rga.diagnosis.preparation.context_search import guess_lines, guess_rows
from rga.diagnosis.preparation.prepare import data_of
from rga.findings.criteria import Criteria
from rga.model.schema import Model
from rga.records import Record


@dataclass(frozen=True)
class Measured:
    """A record of a model.

    Attributes:
        over: the model, and what it does over its ranges.
        record: as it was measured.
        criteria: what is usual of records and channels.
    """

    over: OverRanges
    record: Record
    criteria: Criteria = field(default_factory=Criteria)

    @property
    def model(self) -> Model:
        """The model."""
        return self.over.model

    @cached_property
    def few(self) -> Record:
        """The record thinned evenly to the rows that a diagnosis looks at."""
        step = -(-len(self.record) // self.criteria.record.most_rows)
        return self.record.rows(slice(None, None, max(step, 1)))

    @cached_property
    def data(self) -> Data:
        """Readings of these rows, contexts that were not measured guessed by them.

        Raises:
            InputError: the record does not fit the model, or cannot be simulated.
        """
        data = data_of(self.model, self.few, self.criteria)
        data = guess_lines(self.over.simulator, data, lambda _: None)
        return guess_rows(self.over.simulator, data)

    @cached_property
    def simulated(self) -> FloatArray:
        """What the model says of `data`, float[rows, sensors]."""
        return self.data.predict(self.over.simulator)

    def moment(self, row: int) -> str:
        """A row of the record in words, with its time."""
        label = self.record.time_label(float(self.record.time[row]))
        return f"row {row + 1}, {label if isinstance(label, str) else f'{label:.12g} s'}"

    def rows_in_words(self, rows: IntArray) -> str:
        """Rows in words: how many, the first and the last.

        Args:
            rows: numbers of rows, growing.
        """
        if len(rows) == 1:
            return self.moment(int(rows[0]))
        first, last = self.moment(int(rows[0])), self.moment(int(rows[-1]))
        return f"{len(rows)} of {len(self.record)} rows, {first} to {last}"
