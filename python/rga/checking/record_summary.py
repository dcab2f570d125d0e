"""What was read as the record that is checked."""

from dataclasses import dataclass

import numpy as np

from rga.model.schema import Model
from rga.records import Record


@dataclass(frozen=True)
class RecordSummary:
    """A record in a few numbers.

    Attributes:
        rows: their number.
        first, last: times of the first row and the last, as the record writes them.
        step_s: usual step between two rows [s].
        sensors, contexts: how many it has.
        model_sensors, model_contexts: how many the model has.
        missing: share of cells without a value.
        notes: what was understood of its files, and how those beside each other were matched.
    """

    rows: int
    first: str | float
    last: str | float
    step_s: float
    sensors: int
    contexts: int
    model_sensors: int
    model_contexts: int
    missing: float
    notes: tuple[str, ...] = ()

    def lines(self) -> list[str]:
        """In words: the numbers, then each note."""
        first, last = (
            time if isinstance(time, str) else f"{time:.12g} s" for time in (self.first, self.last)
        )
        step = f", a step of {self.step_s:g} s" if self.rows > 1 else ""
        contexts = (
            f" and {self.contexts} of {self.model_contexts} contexts" if self.model_contexts else ""
        )
        said = (
            f"{self.rows} row{'s' * (self.rows != 1)}, {first} to {last}{step}; {self.sensors} of "
            f"{self.model_sensors} sensors{contexts}; {_missing(self.missing)}"
        )
        return [said, *self.notes]


def summary_of(record: Record, model: Model) -> RecordSummary:
    """A record in a few numbers.

    >>> from rga.model import read_model
    >>> model = read_model({
    ...     "rga_model": 1, "name": "bar", "materials": {}, "sections": {},
    ...     "nodes": {}, "members": {}, "supports": {},
    ... }, "bar.json")
    >>> readings = np.array([[1.0], [np.nan], [2.0], [3.0]])
    >>> record = Record(np.arange(4.0), 10.0, "seconds", ("D1",), readings, notes=["read as CSV"])
    >>> for line in summary_of(record, model).lines():
    ...     print(line)
    4 rows, 10 s to 13 s, a step of 1 s; 1 of 0 sensors; 25 % of the cells missing
    read as CSV
    """
    cells = [record.readings, *(values[:, None] for values in record.contexts.values())]
    values = np.concatenate(cells, axis=1) if len(record) else np.zeros((0, 1))
    return RecordSummary(
        rows=len(record),
        first=record.time_label(float(record.time[0])) if len(record) else record.start,
        last=record.time_label(float(record.time[-1])) if len(record) else record.start,
        step_s=float(np.median(np.diff(record.time))) if len(record) > 1 else 0.0,
        sensors=len(record.sensors),
        contexts=len(record.contexts),
        model_sensors=len(model.sensors),
        model_contexts=len(model.context),
        missing=float(np.isnan(values).mean()) if values.size else 0.0,
        notes=tuple(record.notes),
    )


def _missing(share: float) -> str:
    """What share of the cells is missing, in words; a few of many are not none.

    >>> _missing(0.0), _missing(1e-6), _missing(0.0123)
    ('no cell missing', 'under 0.1 % of the cells missing', '1.2 % of the cells missing')
    """
    if share == 0:
        return "no cell missing"
    return f"{'under 0.1' if share < 1e-3 else f'{share * 100:.2g}'} % of the cells missing"
