"""Drawings as files and in axes."""

import json
import struct
from collections.abc import Callable
from pathlib import Path
from time import perf_counter
from typing import Any
from xml.etree import ElementTree

import matplotlib
import pytest
from matplotlib.figure import Figure

import rga
from every_kind_bridge import bridge
from rga.building import howe_truss
from rga.drawing.content import asked, gather
from rga.drawing.sheet.sheet import sheet, sheet_bytes
from rga.errors import InputError
from rga.model import Model, model_content, read_model

matplotlib.use("Agg")
#: what a session of the command line left behind
Ran = Callable[..., Any]


def texts(drawing: bytes) -> list[str]:
    """The texts of an SVG file."""
    root = ElementTree.fromstring(drawing)
    return ["".join(one.itertext()) for one in root.iter("{http://www.w3.org/2000/svg}text")]


def written(model: Model, **options: Any) -> list[str]:
    return texts(sheet_bytes(gather(model, asked(options)), "svg"))  # type: ignore[arg-type]


def grid(side: int) -> Model:
    """A plane model of many members."""
    places = [(i, j) for i in range(side) for j in range(side)]
    ends = [
        ((i, j), (i + a, j + b))
        for i, j in places
        for a, b in ((1, 0), (0, 1), (1, 1))
        if i + a < side and j + b < side
    ]
    bar = {"section": "s", "material": "m"}
    name = "{0[0]}.{0[1]}".format
    return read_model(
        {
            "rga_model": 1,
            "name": "grid",
            "plane": "xz",
            "materials": {"m": {"E": 2e11}},
            "sections": {"s": {"A": 1e-3}},
            "nodes": {name(place): [place[0], 0, place[1]] for place in places},
            "members": {f"{k}": {"nodes": [name(a), name(b)], **bar}
                        for k, (a, b) in enumerate(ends)},
            "supports": {"s": {"node": name((0, 0)), "fixed": ["ux", "uz"]}},
        },
        "grid",
    )  # fmt: skip


class TestSheets:
    @pytest.mark.parametrize("options", [{}, {"deformed": True}, {"forces": "N"}, {"dark": True}])
    def test_the_same_model_gives_the_same_bytes(self, options: dict[str, Any]) -> None:
        content = gather(bridge(), asked(options))  # type: ignore[arg-type]
        assert sheet_bytes(content, "svg") == sheet_bytes(content, "svg")

    def test_names_are_those_that_were_asked_for(self, small_bridge: dict[str, Any]) -> None:
        model = read_model(small_bridge, "bridge")
        assert set(model.nodes) <= set(written(model, names="nodes"))
        assert not set(model.nodes) & set(written(model))
        assert {"west", "east"} <= set(written(model, names=["supports", "sensors"]))
        everything = set(written(model, names="all"))
        assert {*model.nodes, *model.members, *model.sensors, *model.supports} <= everything

    def test_it_says_what_colours_and_arrows_mean(self, small_bridge: dict[str, Any]) -> None:
        said = written(read_model(small_bridge, "bridge"))
        assert {"small bridge", "bottom chord", "strain sensor", "displacement sensor"} <= set(said)
        assert any(one.startswith("west: up to 50.0") for one in said)

    def test_a_response_states_its_scale_and_contexts(self, beam: Callable[..., Model]) -> None:
        said = written(beam(), deformed=True, forces="N", contexts={"crane": 5})
        (words,) = [one for one in said if "times as large" in one]
        assert "displacements 5 times as large, largest 22.5" in words
        assert words.endswith("at crane = 5 kN")
        (still,) = [one for one in written(beam(), deformed=True, contexts={"crane": 0})
                    if "nothing moves" in one]  # fmt: skip
        assert still.endswith("at crane = 0 kN")

    def test_of_a_truss_without_bending_no_largest_moment_is_told(
        self, two_bars: dict[str, Any]
    ) -> None:
        model = read_model(two_bars, "two bars")
        for quantity, word in (("V", "shear force V"), ("M", "bending moment M")):
            said = written(model, forces=quantity)
            assert any(one.startswith(word) and "all zero: truss members" in one for one in said)
            assert not {"positive", "negative"} & set(said)

    def test_a_value_stands_beyond_its_peak(self, beam: Callable[..., Model]) -> None:
        """Not beside it, where the moment is smaller."""
        model = beam(
            supports={
                "pin": {"node": "a", "fixed": ["ux", "uz"]},
                "roller": {"node": "b", "fixed": ["uz"]},
            },
            effects={
                "hoist": {"kind": "member_load", "member": "ab", "x": 1.0, "point": [0, 0, -4e3]}
            },
        )
        figure = sheet(gather(model, asked({"forces": "M"})))
        figure.canvas.draw()
        (text,) = [one for one in figure.axes[0].texts if one.get_text() == "\u22122.67"]
        box = text.get_window_extent().transformed(figure.axes[0].transData.inverted())
        assert (box.x0 + box.x1) / 2 == pytest.approx(1.0, abs=0.05)
        assert box.y1 < 0

    def test_names_of_a_crowd_are_left_out_and_counted(self) -> None:
        content = gather(grid(22), asked({"names": ["nodes", "members"]}))
        begun = perf_counter()
        said = texts(sheet_bytes(content, "svg"))
        assert perf_counter() - begun < 10
        assert f"{len(content.scene.nodes) + len(content.scene.members)} names without room" in said

    def test_on_a_phone_members_and_forces_without_room_are_counted(self) -> None:
        truss = howe_truss("roof", 20.0, 2.4, 7, chords="SHS 120x6.3", diagonals="SHS 80x5")
        truss.load_case("snow", down=dict.fromkeys(truss.nodes_in("top chord"), "17 kN"))
        content = gather(truss.build(), asked({"names": "members", "forces": "N"}))
        said = texts(sheet_bytes(content, "svg", 3.75))
        lost = next(one for one in said if one.endswith("without room"))
        values, names = (int(part.split()[0]) for part in lost.split(" and "))
        assert names == len([name for name in content.scene.members if name not in said])
        assert values > 0
        assert not any("without room" in one for one in texts(sheet_bytes(content, "svg")))

    def test_a_name_is_text_whatever_it_holds(self, hostile: Model, tmp_path: Path) -> None:
        drawing = sheet_bytes(gather(hostile, asked({"names": ["nodes", "members"]})), "svg")
        said = texts(drawing)
        assert "$\\frac{1}{2}$" not in said  # the first group alone is a colour
        assert "</script>" in said
        assert any(one.startswith("<img src=x") for one in said)
        assert b"<img" not in drawing
        assert b"<script" not in drawing

    def test_a_narrow_sheet_is_as_narrow(self, small_bridge: dict[str, Any]) -> None:
        content = gather(read_model(small_bridge, "bridge"), asked({"names": "nodes"}))
        assert sheet(content, 3.75).get_figwidth() == 3.75
        assert len(sheet(gather(bridge(), asked({})), 3.75).axes) == 4

    @pytest.mark.parametrize("dark", [False, True])
    def test_a_png_has_the_colour_of_its_paper(
        self, beam: Callable[..., Model], tmp_path: Path, dark: bool
    ) -> None:
        path = rga.draw(beam(), tmp_path / "beam.png", dark=dark)
        image = matplotlib.image.imread(path)
        assert (image[0, 0, :3].mean() < 0.2) == dark
        assert struct.unpack(">I", path.read_bytes()[16:20]) == (1500,)

    def test_every_symbol_is_drawn(self, beam: Callable[..., Model]) -> None:
        """Springs, ties, inclined and sliding supports, moments, member loads, masses."""
        node = {"node": "b", "unit": "kN", "direction": [1, 0, 1]}
        model = beam(
            {"releases": {"j": ["ry", "ux"]}, "end_springs": {"i": {"ry": 1e6}}},
            supports={
                "slide": {"node": "a", "fixed": ["ux", "ry"]},
                "inclined": {"node": "b", "along": [1, 0, 1]},
            },
            springs=[
                {"node": "b", "dof": "uz", "stiffness": 1e6},
                {"node": "b", "dof": "ry", "stiffness": 1e6},
                {"node": "a", "to": "b", "dof": "ux", "stiffness": 1e6},
            ],
            ties=[{"nodes": ["a", "b"], "dofs": ["uy"]}],
            masses={"top": {"node": "b", "mass": 40}},
            effects={
                "moment": {"kind": "nodal_load", "forces": {"b": [0, 0, 0, 0, 5, 0]}},
                "snow": {"kind": "member_load", "member": "ab", "uniform": [0, 0, -5]},
            },
            sensors={
                "R": {**node, "kind": "reaction"},
                "F": {"kind": "force", "member": "ab", "unit": "kN"},
                "T": {"kind": "rotation", "node": "b", "direction": [0, 1, 0], "unit": "mrad"},
            },
        )
        said = written(model, local_axes=True, names=["sensors"])
        assert {"R", "F", "T", "reaction sensor", "force sensor", "rotation sensor"} <= set(said)
        assert "mass" in said
        assert {"x", "z", "moment: up to 5.00\u00a0N m", "snow: up to 5.00\u00a0N/m"} <= set(said)


class TestAxes:
    def test_it_draws_into_the_axes_given(self, small_bridge: dict[str, Any]) -> None:
        axes = Figure(figsize=(6, 3)).subplots()
        drawn = read_model(small_bridge, "bridge").plot(axes, names="nodes")
        assert drawn is axes
        left, right = axes.get_xlim()
        assert left < 0
        assert right > 12
        assert {"L0", "U3"} <= {text.get_text() for text in axes.texts}

    def test_a_view_is_chosen_by_its_title(self) -> None:
        from matplotlib import pyplot

        axes = bridge().plot(view="plan")
        assert pyplot.gcf() is axes.figure
        assert pyplot.gcf().get_figwidth() == 9.0
        with pytest.raises(InputError, match=r"no view 'inside'.*'axonometry'"):
            bridge().plot(view="inside")
        pyplot.close("all")


class TestCommand:
    def test_it_draws_what_is_asked_for(self, rga: Ran, model_file: Path, tmp_path: Path) -> None:
        path = tmp_path / "new" / "bars.svg"
        ran = rga("draw", model_file, "-o", path, "--names", "all", "--deformed", "--contexts",
                  "load=3, temperature=20", "--width", "6")  # fmt: skip
        assert (ran.code, ran.err) == (0, "")
        assert str(path) in ran.out
        assert any("load = 3 N" in one for one in texts(path.read_bytes()))

    @pytest.mark.parametrize(
        ("options", "said"),
        [
            (["--load", "wind"], "there is no load 'wind'"),
            (["--contexts", "wind=3"], "no context variable 'wind'"),
            (["--contexts", "load"], "'load' sets no number"),
            (["--contexts", "load=nan"], "load = nan is no number"),
            (["--width", "nan"], "cannot be nan inches wide"),
            (["--deformed", "--scale", "-2"], "cannot be enlarged by -2"),
            (["-o", "drawing.pdf"], "'.pdf' is no format"),
            (["-o", "/proc/none/drawing.svg"], "the output cannot be written"),
        ],
    )
    def test_what_cannot_be_drawn_is_told(
        self, rga: Ran, model_file: Path, tmp_path: Path, options: list[str], said: str
    ) -> None:
        given = options if "-o" in options else [*options, "-o", str(tmp_path / "drawing.svg")]
        ran = rga("draw", model_file, *given)
        assert (ran.code, ran.out) == (2, "")
        assert said in ran.err
        assert ran.err.count("\n") == 1
        assert not (tmp_path / "drawing.svg").exists()

    def test_a_mechanism_is_drawn_but_does_not_deform(
        self, rga: Ran, beam: Callable[..., Model], tmp_path: Path
    ) -> None:
        loose = beam(supports={"pin": {"node": "a", "fixed": ["ux", "uz"]}})
        model = tmp_path / "loose.json"
        model.write_text(json.dumps(model_content(loose)), encoding="utf-8")
        page = tmp_path / "loose.html"
        assert rga("draw", model, "-o", page).code == 0
        assert "can move" in page.read_text(encoding="utf-8")
        ran = rga("draw", model, "-o", tmp_path / "more.html", "--deformed")
        assert ran.code == 2
        assert "the structure can move" in ran.err
        assert not (tmp_path / "more.html").exists()
