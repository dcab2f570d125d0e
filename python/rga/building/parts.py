"""Parts of a model file, held against its schema as they are given."""

from typing import Any

from pydantic import BaseModel, ValidationError

from rga.errors import InputError


def checked(kind: type[BaseModel], given: Any, where: str) -> dict[str, Any]:
    """A part as it stands in a model file; InputError with every wrong key."""
    try:
        part = given if isinstance(given, kind) else kind.model_validate(given)
    except ValidationError as error:
        wrong = [_sentence(one) for one in error.errors(include_url=False)]
        raise InputError("; ".join(wrong), where, "see `rga schema model`") from None
    return part.model_dump(mode="json", exclude_defaults=True)


def _sentence(one: Any) -> str:
    unknown = one["type"] == "extra_forbidden"
    said = "this key is unknown" if unknown else one["msg"].removeprefix("Value error, ")
    return f"{'.'.join(map(str, one['loc']))}: {said}".lstrip(": ")
