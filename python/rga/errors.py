"""Errors that a user meets."""

from collections.abc import Sequence
from pathlib import Path
from unicodedata import category

#: letters of each part of an error that are shown
LONGEST = 1000


class InputError(ValueError):
    """Input that cannot be used: what is wrong, where, and how to mend it.

    >>> str(InputError("the unit 'kg' is not one of a strain", "sensor 'S1'", "use microstrain"))
    "the unit 'kg' is not one of a strain (sensor 'S1'): use microstrain"
    """

    def __init__(self, what: str, where: str, remedy: str) -> None:
        self.what, self.where, self.remedy = what, where, remedy
        # The parts are the arguments, so that the error passes from process to process.
        super().__init__(what, where, remedy)

    def __str__(self) -> str:
        what, where, remedy = map(in_a_line, (self.what, self.where, self.remedy))
        return f"{what} ({where}): {remedy}"


class SeveralMistakes(InputError):
    """Several mistakes of one input, to be mended together.

    Attributes:
        mistakes: every one, in words.

    >>> print(SeveralMistakes(["A: 0 is no area", "E: missing"], "model.json", "mend them"))
    2 mistakes (model.json): mend them
      A: 0 is no area
      E: missing
    """

    #: mistakes that the words list; they count the others
    MOST = 20

    def __init__(self, mistakes: Sequence[str], where: str, remedy: str) -> None:
        super().__init__(f"{len(mistakes)} mistakes", where, remedy)
        self.mistakes = tuple(map(in_a_line, mistakes))
        self.args = (self.mistakes, where, remedy)

    def __str__(self) -> str:
        listed, more = self.mistakes[: self.MOST], len(self.mistakes) - self.MOST
        lines = [InputError.__str__(self), *listed, *([f"... and {more} more"] if more > 0 else [])]
        return "\n  ".join(lines)


class UnstableStructureError(InputError):
    """A structure that can move without resistance, with the node and the direction that move."""


class MissingPackageError(ImportError):
    """A package that only some parts of rga need, and that is not installed.

    >>> str(MissingPackageError("torch", "networks"))
    'torch is not installed: pip install "rga[networks]"'
    """

    def __init__(self, package: str, extra: str) -> None:
        super().__init__(f'{package} is not installed: pip install "rga[{extra}]"', name=package)


class ReportError(RuntimeError):
    """A report that could not be drawn, of findings that are written all the same.

    >>> str(ReportError("KeyError: 'S1'", "out"))
    "the report could not be drawn (KeyError: 'S1'): out/findings.json and out/model.json are whole"
    """

    def __init__(self, reason: str, directory: str | Path) -> None:
        self.reason, self.directory = reason, Path(directory)
        # The parts are the arguments, so that the error passes from process to process.
        super().__init__(reason, directory)

    def __str__(self) -> str:
        findings, model = (self.directory / name for name in ("findings.json", "model.json"))
        return f"the report could not be drawn ({self.reason}): {findings} and {model} are whole"


def in_a_line(text: str) -> str:
    r"""A text in one line, not too long, its control characters as escapes for a terminal.

    >>> print(in_a_line("no\n such column: 'a\x1b[2J'"))
    no such column: 'a\x1b[2J'
    """
    line = " ".join(text[: 2 * LONGEST].split())
    if len(line) > LONGEST or len(text) > 2 * LONGEST:
        line = f"{line[: LONGEST - 4]} ..."
    return "".join(ascii(one)[1:-1] if category(one)[0] == "C" else one for one in line)


def kind_of(given: object) -> str:
    """The kind of a thing that is not what was wanted, with its article.

    >>> kind_of(3), kind_of({}), kind_of(None)
    ('an int', 'a dict', 'None')
    """
    if given is None:
        return "None"
    name = type(given).__name__
    vowel = name[0] in "aeiouAEIOU" or name == "ndarray"
    return f"{'an' if vowel else 'a'} {name}"


def in_short(error: Exception) -> str:
    """An error in one line, for what goes on without it.

    >>> in_short(KeyError("S1"))
    "KeyError: 'S1'"
    >>> in_short(InputError("the span is 0", "model", "give another"))
    'the span is 0 (model): give another'
    """
    if isinstance(error, InputError):
        return " ".join(str(error).split())
    return f"{type(error).__name__}: {in_a_line(str(error))}"
