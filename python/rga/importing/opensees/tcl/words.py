"""Tcl text cut into commands and words; Ousterhout's rules, `man n Tcl`."""

import re
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from functools import lru_cache
from typing import Literal

from rga.errors import InputError

#: what a backslash makes of a letter
ESCAPES = {"n": "\n", "t": "\t", "r": "\r", "a": "\a", "b": "\b", "f": "\f", "v": "\v"}
#: signs that mean nothing in a word, wherever it ends; blanks; what ends a comment
PLAIN = re.compile(r'[^\\\[$ \t\n;")]+')
BLANK = re.compile(r"(?:[ \t\n;]|\\\n)*")
BETWEEN = re.compile(r"(?:[ \t]|\\\n)*")
COMMENT = re.compile(r"(?:[^\\\n]|\\.)*", re.DOTALL)
BRACES = re.compile(r"[^\\{}]+")
CLOSING = {"{": "}", "[": "]", '"': '"'}


@dataclass(frozen=True)
class WordPart:
    """WordPart of a word: text as it is, the value of a variable, or the result of a script.

    Attributes:
        index: of an array's element: parts of its name; None for a plain variable.
    """

    kind: Literal["text", "variable", "script"]
    text: str
    line: int
    index: tuple["WordPart", ...] | None = None


@dataclass(frozen=True)
class Word:
    """A word: its parts, and whether it stood in braces or is to be spread into several."""

    parts: tuple[WordPart, ...]
    braced: bool = False
    spread: bool = False


@dataclass(frozen=True)
class TclCommand:
    """A command: its words, and its line in the file."""

    words: tuple[Word, ...]
    line: int


@lru_cache(maxsize=4096)
def commands(text: str, first: int, file: str) -> tuple[TclCommand, ...]:
    """The commands of a script.

    Args:
        text: the script.
        first: number of its first line.
        file: it stands in, for an error.

    Raises:
        InputError: a brace, bracket or quote is not closed.
    """
    return tuple(Cutter(text, first, file).commands())


@lru_cache(maxsize=4096)
def parts_of(text: str, first: int, file: str) -> tuple[WordPart, ...]:
    """TclText with substitutions, as of an expression in braces."""
    cutter = Cutter(text, first, file)
    return tuple(cutter.parts(lambda sign: False))


class Cutter:
    """Cuts a text; its place moves on."""

    def __init__(self, text: str, first: int, file: str) -> None:
        self.text, self.first, self.file = text, first, file
        self.place = 0
        self._counted, self._line = 0, first

    @property
    def line(self) -> int:
        """The line of the place."""
        if self.place < self._counted:
            self._counted, self._line = 0, self.first
        self._line += self.text.count("\n", self._counted, self.place)
        self._counted = self.place
        return self._line

    @property
    def sign(self) -> str:
        """The sign at the place; nothing at the end."""
        return self.text[self.place : self.place + 1]

    def commands(self) -> Iterator[TclCommand]:
        """The commands from the place to the end."""
        while self.place < len(self.text):
            self._skip(BLANK)
            if self.sign == "#":
                self._skip(COMMENT)
                continue
            line, words = self.line, []
            while self.sign and self.sign not in "\n;":
                words.append(self._word())
                self._skip(BETWEEN)
            if words:
                yield TclCommand(tuple(words), line)

    def _skip(self, what: re.Pattern[str]) -> None:
        found = what.match(self.text, self.place)
        self.place = found.end() if found else self.place

    def _continued(self) -> bool:
        """Whether a line goes on behind a backslash at the place."""
        return self.text.startswith("\\\n", self.place)

    def _word(self) -> Word:
        spread = self.text.startswith("{*}", self.place) and not self._ends(self.place + 3)
        if spread:
            self.place += 3
        line = self.line
        if self.sign == "{":
            inner = self.braced()
            self._must_end(line)
            return Word((WordPart("text", inner, line),), True, spread)
        if self.sign == '"':
            self.place += 1
            parts = tuple(self.parts(lambda sign: sign == '"'))
            if not self.sign:
                raise self.error('a quote (") is not closed', line)
            self.place += 1
            self._must_end(line)
            return Word(parts, False, spread)
        ends = " \t\n;"
        return Word(tuple(self.parts(lambda sign: sign in ends)), False, spread)

    def _ends(self, place: int) -> bool:
        return self.text[place : place + 1] in ("", " ", "\t", "\n", ";")

    def _must_end(self, line: int) -> None:
        if not self._ends(self.place) and not self._continued():
            raise self.error(f"{self.sign!r} follows a closing brace or quote", line)

    def braced(self) -> str:
        """What stands between the brace at the place and the one that closes it."""
        line, start, depth = self.line, self.place + 1, 0
        while self.place < len(self.text):
            if run := BRACES.match(self.text, self.place):
                self.place = run.end()
                continue
            sign = self.text[self.place]
            if sign == "\\":
                self.place += 1
            elif sign == "{":
                depth += 1
            else:
                depth -= 1
                if depth == 0:
                    self.place += 1
                    inner = self.text[start : self.place - 1]
                    return inner.replace("\\\n", " \n") if "\\\n" in inner else inner
            self.place += 1
        raise self.error("a brace ({) is not closed", line)

    def parts(self, stops: Callable[[str], bool]) -> Iterator[WordPart]:
        """Parts up to a sign that ends them, or to the end."""
        plain: list[str] = []
        line = self.line
        while self.place < len(self.text):
            if run := PLAIN.match(self.text, self.place):
                plain.append(run[0])
                self.place = run.end()
                continue
            sign = self.text[self.place]
            if stops(sign):
                break
            part: WordPart | None = None
            if sign == "\\":
                if self._continued() and stops(" "):
                    break
                plain.append(self._escape())
                continue
            if sign == "[":
                part = WordPart("script", self._bracketed(), self.line)
            elif sign == "$":
                part = self._variable()
            if part is None:
                plain.append(sign)
                self.place += 1
                continue
            if plain:
                yield WordPart("text", "".join(plain), line)
                plain = []
            yield part
        if plain:
            yield WordPart("text", "".join(plain), line)

    def _escape(self) -> str:
        following = self.text[self.place + 1 : self.place + 2]
        self.place += 2
        if following == "\n":
            return " "
        return ESCAPES.get(following, following or "\\")

    def _bracketed(self) -> str:
        line = self.line
        self.place += 1
        start, depth = self.place, 1
        while self.sign:
            if self.sign == "\\":
                self.place += 1
            elif self.sign == "{":
                self.braced()
                continue
            elif self.sign == '"':
                self._quoted(line)
                continue
            elif self.sign == "[":
                depth += 1
            elif self.sign == "]":
                depth -= 1
                if depth == 0:
                    self.place += 1
                    return self.text[start : self.place - 1]
            self.place += 1
        raise self.error("a bracket ([) is not closed", line)

    def _quoted(self, line: int) -> None:
        self.place += 1
        while self.sign and self.sign != '"':
            self.place += 2 if self.sign == "\\" else 1
        if not self.sign:
            raise self.error('a quote (") is not closed', line)
        self.place += 1

    def _variable(self) -> WordPart | None:
        line = self.line
        if self.text.startswith("${", self.place):
            end = self.text.find("}", self.place)
            if end < 0:
                raise self.error("a brace ({) is not closed", line)
            name = self.text[self.place + 2 : end]
            self.place = end + 1
            return WordPart("variable", name, line)
        end = self.place + 1
        while end < len(self.text) and (self.text[end].isalnum() or self.text[end] in "_:"):
            end += 1
        if end == self.place + 1:
            return None
        name = self.text[self.place + 1 : end]
        self.place = end
        if self.sign != "(":
            return WordPart("variable", name, line)
        self.place += 1
        index = tuple(self.parts(lambda sign: sign == ")"))
        if not self.sign:
            raise self.error("a parenthesis of an array's index is not closed", line)
        self.place += 1
        return WordPart("variable", name, line, index)

    def error(self, what: str, line: int) -> InputError:
        """An error at a line."""
        return InputError(what, f"{self.file}, line {line}", "give the whole script, and close it")
