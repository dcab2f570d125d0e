"""Command lines of README and docs: commands that exist, with options that they have."""

import shlex
from pathlib import Path
from typing import Any

import pytest
import typer

from documentation import PAGES, ROOT, command_lines
from rga.cli.app import app

LINES = [
    pytest.param(line, id=f"{page.name}: {line[:60]}")
    for page in PAGES
    for line in command_lines(page)
]


def faults(line: str) -> list[str]:
    """What a command line has that its command does not."""
    command: Any = typer.main.get_command(app)
    _, *tokens = shlex.split(line, comments=True)
    while hasattr(command, "commands") and tokens and tokens[0][0] != "-":
        name = tokens.pop(0)
        if name not in command.commands:
            return [f"no command {name}"]
        command = command.commands[name]
    options = {
        name: one
        for one in command.params
        if one.param_type_name == "option"
        for name in (*one.opts, *one.secondary_opts)
    }
    places = [one for one in command.params if one.param_type_name == "argument"]
    found, given = [], 0
    while tokens:
        token = tokens.pop(0)
        if token[0] != "-" or token == "-":
            given += 1
        elif token == "--help":
            continue
        elif token not in options:
            found.append(f"no option {token}")
        elif not options[token].is_flag and tokens:
            tokens.pop(0)
    if given > len(places) and all(one.nargs == 1 for one in places):
        found.append(f"{given} arguments of {len(places)}")
    return found


@pytest.mark.parametrize("line", LINES)
def test_it_is_one_that_rga_has(line: str) -> None:
    assert faults(line) == []


def test_there_are_some_on_the_pages_that_show_commands() -> None:
    assert len(command_lines(ROOT / "docs" / "reference" / "commands.md")) > 15
    assert any("footbridge" in line for line in command_lines(ROOT / "README.md"))


@pytest.mark.parametrize(
    ("line", "fault"),
    [
        ("rga diagnoze MODEL RECORD", "no command diagnoze"),
        ("rga diagnose MODEL RECORD --colour", "no option --colour"),
        ("rga benchmark loi --colour", "no option --colour"),
        ("rga replay DIR DIR --row 3", "2 arguments of 1"),
        ("rga diagnose MODEL RECORD -o DIR  # the diagnosis --alone", None),
    ],
)
def test_a_slip_is_found(line: str, fault: str | None) -> None:
    assert faults(line) == ([fault] if fault else [])


def test_lines_are_read_from_blocks_and_text(tmp_path: Path) -> None:
    page = tmp_path / "page.md"
    page.write_text("As `rga run\nMODEL` does:\n```\n$ rga doctor\nVerdict\n```\n`rga` alone\n")
    assert command_lines(page) == ["rga doctor", "rga run MODEL"]
