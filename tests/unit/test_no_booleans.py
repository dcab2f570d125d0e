"""true and false are no numbers in any file that a user writes."""

from collections.abc import Iterator
from pathlib import Path
from typing import Annotated, Any, get_args

import pytest
from pydantic import BaseModel, TypeAdapter, ValidationError

from rga.errors import InputError
from rga.model import load_model
from rga.model.effect import Effect
from rga.model.schema import Material, Model
from rga.records.mapping import RecordMapping
from rga.twin.settings import Settings


def _tables(kind: Any) -> Iterator[type[BaseModel]]:
    """The classes of the tables in a type, however deep."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield kind
        for field in kind.model_fields.values():
            yield from _tables(field.annotation)
    for inner in get_args(kind):
        yield from _tables(inner)


READ = (Model, RecordMapping, Settings, *Effect.vocabulary.values())
WRITTEN = {table for kind in READ for table in _tables(kind)}
#: what a number may stand in
SHAPES: list[Any] = [
    True, *([True] * count for count in range(1, 7)), {"ux": True},
    *({"A": [True] * count} for count in range(1, 7)),
]  # fmt: skip


def _numbers(value: Any) -> Iterator[Any]:
    if isinstance(value, dict | list | tuple):
        for inner in value.values() if isinstance(value, dict) else value:
            yield from _numbers(inner)
    elif isinstance(value, int | float) and not isinstance(value, bool):
        yield value


# A name for a key in files says nothing of its values.
@pytest.mark.filterwarnings("ignore:The 'alias' attribute")
@pytest.mark.parametrize("kind", sorted(WRITTEN, key=lambda kind: kind.__qualname__))
def test_no_key_takes_true_for_one(kind: type[BaseModel]) -> None:
    for name, field in kind.model_fields.items():
        reader: TypeAdapter[Any] = TypeAdapter(Annotated[field.annotation, field])
        for shape in SHAPES:
            try:
                read = reader.validate_python(shape)
            except ValidationError:
                continue
            assert not list(_numbers(read)), f"{name}: {shape} is read as {read}"


def test_the_mistake_is_named_by_its_key(tmp_path: Path) -> None:
    path = tmp_path / "model.json"
    path.write_text(
        '{"rga_model": 1, "name": "m", "materials": {"steel": {"E": true}}, "sections": {}, '
        '"nodes": {}, "members": {}, "supports": {}}'
    )
    with pytest.raises(InputError, match=r"materials\.steel\.E: true is no number"):
        load_model(path)


def test_numbers_as_text_are_read_as_before() -> None:
    assert Material.model_validate({"E": "210e9"}).E == 2.1e11
