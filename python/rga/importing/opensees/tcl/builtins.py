"""Commands of Tcl itself."""

import fnmatch
from collections.abc import Callable
from typing import Any

from rga.errors import InputError
from rga.importing.opensees.tcl import lists, strings
from rga.importing.opensees.tcl.interpreter import LeavingTcl, Procedure, TclInterpreter, TclText
from rga.importing.opensees.tcl.numbers import number, written
from rga.importing.opensees.tcl.skipping import skip
from rga.importing.scripts.values import Unknown, checked_size

Builtin = Callable[[TclInterpreter, list[Any], str], Any]


def _text(value: Any) -> Any:
    return value if isinstance(value, str | Unknown) else written(value)


def _set(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    return tcl.variables.set(words[0], words[1]) if len(words) > 1 else tcl.variables.read(words[0])


def _expr(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    for word in words:
        if isinstance(word, Unknown):
            return word
    return _text(tcl.expression(words[0] if len(words) == 1 else " ".join(words), where))


def _incr(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    value = tcl.variables.read(words[0]) if tcl.variables.exists(words[0]) else "0"
    by = words[1] if len(words) > 1 else "1"
    for one in (value, by):
        if isinstance(one, Unknown):
            return tcl.variables.set(words[0], one)
    total = checked_size(int(number(value, where)) + int(number(by, where)), where)
    return tcl.variables.set(words[0], written(total))


def _append(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    value = tcl.variables.read(words[0]) if tcl.variables.exists(words[0]) else ""
    for one in (value, *words[1:]):
        if isinstance(one, Unknown):
            return tcl.variables.set(words[0], one)
    return tcl.variables.set(words[0], checked_size("".join([value, *words[1:]]), where))


def _lappend(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    value = tcl.variables.read(words[0]) if tcl.variables.exists(words[0]) else ""
    for one in (value, *words[1:]):
        if isinstance(one, Unknown):
            return tcl.variables.set(words[0], one)
    added = lists.write_list(words[1:])
    joined = f"{value} {added}" if value and added else value + added
    return tcl.variables.set(words[0], checked_size(joined, where))


def _lassign(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    if isinstance(words[0], Unknown):
        for name in words[1:]:
            tcl.variables.set(name, words[0])
        return words[0]
    items = lists.split_list(words[0], where)
    for place, name in enumerate(words[1:]):
        tcl.variables.set(name, items[place] if place < len(items) else "")
    return lists.write_list(items[len(words) - 1 :])


def _array(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    what, name, *rest = words
    if what == "set":
        if isinstance(rest[0], Unknown):
            return tcl.variables.set(name, rest[0])
        items = lists.split_list(rest[0], where)
        for index, value in zip(items[::2], items[1::2], strict=False):
            tcl.variables.set(f"{name}({index})", value)
        return ""
    array = tcl.variables.array(name)
    pattern = rest[0] if rest else "*"
    if isinstance(pattern, Unknown):
        return pattern
    chosen = [index for index in array if fnmatch.fnmatchcase(index, pattern)]
    if what == "names":
        return lists.write_list(chosen)
    if what == "get":
        unknown = [array[index] for index in chosen if isinstance(array[index], Unknown)]
        pairs = [part for index in chosen for part in (index, str(array[index]))]
        return unknown[0] if unknown else lists.write_list(pairs)
    if what == "exists":
        return str(int(bool(array)))
    return str(len(array)) if what == "size" else Unknown(f"array {what}")


def _if(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    left = list(words)
    while left:
        condition = tcl.condition(left.pop(0), where)
        if left and left[0] == "then":
            left.pop(0)
        body = left.pop(0)
        if isinstance(condition, Unknown):
            others = [word for word in left if isinstance(word, TclText)]
            return skip(tcl, [body, *others], condition, where)
        if condition:
            return tcl.run_body(body, where)
        if left and left[0] == "elseif":
            left.pop(0)
            continue
        if left and left[0] == "else":
            left.pop(0)
        return tcl.run_body(left[0], where) if left else ""
    return ""


def _loop(tcl: TclInterpreter, test: Any, body: Any, then: Any, where: str) -> Any:
    """A loop while a test holds; `then` is evaluated after each turn."""
    while True:
        tcl.steps.take(where)
        condition = tcl.condition(test, where)
        if isinstance(condition, Unknown):
            return skip(tcl, [body, then], condition, where)
        if not condition or not _turn(tcl, body, where):
            return ""
        if then:
            tcl.run_body(then, where)


def _turn(tcl: TclInterpreter, body: Any, where: str) -> bool:
    """One turn of a loop; whether there may be another."""
    try:
        tcl.run_body(body, where)
    except LeavingTcl as leaving:
        if leaving.kind not in ("break", "continue"):
            raise
        return leaving.kind == "continue"
    return True


def _for(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    begin, test, then, body = words
    tcl.run_body(begin, where)
    return _loop(tcl, test, body, then, where)


def _foreach(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    *pairs, body = words
    named, columns = [], []
    for names, items in zip(pairs[::2], pairs[1::2], strict=True):
        if isinstance(items, Unknown):
            for name in lists.split_list(names, where):
                tcl.variables.set(name, items)
            return skip(tcl, [body], items, where)
        own = lists.split_list(names, where)
        values = lists.split_list(items, where)
        named.append(own)
        columns.append([values[k : k + len(own)] for k in range(0, len(values), len(own))])
    for turn in range(max(map(len, columns), default=0)):
        tcl.steps.take(where)
        for own, column in zip(named, columns, strict=True):
            values = column[turn] if turn < len(column) else []
            for place, name in enumerate(own):
                tcl.variables.set(name, values[place] if place < len(values) else "")
        if not _turn(tcl, body, where):
            break
    return ""


def _switch(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    options = [word for word in words if str(word).startswith("-") and word is not words[-1]]
    left = [word for word in words if word not in options]
    value, *rest = left
    cases = lists.split_list(rest[0], where) if len(rest) == 1 else rest
    if isinstance(value, Unknown):
        return skip(tcl, cases[1::2], value, where)
    for place in range(0, len(cases) - 1, 2):
        pattern = cases[place]
        glob = "-glob" in options and fnmatch.fnmatchcase(value, pattern)
        if value == pattern or glob or (pattern == "default" and place == len(cases) - 2):
            body = next((b for b in cases[place + 1 :: 2] if b != "-"), "")
            return tcl.run_body(body, where)
    return ""


def _proc(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    name, parameters, body = words
    each = [lists.split_list(one, where) for one in lists.split_list(parameters, where)]
    tcl.procedures[name.removeprefix("::")] = Procedure(each, body)
    return ""


def _global(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    if tcl.variables.here is not tcl.variables.everywhere:
        tcl.variables.shared.update(words)
    return ""


def _variable(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    _global(tcl, words[::2], where)
    for name, value in zip(words[::2], words[1::2], strict=False):
        tcl.variables.set(name, value)
    return ""


def _info(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    if words[0] == "exists":
        return str(int(tcl.variables.exists(words[1])))
    if words[0] == "script":
        return tcl.main
    if words[0] in ("procs", "commands") and len(words) > 1:
        return words[1] if words[1] in tcl.procedures else ""
    return Unknown(f"info {words[0]}")


def _eval(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    for word in words:
        if isinstance(word, Unknown):
            raise InputError(f"a command cannot be known: it is {word.reason}", where, "write it")
    return tcl.run_body(words[0] if len(words) == 1 else " ".join(words), where)


def _catch(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    result = tcl.run_body(words[0], where)
    if len(words) > 1:
        tcl.variables.set(words[1], result)
    return Unknown("whether a command fails") if isinstance(result, Unknown) else "0"


def _namespace(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    return tcl.run_body(words[2], where) if words[0] == "eval" else ""


def _leave(kind: str) -> Builtin:
    def leave(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
        raise LeavingTcl(kind, words[-1] if words else "")

    return leave


def _source(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    if isinstance(words[-1], Unknown):
        raise InputError(
            f"which file the script reads cannot be known: it is {words[-1].reason}",
            where,
            "write its name",
        )
    return tcl.source(words[-1], where)


def _error(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    raise InputError(
        f"the script ends with an error: {' '.join(map(str, words))}", where, "mend it"
    )


def _unset(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
    for name in words:
        tcl.variables.unset(name)
    return ""


def _of_texts(function: Callable[..., Any]) -> Builtin:
    """A command whose result is not known where one of its words is not."""

    def command(tcl: TclInterpreter, words: list[Any], where: str) -> Any:
        for word in words:
            if isinstance(word, Unknown):
                return word
        return function(where, *words)

    return command


def _not_evaluated(name: str) -> Builtin:
    return lambda tcl, words, where: Unknown(f"the result of {name}, which is not evaluated")


BUILTINS: dict[str, Builtin] = {
    "set": _set,
    "expr": _expr,
    "incr": _incr,
    "append": _append,
    "lappend": _lappend,
    "lassign": _lassign,
    "array": _array,
    "if": _if,
    "for": _for,
    "while": lambda tcl, words, where: _loop(tcl, words[0], words[1], "", where),
    "foreach": _foreach,
    "switch": _switch,
    "proc": _proc,
    "global": _global,
    "variable": _variable,
    "unset": _unset,
    "info": _info,
    "eval": _eval,
    "uplevel": _eval,
    "catch": _catch,
    "namespace": _namespace,
    "source": _source,
    "error": _error,
    "break": _leave("break"),
    "continue": _leave("continue"),
    "return": _leave("return"),
    "exit": _leave("exit"),
    "string": _of_texts(strings.string),
    "format": _of_texts(strings.format_text),
    **{name: _of_texts(function) for name, function in lists.COMMANDS.items()},
    **{
        name: _not_evaluated(name)
        for name in ("regexp", "regsub", "scan", "dict", "lset", "lreplace", "lmap", "binary",
                     "subst", "upvar", "encoding", "update", "time")
    },
}  # fmt: skip
