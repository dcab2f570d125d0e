"""The tables of docs/reference/criteria.md, written from the class of the criteria.

    python tools/criteria_table.py

What stands above them on the page is written by hand.
"""

from collections.abc import Iterator
from pathlib import Path

from pydantic import BaseModel

from rga.findings.criteria import Criteria

PAGE = Path(__file__).parents[1] / "docs" / "reference" / "criteria.md"
MARK = "<!-- tables: python tools/criteria_table.py -->\n"


def page(written: str) -> str:
    """The page with its tables anew."""
    return "\n".join([written.split(MARK, 1)[0] + MARK, *_tables(Criteria)])


def _tables(criteria: type[BaseModel]) -> Iterator[str]:
    for group, of in criteria.model_fields.items():
        assert of.annotation is not None
        yield f"## `{group}`: {of.description}"
        yield "| criterion | default | unit | what it decides | why |"
        yield "|---|---|---|---|---|"
        for name, field in of.annotation.model_fields.items():
            said = field.json_schema_extra
            assert isinstance(said, dict)
            cells = [f"`{name}`", f"{field.default:g}", said["unit"], field.description]
            yield f"| {' | '.join(str(cell) for cell in [*cells, said['reason']])} |"
        yield ""


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")
