"""Evaluates Tcl step by step, within bounds; files and programs are out of its reach."""

from collections.abc import Callable, Collection, Iterator
from pathlib import Path
from typing import Any, Protocol

from rga.errors import InputError
from rga.importing.opensees.tcl.expressions import Expression, truth
from rga.importing.opensees.tcl.numbers import written
from rga.importing.opensees.tcl.variables import TclVariables
from rga.importing.opensees.tcl.words import Cutter, TclCommand, Word, WordPart, commands, parts_of
from rga.importing.scripts.values import Steps, Unknown, checked_size

#: procedures within procedures, and files within files
DEEPEST = 40
#: characters up to which a script is remembered as it is cut, since it may be a loop's
REPEATED = 20_000


class TclText(str):
    """A text in braces, which knows where it stands."""

    line: int
    file: str


class CommandTaker(Protocol):
    """What takes the commands that are not Tcl's."""

    def skips(self, name: str) -> bool:
        """Whether a command is passed over, its words unseen."""

    def pass_over(self, name: str, words: str, where: str) -> Any:
        """Pass a command over, and say what its result is."""

    def take(self, name: str, values: list[Any], where: str) -> tuple[bool, Any]:
        """Take a command; whether it was known, and its result."""

    def shapes(self, name: str) -> bool:
        """Whether a command would change the model."""


class Procedure:
    """A procedure of the script."""

    def __init__(self, parameters: list[list[str]], body: str) -> None:
        self.parameters, self.body = parameters, body


class LeavingTcl(Exception):
    """`break`, `continue`, `return` or `exit` on its way out."""

    def __init__(self, kind: str, value: Any = "") -> None:
        self.kind, self.value = kind, value


class TclInterpreter:
    """An interpreter of one script.

    Args:
        host: takes commands that are not Tcl's.
        folder: from which alone `source` reads.
        without: files that it leaves out, since they are not needed.
    """

    def __init__(self, host: CommandTaker, folder: Path, without: Collection[str] = ()) -> None:
        self.host, self.folder, self.without = host, folder.resolve(), frozenset(without)
        self.steps = Steps()
        self.variables = TclVariables()
        self.procedures: dict[str, Procedure] = {}
        self.depth = 0
        self.main = ""
        # Here, since these modules build on this one.
        from rga.importing.opensees.tcl.builtins import BUILTINS

        self.builtins: dict[str, Callable[[TclInterpreter, list[Any], str], Any]] = BUILTINS

    def run(self, text: str, line: int, file: str) -> Any:
        """Evaluate a script; the result of its last command.

        Raises:
            InputError: it cannot be read, takes too many steps, or a command is wrong.
        """
        result: Any = ""
        short = len(text) < REPEATED
        for one in commands(text, line, file) if short else Cutter(text, line, file).commands():
            result = self._command(one, file)
        return result

    def run_body(self, body: Any, where: str) -> Any:
        """Evaluate a script that is the word of a command."""
        if isinstance(body, Unknown):
            raise InputError(
                f"a script cannot be known: it is {body.reason}", where, "write it out"
            )
        if isinstance(body, TclText):
            return self.run(body, body.line, body.file)
        line = where.rpartition("line ")[2]
        file = where.rpartition(", line ")[0] or self.main
        return self.run(str(body), int(line) if line.isdigit() else 1, file)

    def where(self, line: int, file: str) -> str:
        """A place in words; that in the main file goes without its name."""
        return f"line {line}" if file == self.main else f"{file}, line {line}"

    def _command(self, one: TclCommand, file: str) -> Any:
        where = self.where(one.line, file)
        self.steps.take(where)
        first = one.words[0]
        literal = first.parts[0].text if len(first.parts) == 1 else ""
        if self.host.skips(literal) and literal not in self.procedures:
            return self.host.pass_over(literal, _shown(one), where)
        values = list(self._values(one.words, file))
        if not values:
            return ""
        name, *rest = values
        if isinstance(name, Unknown):
            raise InputError(
                f"which command this is cannot be known: it is {name.reason}", where, "write it out"
            )
        name = name.removeprefix("::")
        if name in self.procedures:
            return self.call(self.procedures[name], name, rest, where)
        if name in self.builtins:
            return self._built_in(name, rest, where)
        known, result = self.host.take(name, rest, where)
        if not known:
            self.host.pass_over(name, _shown(one), where)
        return result

    def _built_in(self, name: str, rest: list[Any], where: str) -> Any:
        try:
            result = checked_size(self.builtins[name](self, rest, where), where)
            if isinstance(result, str):
                self.steps.take(where, len(result))
            return result
        except (TypeError, ValueError, IndexError, AttributeError) as error:
            if isinstance(error, InputError):
                raise
            raise InputError(
                f"{name} has words that do not fit: {' '.join(map(str, rest))[:60]!r}",
                where,
                "see how the command is written",
            ) from None

    def _values(self, words: tuple[Word, ...], file: str) -> Iterator[Any]:
        from rga.importing.opensees.tcl.lists import split_list

        for word in words:
            value = self._word(word, file)
            if word.spread and not isinstance(value, Unknown):
                yield from split_list(value, file)
            else:
                yield value

    def _word(self, word: Word, file: str) -> Any:
        if word.braced:
            text = TclText(word.parts[0].text)
            text.line, text.file = word.parts[0].line, file
            return text
        return self.substituted(word.parts, file)

    def substituted(self, parts: tuple[WordPart, ...], file: str) -> Any:
        """The value of parts put together; not known where one is not."""
        values = [self._part(part, file) for part in parts]
        if len(values) == 1:
            return values[0]
        for value in values:
            if isinstance(value, Unknown):
                return value
        return "".join(map(str, values))

    def _part(self, part: WordPart, file: str) -> Any:
        if part.kind == "text":
            return part.text
        if part.kind == "script":
            return self.run(part.text, part.line, file)
        index = None if part.index is None else self.substituted(part.index, file)
        return self.variables.value(part.text, index)

    def expression(self, text: Any, where: str) -> Any:
        """The value of an expression: a number, a text, or not known."""
        if isinstance(text, Unknown):
            return text
        line, file = (text.line, text.file) if isinstance(text, TclText) else (1, self.main)
        shown: list[str] = []
        values: list[Any] = []
        for part in parts_of(str(text), line, file):
            if part.kind == "text":
                shown.append(part.text)
            else:
                shown.append(f"\0{len(values)}\0")
                values.append(self._part(part, file))
        return Expression("".join(shown), values, where).value()

    def condition(self, text: Any, where: str) -> bool | Unknown:
        """Whether an expression is true."""
        value = self.expression(text, where)
        return value if isinstance(value, Unknown) else truth(value, where)

    def call(self, procedure: Procedure, name: str, values: list[Any], where: str) -> Any:
        """Call a procedure.

        Raises:
            InputError: its arguments do not fit, or it calls itself too often.
        """
        if self.depth >= DEEPEST:
            raise InputError(f"{name} calls itself too often", where, "write its result")
        frame: dict[str, Any] = {}
        left = list(values)
        for number, parameter in enumerate(procedure.parameters):
            if parameter == ["args"] and number == len(procedure.parameters) - 1:
                from rga.importing.opensees.tcl.lists import write_list

                unknown = [value for value in left if isinstance(value, Unknown)]
                frame["args"] = unknown[0] if unknown else write_list(list(map(str, left)))
                left = []
            elif left:
                frame[parameter[0]] = left.pop(0)
            elif len(parameter) > 1:
                frame[parameter[0]] = parameter[1]
            else:
                raise InputError(f"{name}: {parameter[0]!r} is not given", where, "give it")
        if left:
            raise InputError(f"{name} is given too many words", where, "see how it is defined")
        with self.deeper(), self.variables.inside(frame):
            try:
                return self.run_body(procedure.body, where)
            except LeavingTcl as leaving:
                if leaving.kind != "return":
                    raise
                return leaving.value

    def deeper(self) -> "Deeper":
        """Counts one level while it is entered."""
        return Deeper(self)

    def source(self, name: str, where: str) -> Any:
        """Evaluate another file of the folder.

        Raises:
            InputError: it is elsewhere, or not there.
        """
        from rga.importing.reading import read_text

        if Path(name).name in self.without:
            return self.host.pass_over("source", f"source {name}", where)
        path = (self.folder / name).resolve()
        if not path.is_relative_to(self.folder):
            raise InputError(
                f"the script reads {name!r}, outside its folder", where, "put that file beside it"
            )
        if not path.is_file():
            raise InputError(
                f"the script reads {name!r}, which is not beside it",
                where,
                "put that file beside it, or name it as not needed: --without NAME",
            )
        if self.depth >= DEEPEST:
            raise InputError("files read each other too often", where, "give one file")
        with self.deeper():
            try:
                return self.run(read_text(path), 1, name)
            except LeavingTcl as leaving:
                if leaving.kind != "return":
                    raise
                return leaving.value


class Deeper:
    """One level of procedures or files."""

    def __init__(self, interpreter: TclInterpreter) -> None:
        self.interpreter = interpreter

    def __enter__(self) -> None:
        self.interpreter.depth += 1

    def __exit__(self, *_: object) -> None:
        self.interpreter.depth -= 1


def _shown(one: TclCommand) -> str:
    """A command in short."""
    marks = {"variable": "$", "script": "["}
    words = (
        "".join(marks.get(part.kind, "") + part.text for part in word.parts) for word in one.words
    )
    return " ".join(" ".join(words).split())[:60]


__all__ = ["CommandTaker", "LeavingTcl", "Procedure", "TclInterpreter", "TclText", "written"]
