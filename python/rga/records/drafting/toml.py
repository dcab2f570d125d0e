"""Parts of a TOML file."""

import json
import re
from collections.abc import Sequence


def text(value: str) -> str:
    r"""A text in quotes.

    >>> print(text('a "b" \\ µ'))
    "a \"b\" \\ µ"
    """
    return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")


def key(name: str) -> str:
    """A key, in quotes where it must be.

    >>> key("S1"), key("S 1")
    ('S1', '"S 1"')
    """
    return name if re.fullmatch(r"[A-Za-z0-9_-]+", name) else text(name)


def listed(values: Sequence[str]) -> str:
    """A list of texts.

    >>> listed(["a", "b"])
    '["a", "b"]'
    """
    return f"[{', '.join(text(value) for value in values)}]"
