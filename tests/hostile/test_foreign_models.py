"""Models of other programs that are spoiled in one to three ways."""

import io
from collections.abc import Callable
from contextlib import suppress
from typing import Any

import numpy as np
import pytest

from hostile.spoiling import damaged, respelled, spoiled
from unit.importing.saf_frame import frame

Given, Judged = Callable[..., Any], Callable[[Any], Any]
#: cases in every run; and cases of a test, and how many tests there are, at full length
FEW, CASES, TESTS = 20, 60, 10
TCL = """model basic -ndm 2 -ndf 2
set k 1.5
proc bar {tag i j} { element truss $tag $i $j 10 1 }
foreach {tag x z} {1 0 0 2 144 0 3 72 96} { node $tag $x $z }
for {set i 1} {$i < 3} {incr i} { fix $i 1 1 }
uniaxialMaterial Elastic 1 [expr {2000 * $k}]
bar 1 1 3
if {$k > 1} { bar 2 2 3 } else { puts "no" }
pattern Plain 1 Linear { load 3 100 -50 }
analyze 1
"""
#: lines that no script needs
TCL_LINES = (
    "while 1 {}", "while 1 {set a 1}", "proc f {} {f}; f", "proc f n {f [expr {$n+1}]}; f 1",
    "set a [string repeat x 1000000000]", "for {set i 0} {1} {incr i} {node $i 0 0}",
    "set a x; while 1 {append a $a}", "set a 1; while 1 {lappend a $a}", "source script.tcl",
    "expr {9**9**9}", "expr {1 << 100000000}", "eval $a", "exec rm", "open out w", "unset k",
    "expr {" + "(" * 5000, "node {*}[lrepeat 100000000 1]", "set a([string repeat { } 9]) 1", "}",
    "[" * 5000, "set x [expr 1/0]", "expr {sqrt(-1)}", "rename node bar", "upvar 1 k k", "return",
)  # fmt: skip
OPENSEES = """import openseespy.opensees as ops
ops.wipe()
ops.model("basic", "-ndm", 2, "-ndf", 3)
span, parts = 4.0, 4
for i in range(parts + 1):
    ops.node(i + 1, span * i / parts, 0)
ops.fix(1, 1, 1, 1)
ops.geomTransf("Linear", 1)
for i in range(parts):
    ops.element("elasticBeamColumn", i + 1, i + 1, i + 2, 0.01, 2e8, 1e-4, 1)
ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
loads = {parts + 1: -20}
for node, value in loads.items():
    ops.load(node, 0, value, 0)
"""
PYNITE = """from Pynite import FEModel3D
f = FEModel3D()
f.add_material("Steel", 29000, 11200, 0.3, 2.836e-4)
f.add_section("S", 10, 100, 200, 5)
for i, x in enumerate([0, 50, 120]):
    f.add_node(f"N{i}", x, 0, 0)
for i in range(2):
    f.add_member(f"M{i}", f"N{i}", f"N{i + 1}", "Steel", "S")
f.def_support("N0", True, True, True, True, True, True)
f.add_node_load("N2", "FY", -5)
"""
PYTHON_LINES = (
    "while True: pass", "a = [0] * 10**12", "a = 'x' * 10**11", "a = 9**9**9", "a = 1 << 10**9",
    "for i in range(10**15): pass", "def f(): return f()", "f()", "import os; os.remove('a')",
    "open('out', 'w')", "exec('a = 1')", "a = [1]; a.append(a)", "raise SystemExit", "x = (" * 200,
    "a = " + "-" * 3000 + "1", "a = " + "[" * 500 + "]" * 500, "lambda: (yield)", "a = 1 / 0",
    "[x for x in range(10**12)]", "'%1000000000d' % 1", "f'{1:1000000000}'", "a = b'\\xff'",
    "import numpy as np; a = np.zeros(10**12)", "del ops", "return", "\tindented = 1", "a: int",
)  # fmt: skip
TABLES = """TABLE:  "PROGRAM CONTROL"
   ProgramName=SAP2000   Version=25.1.0   CurrUnits="KN, m, C"

TABLE:  "JOINT COORDINATES"
   Joint=1   CoordSys=GLOBAL   CoordType=Cartesian   XorR=0   Y=0   Z=0
   Joint=2   CoordSys=GLOBAL   CoordType=Cartesian   XorR=0   Y=0   Z=4
   Joint=3   CoordSys=GLOBAL   CoordType=Cartesian   XorR=3   Y=2   Z=5

TABLE:  "CONNECTIVITY - FRAME"
   Frame=1   JointI=1   JointJ=2   IsCurved=No
   Frame=2   JointI=2   JointJ=3   IsCurved=No

TABLE:  "FRAME SECTION ASSIGNMENTS"
   Frame=1   AutoSelect=N.A.   AnalSect="Post"   MatProp=Default
   Frame=2   AutoSelect=N.A.   AnalSect="Post"   MatProp=Default

TABLE:  "FRAME SECTION PROPERTIES 01 - GENERAL"
   SectionName="Post"   Material=S355   Shape=Channel   Area=0.002   TorsConst=2E-05 _
        I33=1.2E-05   I22=4.7E-06   AS2=0.0012   AS3=0.0009

TABLE:  "MATERIAL PROPERTIES 02 - BASIC MECHANICAL PROPERTIES"
   Material=S355   UnitWeight=77   E1=210000000   G12=80769230.8   U12=0.3   A1=1.2E-05

TABLE:  "JOINT RESTRAINT ASSIGNMENTS"
   Joint=1   U1=Yes   U2=Yes   U3=Yes   R1=Yes   R2=Yes   R3=Yes

TABLE:  "LOAD PATTERN DEFINITIONS"
   LoadPat=WIND   DesignType=Wind   SelfWtMult=0

TABLE:  "JOINT LOADS - FORCE"
   Joint=2   LoadPat=WIND   CoordSys=GLOBAL   F1=3   F2=-1   F3=0   M1=0   M2=0   M3=2

END TABLE DATA
"""
TABLE_LINES = (
    'TABLE:  "JOINT COORDINATES"',
    'TABLE:  "',
    "   Joint=",
    "   =",
    "_",
    "END TABLE DATA",
)
BOOK: dict[str, list[list[Any]]] = {
    "nodes": [["name", "x [m]", "z [m]"], ["A", 0, 0], ["B", 4, 0], ["C", 4, 3]],
    "materials": [["name", "E [GPa]", "nu", "density [kg/m3]"], ["steel", 210, 0.3, 7850]],
    "sections": [["name", "A [cm2]", "Iy [cm4]"], ["beam", 40, 3000], ["rod", 5, None]],
    "members": [
        ["name", "start", "end", "section", "material", "kind"],
        ["AB", "A", "B", "beam", "steel", "frame"],
        ["AC", "A", "C", "rod", "steel", "truss"],
        ["BC", "B", "C", "beam", "steel", None],
    ],
    "supports": [
        ["node", "ux", "uz", "ry"],
        ["A", "fixed", "fixed", None],
        ["B", None, "x", None],
    ],
    "loads": [["case", "node", "member", "fx [kN]", "wz [kN/m]"], ["wind", "C", None, 5, None]],
}
UNITS = ("--units", "kN, m")
BARS = ("--kind", "truss", "--section", "A=10cm2", "--material", "E=210GPa")
#: name, text, lines that may come in between, and options of the command
SCRIPTS: tuple[tuple[str, str, tuple[str, ...], tuple[str, ...]], ...] = (
    ("model.tcl", TCL, TCL_LINES, UNITS),
    ("model.py", OPENSEES, PYTHON_LINES, UNITS),
    ("frame.py", PYNITE, PYTHON_LINES, UNITS),
    ("frame.s2k", TABLES, TABLE_LINES, ()),
    ("drawing.dxf", "", ("0", "LINE", "10", "  0\nLINE\n 10\n1e300"), BARS),
    ("book.xlsx", "", (), ()),
    ("saf.xlsx", "", (), ()),
    ("tables", "", (), ()),
)


def book(sheets: dict[str, Any]) -> bytes:
    """A workbook of sheets, without what no sheet or cell can hold."""
    openpyxl = pytest.importorskip("openpyxl")
    IllegalCharacterError = openpyxl.utils.exceptions.IllegalCharacterError
    made = openpyxl.Workbook()
    for name, rows in sheets.items():
        with suppress(ValueError):
            sheet = made.create_sheet(name)
            for row in rows if isinstance(rows, list) else []:
                cells = row if isinstance(row, list) else [row]
                with suppress(ValueError, OverflowError, IllegalCharacterError):
                    # A number that no cell can hold is found as it is written.
                    [float(one) for one in cells if isinstance(one, int)]
                    sheet.append(cells)
    content = io.BytesIO()
    made.save(content)
    return content.getvalue()


def comma_separated(rows: list[list[Any]]) -> str:
    """Rows as text; no cell of them has a comma."""
    return "\n".join(",".join("" if one is None else str(one) for one in row) for row in rows)


def drawing() -> bytes:
    """A triangle."""
    ezdxf = pytest.importorskip("ezdxf")
    document = ezdxf.new()
    document.header["$INSUNITS"] = 4
    space = document.modelspace()
    space.add_line((0, 0), (1000, 0))
    space.add_lwpolyline([(1000, 0), (500, 1000), (0, 0)])
    content = io.StringIO()
    document.write(content)
    return content.getvalue().encode()


def drawn(number: int) -> tuple[tuple[str, ...], dict[str, bytes]]:
    """The command line of a case, and the file that it is spoiled by."""
    draw = np.random.default_rng(number)
    name, text, lines, options = SCRIPTS[draw.integers(len(SCRIPTS))]
    words = ("import", f"{{}}/{name}", "-o", "{}/out/model.json", *options)
    if name == "tables":
        tables = {f"tables/{sheet}.csv": comma_separated(rows) for sheet, rows in BOOK.items()}
        spoilt = list(tables)[draw.integers(len(tables))]
        text = respelled(tables[spoilt], draw, ("", '"', ",,", "a,b"))
        return words, {
            one: text.encode("utf-8", "surrogatepass") if one == spoilt else whole.encode()
            for one, whole in tables.items()
        }
    if name.endswith(".xlsx"):
        content = book(spoiled(BOOK if name == "book.xlsx" else frame(), draw))
    else:
        given = drawing().decode() if name == "drawing.dxf" else text
        content = respelled(given, draw, lines).encode("utf-8", "surrogatepass")
    if draw.random() < 0.15:
        content = damaged(content, draw)
    return words, {name: content}


def test_some_spoiled_models(judged_all: Callable[..., None]) -> None:
    judged_all(range(FEW), drawn)


@pytest.mark.thorough
@pytest.mark.parametrize("place", range(1, TESTS + 1))
def test_spoiled_models(place: int, judged_all: Callable[..., None]) -> None:
    judged_all(range(CASES * place, CASES * (place + 1)), drawn)


@pytest.mark.parametrize(
    ("name", "text", "line"),
    [
        *(("model.tcl", TCL, line) for line in TCL_LINES),
        *(("model.py", OPENSEES, line) for line in PYTHON_LINES),
        *(("frame.py", PYNITE, line) for line in PYTHON_LINES),
    ],
)
def test_a_line_that_no_script_needs(
    name: str, text: str, line: str, given: Given, judged: Judged
) -> None:
    content = {name: f"{text}{line}\n".encode()}
    came = judged(given(("import", f"{{}}/{name}", "-o", "{}/out/model.json", *UNITS), content))
    assert came.faults == []
