"""Every check of a model: a case in which it speaks, and its twin in which it is silent."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.checking import CheckResult, check

Content = dict[str, Any]
Change = Callable[[Content], object]


def joined(*changes: Change) -> Change:
    return lambda content: [change(content) for change in changes]


def put(*path: str, **keys: Any) -> Change:
    """Sets keys of the table at a path."""

    def change(content: Content) -> None:
        for key in path:
            content = content[key]
        content.update(keys)

    return change


def drop(table: str, name: str) -> Change:
    return lambda content: content[table].pop(name)


def bar(one: str, other: str, **more: Any) -> Content:
    groups = {"groups": ["rods"]}
    return {"nodes": [one, other], "section": "rod", "material": "steel", **groups, **more}


def scaled(factor: float) -> Change:
    def change(content: Content) -> None:
        for node, place in content["nodes"].items():
            content["nodes"][node] = [factor * one for one in place]

    return change


def renamed_unit(context: str, unit: str, **keys: Any) -> Change:
    return put("context", context, unit=unit, **keys)


GAUGE = {"kind": "strain", "unit": "microstrain", "noise": 0.5}
#: case -> change, severity, parts of the finding
SAID: dict[str, tuple[Change, str, list[str]]] = {
    "a column that leans": (
        joined(put("supports", "west", fixed=["uz"]), put("supports", "east", fixed=["uz"])),
        "error",
        ["nothing resists a motion", "in ux"],
    ),
    "no supports": (
        put(supports={}),
        "error",
        ["nothing holds it", "3 ways", "nodes 'A', 'B', 'C', 'D', 'E'"],
    ),
    "a part by itself": (
        joined(
            put("nodes", X=[9, 0, 0], Y=[9, 0, 3]), put("members", far=bar("X", "Y"))
        ),
        "error",
        ["nothing holds it", "'X', 'Y'"],
    ),
    "a part by itself that stands": (
        joined(
            put("nodes", X=[9, 0, 0], Y=[9, 0, 3]),
            put("members", far=bar("X", "Y")),
            put("supports", far={"node": "X", "fixed": ["ux", "uz"]}),
            put("supports", top={"node": "Y", "fixed": ["ux"]}),
        ),
        "note",
        ["no member joins it to the rest", "'X', 'Y'"],
    ),
    "a node by itself": (put("nodes", X=[9, 0, 0]), "error", ["node 'X'", "joins it"]),
    "a name of nothing": (
        put("effects", pull={"kind": "nodal_load", "forces": {"X": [0, 0, -1]}}),
        "error",
        ["effects.pull: there is no 'X' in nodes", "portal.json"],
    ),
    "a moment on a hinge": (
        joined(
            put("nodes", X=[3, 0, 6]),
            put("members", a=bar("B", "X"), b=bar("D", "X")),
            put("effects", turn={"kind": "nodal_load", "forces": {"X": [0, 0, 0, 0, 5, 0]}}),
        ),
        "error",
        ["ry"],
    ),
    "E in GPa": (put("materials", "steel", E=210), "warning", ["E is 210 Pa", "GPa", "2.1e+11"]),
    "E in MPa": (put("materials", "steel", E=210000), "warning", ["N/mm2", "2.1e+11"]),
    "density in t/m3": (put("materials", "steel", density=7.85), "warning", ["t/m3", "7850"]),
    "alpha in 1e-6": (put("materials", "steel", alpha=12), "warning", ["alpha is 12", "1.2e-05"]),
    "yield in MPa": (put("materials", "steel", yield_strength=235), "warning", ["2.35e+08"]),
    "a negative nu": (put("materials", "steel", nu=-0.3), "warning", ["nu is -0.3"]),
    "A in cm2": (put("sections", "rod", A=31), "warning", ["A is 31 m2", "cm2", "0.0031"]),
    "A in mm2": (put("sections", "I", A=7800), "warning", ["A is 7800 m2", "mm2", "0.0078"]),
    "A of a thread": (put("sections", "rod", A=1e-12), "warning", ["a thread"]),
    "Iy in cm4": (put("sections", "I", Iy=5700), "warning", ["Iy is 5700", "cm4", "5.7e-05"]),
    "Iy of nothing": (put("sections", "I", Iy=5e-10), "warning", ["thinnest plate"]),
    "Iy hollow beyond any": (put("sections", "I", Iy=0.01), "warning", ["which no section of A"]),
    "J beyond Iy + Iz": (put("sections", "I", J=6), "warning", ["J is 6", "more than Iy + Iz"]),
    "Asz beyond A": (put("sections", "I", Asz=0.01), "warning", ["shear area Asz"]),
    "fibres in mm": (put("sections", "I", fibres={"top": [0, 100]}), "warning", ["fibre 'top'"]),
    "coordinates in mm": (scaled(1000), "warning", ["4e+03 m long", "in mm", "0.001"]),
    "coordinates in km": (scaled(1e-3), "warning", ["0.004 m long", "give coordinates in m"]),
    "Iy is left out": (put("sections", "I", Iy=0), "warning", ["Iy is 0", "do not resist"]),
    "one rod of wood": (
        joined(
            put("materials", wax={"E": 1e6, "alpha": 1e-5}),
            put("members", soft=bar("B", "D", material="wax"), rod=bar("A", "C")),
            put("sections", "rod", A=1e-7),
        ),
        "warning",
        ["a factor of", "'soft'"],
    ),
    "a thread of a beam": (
        put("sections", "rod", Iy=1e-11, Iz=1e-11),
        "note",
        ["length over radius of gyration is"],
    ),
    "a support of nothing": (
        put("supports", mid={"node": "C"}),
        "warning",
        ["support 'mid'", "fixes nothing"],
    ),
    "a support of the plane": (
        put("supports", mid={"node": "C", "fixed": ["uy"]}),
        "warning",
        ["which the plane xz holds"],
    ),
    "a support twice": (
        put("supports", again={"node": "E", "fixed": ["uz"]}),
        "note",
        ["uz of node 'E'", "already"],
    ),
    "a turn of a bar": (
        joined(
            put("nodes", X=[3, 0, 6]),
            put("members", a=bar("B", "X"), b=bar("D", "X")),
            put("supports", tip={"node": "X", "fixed": ["ry"]}),
        ),
        "warning",
        ["rotations alone"],
    ),
    "a spring on a support": (
        put(springs=[{"node": "E", "dof": "uz", "stiffness": 1e7}]),
        "warning",
        ["the spring does nothing"],
    ),
    "nodes at one place": (
        joined(put("nodes", C2=[3, 0, 4]), put("members", rod=bar("A", "C"), r2=bar("E", "C2"))),
        "warning",
        ["nodes 'C', 'C2'", "at one place"],
    ),
    "a member twice": (put("members", again=bar("C", "A")), "warning", ["join the same nodes"]),
    "a node on a member": (
        put("members", tie=bar("B", "D")),
        "warning",
        ["node 'C' stands on it", "'tie'"],
    ),
    "a crossing": (
        put("members", one=bar("A", "D"), other=bar("B", "E")),
        "note",
        ["cross without a joint", "'one' and 'other'"],
    ),
    "a temperature in kN": (
        renamed_unit("air", "kN"),
        "warning",
        ["is a force [kN] and drives a temperature [K]"],
    ),
    "a temperature in degF": (renamed_unit("air", "degF"), "warning", ['"times": 0.555556']),
    "a temperature in K": (renamed_unit("air", "K"), "warning", ["looks like degrees Celsius"]),
    "kelvin as degC": (
        joined(renamed_unit("air", "degC", range=[250, 310])),
        "warning",
        ["looks like kelvin"],
    ),
    "a position in mm": (renamed_unit("cart", "mm"), "warning", ["counted in m", '"times": 0.001']),
    "an unknown unit": (renamed_unit("wind", "bft"), "note", ["'bft' is not known"]),
    "a load of nothing": (
        put("effects", "wind", forces={"B": [0, 0, 0]}),
        "warning",
        ["effect 'wind'", "no force"],
    ),
    "a factor of nothing": (put("effects", "wind", factor=0.0), "warning", ["factor is 0"]),
    "a load on supports": (
        put("effects", "wind", forces={"A": [1000, 0, 0]}),
        "warning",
        ["all its forces act on directions"],
    ),
    "no load": (
        put(effects={}, context={}),
        "note",
        ["no load or temperature acts"],
    ),
    "axles by lever": (
        put("effects", "cart", carried_by="nodes"),
        "note",
        ["frame members join 2 of 2 pairs", "carried_by"],
    ),
    "axles beside the path": (
        put("context", "cart", range=[10, 20]),
        "warning",
        ["no axle is ever on it"],
    ),
    "a cold rod": (
        joined(put("effects", "warmth", groups={"frame": 1.0})),
        "note",
        ["member 'rod'", "warms it"],
    ),
    "no alpha": (put("materials", "steel", alpha=0.0), "warning", ["alpha is 0"]),
    "hundreds of kelvin": (
        put("effects", "warmth", delta={"context": "air", "minus": -273.15}),
        "warning",
        ["by up to 313 K"],
    ),
    "a sensor at a support": (
        put("sensors", U={"kind": "displacement", "node": "A", "direction": [1, 0, 0],
                          "unit": "mm", "noise": 0.02}),
        "warning",
        ["sensor 'U'", "no context moves it"],
    ),
    "a sensor of much noise": (put("sensors", "U", noise=1e4), "note", ["less than its noise"]),
    "a context that no sensor sees": (
        put("effects", "wind", forces={"B": [0.1, 0, 0]}),
        "warning",
        ["context 'wind'", "moves no sensor"],
    ),
    "no sensors": (put(sensors={}), "note", ["no sensor"]),
    "a gauge in mm": (
        put("sensors", "S", z=100),
        "warning",
        ["sensor 'S'", "lies 100 m from the axis"],
    ),
    "a gauge beyond the fibres": (put("sensors", "S", z=0.13), "warning", ["beyond the fibres"]),
    "a gauge on a rod": (put("sensors", "rod", z=0.01), "note", ["same strain at every fibre"]),
    "far too much load": (
        put("effects", "wind", forces={"B": [1e5, 0, 0]}),
        "warning",
        ["it moves by", "of the size of the structure"],
    ),
    "beyond yield": (
        put("effects", "wind", forces={"B": [1e4, 0, 0]}, factor={"context": "wind", "times": 1.5}),
        "warning",
        ["times the yield strength", "at fibre"],
    ),
    "beyond elastic": (
        put("effects", "wind", forces={"B": [1e7, 0, 0]}),
        "warning",
        ["is strained by"],
    ),
    "an unused section": (put("sections", old={"A": 0.01}), "note", ["section 'old'"]),
    "an unused material": (put("materials", wood={"E": 1e10}), "note", ["material 'wood'"]),
    "an unused context": (
        put("context", snow={"unit": "kN/m2", "range": [0, 1]}),
        "note",
        ["context 'snow'", "drives no effect"],
    ),
    "an unused group": (
        put("members", "rod", groups=["rods", "west side"]),
        "note",
        ["group 'west side'"],
    ),
}  # fmt: skip


@pytest.fixture
def checked(portal: Content, tmp_path: Path) -> Callable[[Change], CheckResult]:
    """What is said of the file of the changed portal."""

    def found(change: Change) -> CheckResult:
        change(portal)
        path = tmp_path / "portal.json"
        path.write_text(json.dumps(portal), encoding="utf-8")
        return check(path)

    return found


def test_nothing_is_said_of_a_sound_model(checked: Callable[[Change], CheckResult]) -> None:
    assert checked(lambda content: None).findings == ()


@pytest.mark.parametrize("case", SAID)
def test_a_finding(case: str, checked: Callable[[Change], CheckResult]) -> None:
    change, severity, expected = SAID[case]
    found = checked(change)
    said = [one for one in found.findings if all(part in str(one) for part in expected)]
    assert said, str(found)
    assert said[0].severity == severity
    assert said[0].where
    assert said[0].remedy
    assert found.ok == all(one.severity != "error" for one in found.findings)


#: near a finding, and none
SILENT: dict[str, Change] = {
    "aluminium": put("materials", "steel", E=7e10, density=2700, alpha=2.3e-5, nu=0.33),
    "concrete": put("materials", "steel", E=3e10, density=2500, alpha=1e-5, nu=0.2),
    "timber": joined(
        put("materials", "steel", E=1e10, density=450, alpha=5e-6, yield_strength=None),
        put("sections", "I", A=0.09, Iy=6.75e-4, Iz=6.75e-4, J=1e-3, fibres={}),
    ),
    "a big box of concrete": joined(
        put("sections", "I", A=0.8, Iy=0.2, Iz=0.2, J=0.2, fibres={}),
        put("effects", "wind", forces={"B": [1e5, 0, 0]}),
        put("effects", "cart", forces=[8e5, 8e5]),
    ),
    "a strand": put("sections", "rod", A=4e-5),
    "a turned section": put("sections", "I", Iy=2e-5, Iz=5.7e-5),
    "nodes at one place that are tied": joined(
        put("nodes", C2=[3, 0, 4]),
        put("members", rod=bar("A", "C"), r2=bar("E", "C2")),
        put(ties=[{"nodes": ["C", "C2"], "dofs": ["ux", "uz"]}]),
    ),
    "a crossing with a joint": joined(
        put("nodes", X=[3, 0, 2]),
        drop("members", "rod"),
        drop("sensors", "rod"),
        put("members", a=bar("A", "X"), b=bar("X", "D"), c=bar("B", "X"), d=bar("X", "E")),
    ),
    "a diagonal from corner to corner": put("members", rod=bar("A", "D")),
    "kelvin": joined(
        renamed_unit("air", "K", range=[253, 313]),
        put("effects", "warmth", delta={"context": "air", "minus": 283.0}),
    ),
    "degrees Fahrenheit": joined(
        renamed_unit("air", "degF", range=[0, 100]),
        put("effects", "warmth", delta={"context": "air", "minus": 50.0, "times": 0.555556}),
    ),
    "a position in mm": joined(
        renamed_unit("cart", "mm", range=[-1000, 7000]),
        put("effects", "cart", position={"context": "cart", "times": 0.001}),
    ),
    "a load at a support and beside it": put(
        "effects", "wind", forces={"A": [1000, 0, 0], "B": [1000, 0, 0]}
    ),
    "a spring beside the support": put(springs=[{"node": "E", "dof": "ry", "stiffness": 1e7}]),
    "a part that a spring holds": joined(
        put("nodes", X=[9, 0, 0]),
        put("members", prop=bar("D", "X")),
        put(springs=[{"node": "X", "dof": one, "stiffness": 1e7} for one in ("ux", "uz")]),
    ),
    "a roof of two bars": joined(
        put("nodes", X=[3, 0, 6]), put("members", a=bar("B", "X"), b=bar("D", "X"))
    ),
    "a hinge": put("members", "beam 1", releases={"i": ["ry"]}),
    "an elastic joint": put("members", "beam 1", end_springs={"i": {"ry": 1e6}}),
}


@pytest.mark.parametrize("case", SILENT)
def test_no_finding(case: str, checked: Callable[[Change], CheckResult]) -> None:
    assert str(checked(SILENT[case])) == "Nothing looks wrong."


def test_all_findings_come_at_once(checked: Callable[[Change], CheckResult]) -> None:
    cases = ["a node by itself", "E in GPa", "density in t/m3", "a support of nothing"]
    cases += ["a load of nothing", "an unused section", "a member twice"]
    found = checked(joined(*(SAID[case][0] for case in cases)))
    for case in cases:
        _, severity, expected = SAID[case]
        assert any(
            one.severity == severity and all(part in str(one) for part in expected)
            for one in found.findings
        )
    order = [("error", "warning", "note").index(one.severity) for one in found.findings]
    assert order == sorted(order)


def test_what_cannot_be_read_is_a_list_of_findings(tmp_path: Path) -> None:
    for name, content in {"none.json": None, "broken.json": "{", "list.json": "[]"}.items():
        if content is not None:
            (tmp_path / name).write_text(content, encoding="utf-8")
        found = check(tmp_path / name)
        assert [one.severity for one in found.findings] == ["error"]
        assert name in found.findings[0].where
    empty = check(tmp_path / "none.json", tmp_path / "none.csv")
    assert not empty.ok
