"""One name, one thing: no two public classes of the packages have the same name."""

import ast
from collections import Counter
from pathlib import Path

PACKAGES = Path(__file__).parents[2] / "python"


def public_classes(source: str) -> list[str]:
    every = (one.name for one in ast.parse(source).body if isinstance(one, ast.ClassDef))
    return [name for name in every if not name.startswith("_")]


def repeated(sources: list[str]) -> list[str]:
    count = Counter(name for source in sources for name in public_classes(source))
    return sorted(name for name, times in count.items() if times > 1)


def test_no_name_is_given_twice() -> None:
    sources = [path.read_text(encoding="utf-8") for path in PACKAGES.rglob("*.py")]
    assert sum(map(len, map(public_classes, sources))) > 100
    assert repeated(sources) == []


def test_a_name_given_twice_is_seen() -> None:
    assert repeated(["class Plan: ...", "class _Plan: ...\nclass Plan: ...\nclass Other: ..."]) == [
        "Plan"
    ]
