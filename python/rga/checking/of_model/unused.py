"""What a model has and nothing of it uses."""

from collections.abc import Iterator

from rga.checking.finding import Finding, parts
from rga.checking.over_ranges import OverRanges
from rga.model.parameter import listed
from rga.model.schema import Model


def unused(over: OverRanges) -> Iterator[Finding]:
    """Sections, materials, contexts and groups that no member or effect names."""
    model = over.model
    members = model.members.values()
    for kind, table, used in (
        ("section", model.sections, {member.section for member in members}),
        ("material", model.materials, {member.material for member in members}),
    ):
        if idle := [name for name in table if name not in used]:
            yield Finding("note", parts(kind, idle), "no member has it", "take it out")
    driving = {name for effect in model.effects.values() for name in effect.drivers()}
    driving |= _named(model, "context")
    if idle := [name for name in model.context if name not in driving]:
        yield Finding(
            "note",
            parts("context", idle),
            "it drives no effect, so it changes nothing; a diagnosis may find what does",
            'where it is known what it does, let it drive a parameter: {"context": name}',
        )
    grouped = _named(model, "group")
    for effect in model.effects.values():
        grouped |= set(getattr(effect, "groups", ()))
    if idle := [name for name in model.groups if name not in grouped]:
        yield Finding(
            "note",
            parts("group", idle),
            "no effect names it; a diagnosis looks for causes in it all the same",
            "leave it where that is meant, for warmth name it in the temperature effect",
        )


def _named(model: Model, of: str) -> set[str]:
    """Parts that places of effects name."""
    return {
        name
        for effect in model.effects.values()
        for field, mark in effect.place_fields().items()
        if mark.of == of
        for name in listed(getattr(effect, field))
    }
