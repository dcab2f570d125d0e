"""Results without a time, row by row, drawn and in notebooks."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import rga
from rga.model import Model, read_model
from rga.model.io import write_model
from rga.simulation import results
from rga.simulation.whatif import whatif

LATE = {"kind": "member_stiffness", "member": "AB", "factor": 0.5, "onset": "2026-03-01T00:00:00"}


def hanger(**effects: Any) -> Model:
    """A bar that hangs, pulled by a context; `size` is the force in kN."""
    pull = {"kind": "nodal_load", "forces": {"B": [0, 0, -1e3]}, "factor": {"context": "size"}}
    return read_model(
        {
            "rga_model": 1,
            "name": "hanger",
            "plane": "xz",
            "materials": {"steel": {"E": 2e11, "yield_strength": 2e8}},
            "sections": {"rod": {"A": 1e-4}},
            "nodes": {"A": [0, 0, 0], "B": [0, 0, -2]},
            "members": {"AB": {"nodes": ["A", "B"], "section": "rod", "material": "steel"}},
            "supports": {"up": {"node": "A", "fixed": ["ux", "uz"]},
                         "guide": {"node": "B", "fixed": ["ux"]}},
            "context": {"size": {"unit": "kN", "range": [0, 10]}},
            "effects": {"pull": pull, **effects},
            "sensors": {"D": {"kind": "displacement", "node": "B", "direction": [0, 0, 1],
                              "unit": "mm", "noise": 0.01}},
        },
        "hanger",
    )  # fmt: skip


class TestWithoutTime:
    def test_causes_that_begin_late_act_where_no_time_is_given(self) -> None:
        found = results(hanger(loss=LATE), {"size": 4.0})
        assert found.stresses.of_members["AB"]["axis"][0, 0] == pytest.approx(8e7)
        assert found.displacements[0, 1, 2] == pytest.approx(-8e-4)

    def test_at_a_time_before_them_they_do_not(self) -> None:
        found = results(hanger(loss=LATE), {"size": 4.0, "time": 0.0})
        assert found.stresses.of_members["AB"]["axis"][0, 0] == pytest.approx(4e7)

    def test_so_it_is_of_what_if(self) -> None:
        answer = whatif(hanger(loss=LATE), {"size": 4.0})
        assert answer.after[0] == pytest.approx(-0.8)
        early = whatif(hanger(loss=LATE), {"size": 4.0, "time": 0.0})
        assert early.after[0] == pytest.approx(-0.4)
        added = whatif(hanger(), {"size": 4.0}, {"loss": hanger(loss=LATE).effects["loss"]})
        assert (added.before[0], added.after[0]) == pytest.approx((-0.4, -0.8))


class TestRows:
    def test_members_are_told_row_by_row_too(self) -> None:
        found = results(hanger(), {"size": [4.0, 8.0]})
        assert found.members(1)["utilisation"].to_list() == pytest.approx([0.2])
        assert found.members()["utilisation"].to_list() == pytest.approx([0.4])
        with pytest.raises(rga.InputError, match="there is no row 3"):
            found.members(3)

    def test_a_file_serves_as_a_model(self, tmp_path: Path) -> None:
        write_model(hanger(), tmp_path / "model.json")
        found = rga.results(tmp_path / "model.json", {"size": 4.0})
        assert repr(found) == "Results of 'hanger': 1 row, 1 member"
        assert np.isfinite(found.displacements).all()


class TestNotebook:
    def test_a_row_is_drawn_as_it_was_solved(self) -> None:
        pyplot = pytest.importorskip("matplotlib.pyplot")
        found = results(hanger(), {"size": [1.0, 2.0]})
        _, axes = pyplot.subplots()
        assert found.plot(axes, row=2, forces="N") is axes
        title = " ".join(axes.get_title("left").split())
        assert title.endswith("at most 2.00 kN; at size = 2 kN")
        pyplot.close("all")
        with pytest.raises(rga.InputError, match="there is no row 3"):
            found.plot(row=3)

    def test_a_notebook_shows_the_extremes(self) -> None:
        shown = results(hanger(), {"size": 1.0})._repr_html_()
        assert "1 row; the extremes of every member" in shown
        assert "utilisation" in shown
