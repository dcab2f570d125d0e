"""The page that shows a model from all sides; its script runs where node is installed."""

import json
import re
import shutil
import subprocess
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

import rga
from every_kind_bridge import bridge
from rga.model import Model, read_model

STUB = Path(__file__).with_name("page_stub.js")
NODE = shutil.which("node")


def data_of(page: str) -> Any:
    """The model that a page holds."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def shown(model: Model, tmp_path: Path, *actions: list[Any], **options: Any) -> Any:
    """What the script of a page draws after some actions."""
    if NODE is None:
        pytest.skip("node is not installed")
    path = rga.draw(model, tmp_path / "page.html", **options)
    ran = subprocess.run(
        [NODE, STUB, path, json.dumps(actions)], capture_output=True, text=True, timeout=60
    )
    assert ran.returncode == 0, ran.stderr
    return json.loads(ran.stdout)


def words(drawn: Any) -> set[str]:
    return {one["text"] for one in drawn["drawn"] if one["kind"] == "text"}


def colours(drawn: Any) -> set[str]:
    return {one["colour"] for one in drawn["drawn"]}


class TestPage:
    def test_it_is_whole_by_itself(self, tmp_path: Path) -> None:
        page = rga.draw(bridge(), tmp_path / "page.html").read_text(encoding="utf-8")
        assert not re.search(r"https?://|src=|href=|@import|fetch\(|XMLHttpRequest", page)
        assert len(page) < 100_000

    def test_no_name_leaves_its_place(self, hostile: Model, tmp_path: Path) -> None:
        page = rga.draw(hostile, tmp_path / "page.html").read_text(encoding="utf-8")
        assert page.count("<script") == 2
        assert page.count("</script") == 2
        assert "<img" not in page
        assert data_of(page)["members"]["names"] == list(hostile.members)

    def test_its_data_are_those_of_the_model(self, tmp_path: Path) -> None:
        model = bridge()
        data = data_of(rga.draw(model, tmp_path / "page.html").read_text(encoding="utf-8"))
        assert data["nodes"] == list(model.nodes)
        assert data["points"][1] == list(model.nodes["bs"])
        assert [one["name"] for one in data["sensors"]] == list(model.sensors)
        assert data["supports"][0]["words"] == "held along x, y, z"
        assert data["normal"] is None
        assert len(data["response"]["deformed"]["curves"]) == len(model.members)


class TestScript:
    def test_it_draws_the_model_and_what_was_asked_for(
        self, small_bridge: dict[str, Any], tmp_path: Path
    ) -> None:
        model = read_model(small_bridge, "bridge")
        drawn = shown(model, tmp_path, names="nodes")
        assert set(model.nodes) <= words(drawn)
        assert {"#0072b2", "#cf222e"} <= colours(drawn)
        assert drawn["state"] == ""

    def test_switches_show_and_hide(self, small_bridge: dict[str, Any], tmp_path: Path) -> None:
        model = read_model(small_bridge, "bridge")
        drawn = shown(model, tmp_path, ["switch", "deformed shape"], ["switch", "N"],
                      ["switch", "dark"])  # fmt: skip
        assert "times as large" in drawn["state"]
        assert "#ff9f45" in colours(drawn)
        assert "#0072b2" not in colours(drawn)
        without = shown(model, tmp_path, ["switch", "bottom chord"])
        assert "#0072b2" not in colours(without)

    def test_values_stay_on_the_canvas(self, beam: Callable[..., Model], tmp_path: Path) -> None:
        """The moment of a column at the edge reaches to the edge, its value to the other side."""
        own = {"section": "s", "material": "m", "kind": "frame"}
        push = {"kind": "nodal_load", "forces": {"c": [-1234, 0, 0]}}
        model = beam(
            nodes={"a": [0, 0, 0], "b": [9, 0, 0], "c": [9, 0, 3]},
            members={"ab": {"nodes": ["a", "b"], **own}, "bc": {"nodes": ["b", "c"], **own}},
            supports={node: {"node": node, "fixed": ["ux", "uz", "ry"]} for node in "ab"},
            effects={"push": push},
        )
        drawn = shown(model, tmp_path, forces="M")["drawn"]
        (value,) = (one for one in drawn if one["kind"] == "text" and one["text"].endswith("3.7"))
        ((x, _),) = value["parts"][0]
        reached = max(at[0] for one in drawn[1:] if one["kind"] == "area" for at in one["parts"][0])
        assert reached > 880
        assert x + 6.4 * len(value["text"]) <= 900

    def test_what_is_under_the_mouse_is_named(
        self, beam: Callable[..., Model], tmp_path: Path
    ) -> None:
        model = beam()
        line = next(one for one in shown(model, tmp_path)["drawn"]
                    if one["kind"] == "line" and one["width"] > 3)  # fmt: skip
        (first, last) = line["parts"][0]
        middle = [(a + b) / 2 for a, b in zip(first, last, strict=True)]
        told = shown(model, tmp_path, ["hover", *middle])["tip"]
        assert told.startswith("member ab\nframe, 3.00\u00a0m")
        # At mid-range 5 kN at the tip.
        assert "V = 5 kN\nM = " in told.replace("\N{MINUS SIGN}", "")
        assert "15 kN m" in told
        assert "node b" in shown(model, tmp_path, ["hover", *last])["tip"]
        assert shown(model, tmp_path, ["hover", 5, 5])["tip"] == ""

    def test_it_turns_and_comes_back(self, tmp_path: Path) -> None:
        first, turned, back = (
            shown(bridge(), tmp_path, *actions)["drawn"]
            for actions in ([], [["drag", 80, 30]], [["drag", 80, 30], ["dblclick"]])
        )
        # The first of all is the paper.
        assert first[1:] != turned[1:]
        assert first[1:] == back[1:]

    def test_keys_wheel_and_buttons_move_the_view(self, tmp_path: Path) -> None:
        views = [
            json.dumps(shown(bridge(), tmp_path, *actions)["drawn"])
            for actions in (
                [],
                [["keydown", {"key": "ArrowLeft"}]],
                [["keydown", {"key": "+"}]],
                [["wheel", {"deltaY": -100}]],
                [["press", "from above"]],
            )
        ]
        assert len(set(views)) == len(views)

    def test_a_structure_that_can_move_is_drawn_all_the_same(
        self, beam: Callable[..., Model], tmp_path: Path
    ) -> None:
        loose = beam(supports={"pin": {"node": "a", "fixed": ["ux", "uz"]}})
        drawn = shown(loose, tmp_path)
        assert "deformed shape" not in drawn["panel"]
        assert len(drawn["drawn"]) > 5

    def test_strange_names_are_drawn_as_text(self, hostile: Model, tmp_path: Path) -> None:
        drawn = shown(hostile, tmp_path, names=["nodes", "members"])
        assert {"<b>", "<img src=x onerror=alert(\u2026"} & words(drawn)
        assert "</script>" in drawn["panel"]
