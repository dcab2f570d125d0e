"""Types of the package reach a user: the mark that type checkers look for is installed."""

from importlib.resources import files
from pathlib import Path


def test_the_package_says_that_it_is_typed() -> None:
    assert (files("rga") / "py.typed").is_file()


def test_the_script_of_a_user_is_checked_with_the_package() -> None:
    """By the same command in both targets, so that it never goes unchecked."""
    makefile = Path(__file__).parents[2].joinpath("Makefile").read_text(encoding="utf-8")
    checks = [line for line in makefile.splitlines() if "/mypy --strict" in line]
    assert len(checks) == 2
    assert all(line.endswith("--strict python tests/typing") for line in checks)
