"""Lines of drawings become members; what lines do not say is asked for."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from rga.errors import InputError
from rga.importing import ImportRefused, import_model

ezdxf = pytest.importorskip("ezdxf")
SHARED = Path(__file__).parents[4] / "shared" / "imports" / "models"
FRAME = SHARED / "anastruct_ex_24_model.dxf"
BARS: dict[str, Any] = {
    "kind": "truss", "sections": ["A=10cm2"], "materials": ["E=210GPa, density=7850kg/m3"],
}  # fmt: skip


@pytest.fixture
def drawn(tmp_path: Path) -> Callable[..., Path]:
    """Draws a triangle in a unit, with a text, a circle and what more is wanted."""

    def draw(
        unit: int = 4, size: float = 1000.0, more: Callable[[Any], None] | None = None
    ) -> Path:
        document = ezdxf.new()
        document.header["$INSUNITS"] = unit
        space = document.modelspace()
        space.add_line((0, 0), (size, 0), dxfattribs={"layer": "chord"})
        space.add_lwpolyline([(size + 1e-7, 0), (size / 2, size), (0, 1e-7)])
        space.add_text("20 kN", dxfattribs={"insert": (size, 0)})
        space.add_circle((0, 0), 5)
        if more is not None:
            more(space)
        path = tmp_path / "drawing.dxf"
        document.saveas(path)
        return path

    return draw


class TestDrawing:
    def test_lines_become_members_in_metres(self, drawn: Callable[..., Path]) -> None:
        found = import_model(drawn(), **BARS)
        assert found.counts["nodes"] == 3
        assert found.model.members["M1"].groups == ["chord"]
        assert found.model.nodes["N3"] == (0.5, 0.0, 1.0)
        assert found.model.plane == "xz"
        said = "\n".join(map(str, found.notes))
        assert "the text '20 kN', which is not guessed at" in said
        assert "1 of these are in the drawing and no lines (CIRCLE)" in said

    def test_what_lines_do_not_say_is_one_list_of_questions(
        self, drawn: Callable[..., Path]
    ) -> None:
        with pytest.raises(ImportRefused, match="--kind truss") as refused:
            import_model(drawn())
        assert "the kind of its members, their section, their material" in str(refused.value)

    @pytest.mark.parametrize(
        ("unit", "size", "said"),
        [(0, 10.0, "does not say its unit"), (4, 10.0, "would be 0.01 m large")],
    )
    def test_a_unit_that_cannot_be_is_asked_for(
        self, drawn: Callable[..., Path], unit: int, size: float, said: str
    ) -> None:
        path = drawn(unit, size)
        with pytest.raises(ImportRefused, match=said):
            import_model(path, **BARS)
        assert import_model(path, units="m", **BARS).model.nodes["N2"] == (10.0, 0.0, 0.0)

    def test_a_line_twice_a_point_and_an_arc_are_said(self, drawn: Callable[..., Path]) -> None:
        def add(space: Any) -> None:
            space.add_line((1000, 0), (0, 0))
            space.add_line((0, 0), (0, 0))
            space.add_line((500, 0), (500, 1000))
            space.add_lwpolyline([(0, 0, 0.5), (1000, 0, 0)], format="xyb")

        path = drawn(more=add)
        with pytest.raises(ImportRefused, match="a polyline with an arc"):
            import_model(path, **BARS)
        said = "\n".join(map(str, import_model(path, accept=["partial"], **BARS).notes))
        assert "it lies on LINE" in said
        assert "a line of no length" in said
        assert (
            "a node lies on a member that goes on through it: they are not joined (N4 on M1)"
            in said
        )

    def test_a_frame_needs_more_than_an_area(self, drawn: Callable[..., Path]) -> None:
        with pytest.raises(ImportRefused, match="a frame needs Iy as well"):
            import_model(drawn(), **{**BARS, "kind": "frame"})

    def test_a_drawing_without_lines_is_one_error(self, tmp_path: Path) -> None:
        path = tmp_path / "empty.dxf"
        ezdxf.new().saveas(path)
        with pytest.raises(InputError, match="no straight line"):
            import_model(path, **BARS)


@pytest.mark.skipif(not FRAME.exists(), reason="shared/imports is not beside the repository")
class TestDrawingOfOthers:
    def test_its_ends_are_joined_and_its_unit_is_asked_for(self) -> None:
        with pytest.raises(ImportRefused, match=r"\$INSUNITS = 4 .*0.0522 m large"):
            import_model(FRAME, **BARS)
        found = import_model(FRAME, units="m", **BARS)
        assert (found.counts["members"], found.counts["nodes"]) == (32, 21)
        places = found.model.nodes.values()
        assert {x for x, _, _ in places} == {0.0, 10.0, 20.0}
        assert max(z for _, _, z in places) == pytest.approx(52.164127636)
