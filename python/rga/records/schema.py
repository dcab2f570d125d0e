"""What a record file holds, as JSON Schema of one row."""

from typing import Any


def record_schema() -> dict[str, Any]:
    """JSON Schema of one row of a record.

    >>> record_schema()["required"]
    ['time']
    """
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "One row of a record (CSV or Parquet)",
        "description": (
            "Columns: time, then one for each sensor of the model and, where they were measured, "
            "its context variables, in the units of the model file. Empty means missing. "
            "A file of another make is read through a mapping, import.toml."
        ),
        "type": "object",
        "properties": {
            "time": {
                "description": "ISO 8601 or seconds, throughout alike and strictly increasing",
                "oneOf": [{"type": "string", "format": "date-time"}, {"type": "number"}],
            }
        },
        "required": ["time"],
        "additionalProperties": {
            "description": "value of the sensor or context variable of that name",
            "type": ["number", "null"],
        },
    }
