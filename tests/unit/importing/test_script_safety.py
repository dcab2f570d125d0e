"""What a Python script does to its model without being followed is refused by line."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing import ImportRefused, import_model

Written = Callable[[str, str], Path]
PYNITE = """from Pynite import FEModel3D
f = FEModel3D()
f.add_material("Steel", 29000, 11200, 0.3, 2.836e-4)
f.add_section("S", 10, 100, 200, 5)
f.add_node("A", 0, 0, 0)
f.add_node("B", 0, 100, 0)
f.add_node("C", 120, 100, 0)
f.add_member("AB", "A", "B", "Steel", "S")
f.add_member("BC", "B", "C", "Steel", "S")
f.def_support("A", True, True, True, True, True, True)
f.add_node_load("C", "FY", -5)
"""
OPENSEES = """import openseespy.opensees as ops
ops.model("basic", "-ndm", 2, "-ndf", 3)
ops.node(1, 0, 0)
ops.node(2, 4, 0)
ops.fix(1, 1, 1, 1)
ops.geomTransf("Linear", 1)
ops.element("elasticBeamColumn", 1, 1, 2, 0.01, 2e8, 1e-4, 1)
ops.timeSeries("Linear", 1)
ops.pattern("Plain", 1, 1)
ops.load(2, 0, -20, 0)
"""


def sums(path: Path, **options: Any) -> tuple[float, float, float]:
    """The sum of all loads of the one case of a script [N]."""
    found = import_model(path, units=options.pop("units", "kN, m"), **options)
    return next(iter(found.load_sums.values()))


class TestPyniteScriptSafety:
    @pytest.mark.parametrize(
        ("line", "said"),
        [
            ("f.delete_member('BC')", "'delete_member' is no method"),
            ("f.delete_loads()", "'delete_loads' is no method"),
            ("f.merge_duplicate_nodes()", "'merge_duplicate_nodes' is no method"),
            ("f.members['BC'].rotation = 90", "rotation.* of the model is set"),
            ("f.members['BC'].rotation += 90", "rotation.* of the model is set"),
            ("f.members['BC'].Releases[5] = True", "Releases.* of the model is set"),
            ("f.nodes['B'].X = 10", "X.* of the model is set"),
            ("f.load_combos = {}", "load_combos' of the model is set"),
            ("del f.members['BC']", "of the model is deleted"),
            ("f.members.pop('BC')", "'f.members.pop' is a call of a part of the model"),
            ("f.nodes['C'].NodeLoads.append(('FY', -3, 'x'))", "NodeLoads.append.* is a call"),
            ("setattr(f.nodes['A'], 'support_RZ', False)", "'setattr' is given the model"),
            ("import copy; g = copy.deepcopy(f)", "'copy.deepcopy' is given the model"),
            ("from supports import add; add(f)", "'add' is given the model"),
            ("exec('f.delete_loads()')", "'exec' runs code"),
        ],
    )
    def test_what_changes_the_model_otherwise_is_refused_by_line(
        self, written: Written, line: str, said: str
    ) -> None:
        path = written("frame.py", f"{PYNITE}{line}\n")
        with pytest.raises(ImportRefused, match=f"line 12: .*{said}"):
            import_model(path, units="kN, m")
        notes = import_model(path, units="kN, m", accept=["partial"]).notes
        assert any(note.severity == "dropped" and note.where == "line 12" for note in notes)

    @pytest.mark.parametrize(
        "lines",
        [
            "f.analyze(check_statics=True)\nprint(f.nodes['C'].DY['Combo 1'])",
            "f.members['BC'].plot_moment('Mz')\nm = f.members['BC'].max_moment('Mz', 'Combo 1')",
            "from Pynite.Visualization import Renderer\nr = Renderer(f)\nr.scale = 2\nr.render()",
            "rows = []\nfor name, n in f.nodes.items():\n    rows.append(n.RxnFY['Combo 1'])",
            "import pandas as pd\npd.DataFrame(f.members['BC'].moment_array('Mz', 5))",
            "import matplotlib.pyplot as plt\nplt.rcParams['font.size'] = 9\nplt.show()",
        ],
    )
    def test_analysis_and_results_are_harmless(self, written: Written, lines: str) -> None:
        assert sums(written("frame.py", f"{PYNITE}{lines}\n")) == (0, 0, -5000)

    @pytest.mark.parametrize(
        ("line", "said"),
        [
            ("f.add_node('B', 5, 5, 5)", "there is a 'B' in nodes already"),
            ("f.add_member('BC', 'A', 'C', 'Steel', 'S')", "there is a 'BC' in members"),
            ("f.add_section('S', 1, 1, 1, 1)", "there is a 'S' in sections"),
            ("f.add_material('Steel', 1, 1, 0, 0)", "there is a 'Steel' in materials"),
            ("for n in f.nodes.values():\n    n.support_RZ = True", "hangs on|of the model is set"),
        ],
    )
    def test_a_name_twice_is_an_error_as_it_is_of_pynite(
        self, written: Written, line: str, said: str
    ) -> None:
        with pytest.raises(InputError, match=said):
            import_model(written("frame.py", f"{PYNITE}{line}\n"), units="kN, m")

    @pytest.mark.parametrize(
        ("line", "said"),
        [
            ("f.add_member_pt_load('BC', 'Fy', -3, 500)", "at 500 m .* which is 120 m long"),
            ("f.add_member_pt_load('BC', 'Fy', -3, -5)", "at -5 m"),
            ("f.add_member_dist_load('BC', 'Fy', -1, -1, 60, 500)", "at 60 m to 500 m"),
            ("f.add_member_dist_load('BC', 'Fy', -1, -2, 90, 30)", "runs backwards"),
        ],
    )
    def test_a_load_beyond_its_member_is_refused_by_its_own_line(
        self, written: Written, line: str, said: str
    ) -> None:
        with pytest.raises(ImportRefused, match=f"line 12: a load .*{said}"):
            import_model(written("frame.py", f"{PYNITE}{line}\n"), units="kN, m")

    def test_a_load_at_the_very_end_stays(self, written: Written) -> None:
        line = "f.add_member_pt_load('BC', 'Fy', -3, 120 * (1 + 1e-12))"
        assert sums(written("frame.py", f"{PYNITE}{line}\n")) == pytest.approx((0, 0, -8000))

    def test_a_part_without_a_name_has_that_of_pynite(self, written: Written) -> None:
        path = written("frame.py", f"{PYNITE}n = f.add_node(None, 9, 0, 0)\n"
                       "f.add_member(None, 'C', n, 'Steel', 'S')\n")  # fmt: skip
        assert import_model(path, units="kN, m").model.members["M1"].nodes == ("C", "N1")


class TestOpenSeesScriptSafety:
    @pytest.mark.parametrize(
        ("line", "said"),
        [
            ("from supports import add; add(ops)", "'add' is given the model"),
            ("from supports import add; add()", "'add' is code that is not read"),
            ("import supports", "the module 'supports' is not read"),
            ("exec('ops.fix(2, 1, 1, 1)')", "'exec' runs code"),
            ("eval('ops.fix(2, 1, 1, 1)')", "'eval' runs code"),
            ("list(map(lambda n: ops.fix(n, 1, 1, 1), [2]))", "'map' is given"),
            ("import functools; functools.partial(ops.fix, 2)(1, 1, 1)", "partial' is given"),
            ("sorted([2], key=lambda n: ops.fix(n, 1, 1, 1))", "is given what changes the model"),
            ("getattr(ops, input())(2, 1, 1, 1)", "is a call of a part of the model|is given"),
            ("ops.someNewCommand(2)", "does not know the command"),
            ("build_supports()", "'build_supports' is code that is not read"),
        ],
    )
    def test_code_that_is_not_followed_is_refused_by_line(
        self, written: Written, line: str, said: str
    ) -> None:
        with pytest.raises(ImportRefused, match=f"line 11: .*({said})"):
            import_model(written("frame.py", f"{OPENSEES}{line}\n"), units="kN, m")

    def test_a_class_that_changes_the_model_is_refused_where_it_is_called(
        self, written: Written
    ) -> None:
        made = f"{OPENSEES}class A:\n    def __init__(self):\n        ops.fix(2, 1, 1, 1)\n"
        assert import_model(written("frame.py", made), units="kN, m").counts["supports"] == 1
        with pytest.raises(ImportRefused, match="line 14: 'A' is a call of a part of the model"):
            import_model(written("frame.py", f"{made}A()\n"), units="kN, m")

    @pytest.mark.parametrize(
        "lines",
        [
            "import opsvis\nopsvis.plot_model()\nprint(ops.nodeDisp(2, 1))",
            "import matplotlib.pyplot as plt\nplt.plot([ops.nodeDisp(2, 1)])\nplt.show()",
            "import os, time\nt = time.time()\nos.makedirs(os.path.join('a', 'b'))\nops.analyze(1)",
            "import numpy as np\nu = np.array([1.0]) * 2\nops.recorder('Node', '-node', 2)",
            "def report():\n    print(ops.nodeDisp(2, 2))\nreport()",
        ],
    )
    def test_plots_and_output_are_harmless(self, written: Written, lines: str) -> None:
        assert sums(written("frame.py", f"{OPENSEES}{lines}\n")) == (0, 0, -20000)

    @pytest.mark.parametrize(
        ("lines", "total"),
        [
            ("getattr(ops, 'load')(2, 1, 0, 0)", 1000),
            ("import sys\nsys.exit()\nops.load(2, 1, 0, 0)", 0),
            ("def main():\n    ops.load(2, 1, 0, 0)", 0),
            ("k = 1\ndef f():\n    global k\n    k = 3\nf()\nops.load(2, k, 0, 0)", 3000),
            ("a = [5, 7]\ndel a[0]\nops.load(2, a[0], 0, 0)", 7000),
            (
                "import numpy as np\na = np.array([1.0])\nb = a\nb += 1\nops.load(2, a[0], 0, 0)",
                2000,
            ),
        ],
    )
    def test_what_python_does_is_followed(self, written: Written, lines: str, total: float) -> None:
        assert sums(written("frame.py", f"{OPENSEES}{lines}\n")) == (total, 0, -20000)

    @pytest.mark.parametrize("word", ["break", "continue", "return"])
    def test_what_would_leave_before_the_model_changes_is_named(
        self, written: Written, word: str
    ) -> None:
        line = f"            {word}"
        text = (
            f"{OPENSEES}def f():\n    for k in range(3):\n"
            f"        if ops.nodeDisp(2, 1) > 0:\n{line}\n        ops.load(2, 1, 0, 0)\nf()\n"
        )
        with pytest.raises(InputError, match="whether 'load' is done cannot be known"):
            import_model(written("frame.py", text), units="kN, m")
        harmless = text.replace("ops.load(2, 1, 0, 0)", "print(ops.nodeDisp(2, 1))")
        assert sums(written("frame.py", harmless)) == (0, 0, -20000)
        assert sums(written("frame.py", text.replace(line, "            pass"))) == (
            3000, 0, -20000,
        )  # fmt: skip

    def test_a_module_that_is_not_needed_can_be_named(self, written: Written) -> None:
        path = written("frame.py", f"import helpers\n{OPENSEES}")
        assert sums(path, without=["helpers"]) == (0, 0, -20000)

    @pytest.mark.parametrize(
        ("values", "said"),
        [
            ("0.01, 2e8, 0.0", "has no Iz above 0"),
            ("0.01, 2e8, -1e-4", "has no Iz above 0"),
            ("0.0, 2e8, 1e-4", "has no A above 0"),
            ("0.01, 0.0, 1e-4", "has no E above 0"),
        ],
    )
    def test_an_element_without_stiffness_is_refused_by_line(
        self, written: Written, values: str, said: str
    ) -> None:
        text = OPENSEES.replace("0.01, 2e8, 1e-4", values)
        with pytest.raises(ImportRefused, match=f"line 7: element 1 {said}"):
            import_model(written("frame.py", text), units="kN, m")

    def test_a_point_load_beyond_its_element_is_refused_by_line(self, written: Written) -> None:
        line = "ops.eleLoad('-ele', 1, '-type', '-beamPoint', -4.0, {})\n"
        with pytest.raises(ImportRefused, match="line 11: a load at 5 m on member 1"):
            import_model(written("frame.py", OPENSEES + line.format(1.25)), units="kN, m")
        assert sums(written("frame.py", OPENSEES + line.format(0.25))) == (0, 0, -24000)
