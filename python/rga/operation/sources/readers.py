"""What reads each source of a twin, by the mappings that its sources state."""

from collections.abc import Mapping

from rga.errors import InputError, SeveralMistakes
from rga.model import Model
from rga.operation.rows.samples import Reader
from rga.operation.sources.settings import AnySource
from rga.records.mapping import RecordMapping, read_mapping


def readers_of(twin: str, sources: Mapping[str, AnySource], model: Model) -> dict[str, Reader]:
    """By the name of each source, what reads it.

    Args:
        twin: name of the twin, for an error.
        sources: by name.
        model: of the twin.

    Raises:
        InputError: a mapping cannot be read, or is none of what the model has; where several are
            wrong, with all that is wrong with them (`SeveralMistakes`).
    """
    found: dict[str, Reader] = {}
    faults: list[InputError] = []
    for name, source in sources.items():
        try:
            mapping, where = _mapping_of(source), f"twin {twin!r}, source {name!r}"
            found[name] = Reader(name, model, mapping, source.stated, f"{mapping.path}, {where}")
        except InputError as error:
            faults.append(error)
    if len(faults) > 1:
        told = [f"{one} ({error.where})" for error in faults for one in _mistakes(error)]
        where, remedy = f"twin {twin!r}", "correct each of them in its import.toml"
        raise SeveralMistakes(list(dict.fromkeys(told)), where, remedy)
    if faults:
        raise faults[0]
    return found


def _mistakes(error: InputError) -> tuple[str, ...]:
    return error.mistakes if isinstance(error, SeveralMistakes) else (error.what,)


def _mapping_of(source: AnySource) -> RecordMapping:
    """How what a source brings is read.

    Raises:
        InputError: its file cannot be read, or has a zero or files beside it.
    """
    mapping = RecordMapping() if source.mapping is None else read_mapping(source.mapping)
    if mapping.zero is not None or mapping.beside:
        raise InputError(
            "a source that goes on has no zero of its own and no files beside it",
            str(source.mapping),
            "leave out zero and beside, and name each logger a source",
        )
    return mapping
