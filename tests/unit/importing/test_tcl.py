"""Tcl is evaluated as Tcl does, within bounds, and touches nothing."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing.opensees.tcl import TclInterpreter
from rga.importing.scripts.values import Unknown

Written = Callable[[str, str], Path]


class Listener:
    """A host that notes the command `node` and passes over the rest."""

    def __init__(self) -> None:
        self.taken: list[list[Any]] = []

    def skips(self, name: str) -> bool:
        return name in ("analyze", "puts", "open", "exec")

    def shapes(self, name: str) -> bool:
        return name == "node"

    def pass_over(self, name: str, words: str, where: str) -> Any:
        return Unknown(f"the result of {name}")

    def take(self, name: str, values: list[Any], where: str) -> tuple[bool, Any]:
        self.taken.append(values)
        return name == "node", ""


def evaluated(text: str, folder: Path = Path()) -> list[list[Any]]:
    """Words of every `node` of a script."""
    host = Listener()
    interpreter = TclInterpreter(host, folder)
    interpreter.main = "script.tcl"
    interpreter.run(text, 1, "script.tcl")
    return host.taken


class TestTclExpressions:
    @pytest.mark.parametrize(
        ("expression", "value"),
        [
            ("1/4", "0"),
            ("-1/4", "-1"),
            ("1./4", "0.25"),
            ("2**3**2", "512"),
            ("-2**2", "4"),
            ("7 % 3 == 1 && !(2 > 3)", "1"),
            ("1 ? 2 : 3", "2"),
            ("pow(2,3) + sqrt(16)", "12.0"),
            ("int(3.7) + round(2.5)", "6"),
            ("1e3 + 1.5e-1", "1000.15"),
            ("0x10", "16"),
            ('"a" eq "a"', "1"),
            ("max(1,2,3)", "3"),
        ],
    )
    def test_they_have_the_value_that_tcl_gives(self, expression: str, value: str) -> None:
        assert evaluated(f"node [expr {{{expression}}}]") == [[value]]
        if '"' not in expression:
            assert evaluated(f"node [expr {expression}]") == [[value]]

    @pytest.mark.parametrize(
        "expression", ["1/0", "sqrt(-1)", "1 +", "(1", "foo(1)", "9**99", "08"]
    )
    def test_what_has_no_value_is_one_error(self, expression: str) -> None:
        with pytest.raises(InputError, match="line 2"):
            evaluated(f"set a 1\nnode [expr {expression}]")


class TestTclCommands:
    def test_variables_arrays_lists_and_procedures(self) -> None:
        text = """
        # a comment \\
          that goes on
        proc half {x {by 2.0}} { global k; return [expr $x/$by*$k] }
        set k 1; array set A {b 4 c "5 6"}
        foreach {i j} {1 2 3 4} name {x y} { node $i $j $name }
        for {set i 0} {$i < 3} {incr i} { if {$i == 1} continue; node ${i}a }
        while {$k < 3} { incr k }
        switch $k { 3 { node three } default { node other } }
        node [half $A(b)] [lindex $A(c) end] [llength {a {b c}}] "$k-$k" \\
            [string map {x y} axa] {*}[list p q]; node [format %05.2f 3.14159]
        """
        assert evaluated(text) == [
            ["1", "2", "x"],
            ["3", "4", "y"],
            ["0a"],
            ["2a"],
            ["three"],
            ["6.0", "6", "2", "3-3", "aya", "p", "q"],
            ["03.14"],
        ]

    def test_what_analysis_gives_is_not_known_and_spreads(self) -> None:
        (values,) = evaluated("set a [analyze 3]; set b [expr $a + 1]; node $b")
        assert values[0].reason == "the result of analyze"

    def test_branches_on_what_is_not_known_are_passed_over(self) -> None:
        (values,) = evaluated("set z 1\nif {[analyze 1] != 0} { set z 2 } else { puts x }\nnode $z")
        assert isinstance(values[0], Unknown)

    def test_branches_that_would_build_are_refused(self) -> None:
        with pytest.raises(InputError, match="'node' is done cannot be known"):
            evaluated("proc add {} { node 3 }\nif {[analyze 1]} { add }")


class TestTclBounds:
    @pytest.mark.parametrize(
        ("text", "said"),
        [
            ("while {1} {}", "steps"),
            ("proc f {} { f }; f", "too often"),
            ("set a x; while {1} { append a $a }", "beyond bounds"),
            ("string repeat abc 99999999", "beyond bounds"),
            ("set i 1; while {1} { set i [expr $i*10] }", "beyond bounds"),
            ("node {a", "not closed"),
            ("node [a", "not closed"),
            ('node "a', "not closed"),
        ],
    )
    def test_a_script_without_end_is_one_error(self, text: str, said: str) -> None:
        with pytest.raises(InputError, match=said):
            evaluated(text)

    def test_only_files_of_the_folder_are_read(self, written: Written) -> None:
        script = written("units.tcl", "set ft 12.")
        assert evaluated("source units.tcl; node $ft", script.parent) == [["12."]]
        for name in ("../units.tcl", "/etc/hostname", "missing.tcl"):
            with pytest.raises(InputError, match=r"beside it|outside its folder"):
                evaluated(f"source {name}", script.parent)

    def test_no_file_is_made(self, tmp_path: Path) -> None:
        evaluated("exec touch made; set f [open made w]; node 1", tmp_path)
        assert list(tmp_path.iterdir()) == []
