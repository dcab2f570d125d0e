"""What a record has of the model's sensors and contexts, and what the reader said of it."""

from collections.abc import Iterator

from rga.checking.finding import Finding, parts
from rga.checking.measured import Measured
from rga.quantities import counted


def channels(measured: Measured) -> Iterator[Finding]:
    """Sensors that are left out, contexts that are not measured, too few rows.

    Raises:
        InputError: there are fewer rows than a diagnosis needs.
    """
    model, record = measured.model, measured.record
    absent = [name for name in model.sensors if name not in record.sensors]
    if absent:
        reasons = dict.fromkeys(record.unused[name] for name in absent if name in record.unused)
        yield Finding(
            "note",
            parts("sensor", absent),
            "it is not in the record" + (f": {'; '.join(list(reasons)[:3])}" if reasons else ""),
            "nothing is said of its readings; add its channel where there is one",
        )
    latent = [name for name in measured.over.simulator.needed if name not in record.contexts]
    if latent:
        yield Finding(
            "note",
            parts("context", sorted(latent)),
            "it is not in the record: it is inferred from the readings",
            "add its column where it was measured",
        )
    for warning in record.warnings:
        # Those of contexts are told with the rows.
        if not any(
            warning.startswith((f"{name} lies outside its range", f"{name} is missing in"))
            for name in record.contexts
        ):
            yield Finding("warning", "record", warning, "look into the file and its import.toml")
    few = measured.criteria.record.few_rows
    if len(record) < few:
        what = f"it has {counted(len(record), 'row')}: noise and intervals are rough estimates"
        yield Finding("note", "record", what, f"give {few} rows or more")
    measured.criteria.record.check_length(len(record))
