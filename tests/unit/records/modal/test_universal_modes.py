"""Universal files of modes (dataset 55) and of time histories (dataset 58), written as text."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
import pytest

from rga.errors import InputError
from rga.model import Model
from rga.records.mapping import TimeColumns
from rga.records.modal.read import load_modal_record
from rga.records.read import read_table
from rga.records.times import read_clock

pytest.importorskip("pyuff", reason="pyuff reads universal files")
NONE = "NONE\n" * 5
#: motion along x, y and z of nodes 1 and 2, in two modes
SHAPES = np.array([[[0.3, 0.1, 0.0], [1.0, 0.3, 0.0]], [[-0.4, 0.0, 0.0], [1.0, 0.0, 0.0]]])


def reals(values: Sequence[float]) -> str:
    """Numbers as 6E13.5."""
    lines = [values[at : at + 6] for at in range(0, len(values), 6)]
    return "".join("".join(f"{one:13.5e}" for one in line) + "\n" for line in lines)


def mode(number: int, frequency: float, shape: np.ndarray, *, kind: int = 8) -> str:
    """A normal mode with a damping of 1 %, or a complex one where the shape is."""
    phased = np.iscomplexobj(shape)
    head = (1, 3 if phased else 2, 2, kind, 5 if phased else 2, 3)
    rate = 2 * np.pi * frequency * complex(-0.01, np.sqrt(1 - 0.01**2))
    said = [rate.real, rate.imag, 0, 0, 0, 0] if phased else [frequency, 1.0, 0.01, 0.0]
    text = f"    -1\n    55\n{NONE}" + "".join(f"{one:10d}" for one in head) + "\n"
    text += "".join(f"{one:10d}" for one in (2, len(said), 1, number)) + "\n" + reals(said)
    for node, motion in enumerate(shape, 1):
        parts = np.column_stack([motion.real, motion.imag]).ravel() if phased else motion
        text += f"{node:10d}\n" + reals(parts.tolist())
    return text + "    -1\n"


def history(
    node: int, direction: int, values: Sequence[float], *, kind: int = 1, said: int | None = None
) -> str:
    """A function at a node, at steps of 0.01 s."""
    text = f"    -1\n    58\n{NONE}"
    text += f"{kind:5d}{0:10d}{0:5d}{0:10d} NONE      {node:10d}{direction:4d} NONE      "
    text += f"{0:10d}{0:4d}\n"
    count = len(values) if said is None else said
    text += f"{2:10d}{count:10d}{1:10d}" + reals([0.0, 0.01, 0.0])
    for what, unit in ((17, "s"), (12, "m/s^2"), (0, "NONE"), (0, "NONE")):
        text += f"{what:10d}{0:5d}{0:5d}{0:5d} {'NONE':20s} {unit:20s}\n"
    return text + reals(values) + "    -1\n"


@pytest.mark.parametrize("phase", [None, 0.7])
def test_modes_at_nodes(tmp_path: Path, mast: Model, phase: float | None) -> None:
    shapes = SHAPES if phase is None else SHAPES * np.exp(1j * phase)
    file = tmp_path / "modes.unv"
    file.write_text(mode(1, 4.1, shapes[0]) + mode(2, 7.3, shapes[1]), encoding="ascii")
    record = load_modal_record(file, mast)
    assert record.frequency.tolist() == pytest.approx([4.1, 7.3], rel=1e-5)
    assert record.damping.tolist() == pytest.approx([0.01, 0.01], rel=1e-4)
    assert record.hint == ("1", "2")
    assert record.points == ("n1_x", "n1_y", "n2_x", "n2_y")
    # Nothing moves along z in any mode: that was not measured.
    assert record.left_out == ()
    assert record.realness.tolist() == pytest.approx([1.0, 1.0])
    expected = SHAPES[:, :, :2].reshape(2, 4)
    along = (record.shapes * expected).sum(1) / (expected**2).sum(1)
    np.testing.assert_allclose(record.shapes, along[:, None] * expected, atol=1e-5)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (history(1, 1, [0.0, 1.0]), "there is no dataset 55"),
        (mode(1, 0.0, SHAPES[0]), "0 Hz is no frequency"),
        (mode(1, 4.1, SHAPES[0], kind=3), "are no motion"),
        (mode(1, 4.1, SHAPES[0])[:-60] + "    -1\n", "nodes and values do not fit together"),
        (mode(1, 4.1, SHAPES[0]).replace("4.10000e+00", "4.1x000e+00"), "cannot be read"),
        ("time,f\n0,4.1\n", "no dataset begins in it with a line of -1"),
    ],
)
def test_universal_files_without_modes(tmp_path: Path, mast: Model, text: str, told: str) -> None:
    (tmp_path / "modes.uff").write_text(text, encoding="ascii")
    with pytest.raises(InputError) as refused:
        load_modal_record(tmp_path / "modes.uff", mast)
    assert told in str(refused.value)


@pytest.mark.parametrize("kept", [20, 100, 250, -8])
def test_a_file_that_breaks_off_is_refused(tmp_path: Path, mast: Model, kept: int) -> None:
    """Inside its second dataset, of which the first modes would be read without a word."""
    first, second = (mode(k, 4.1 * k, shape) for k, shape in enumerate(SHAPES, 1))
    (tmp_path / "modes.uff").write_text(first + second[:kept], encoding="ascii")
    with pytest.raises(InputError) as refused:
        load_modal_record(tmp_path / "modes.uff", mast)
    assert "the file breaks off in dataset" in str(refused.value)
    assert f"begins in line {first.count(chr(10)) + 1} and has no end" in str(refused.value)


def test_time_histories_are_columns_that_count_along_their_axes(tmp_path: Path) -> None:
    file = tmp_path / "run.uff"
    values = [0.0, 1.0, -2.0, 3.0, 0.5, 0.25, 7.0]
    text = history(12, 1, values) + history(3, -3, values) + history(3, 2, values, kind=4)
    file.write_text(text, encoding="ascii")
    table = read_table(file)
    assert table.frame.columns == ["n12_x", "n3_z"]
    assert table.numbers("n12_x").tolist() == values
    assert table.numbers("n3_z").tolist() == [-one for one in values]
    assert table.units == {"n12_x": "m/s^2", "n3_z": "m/s^2"}
    assert any("n3_z" in note for note in table.notes)
    clock = read_clock(table, TimeColumns())
    assert clock.seconds.tolist() == pytest.approx([0.01 * k for k in range(len(values))])


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (mode(1, 4.1, SHAPES[0]), "there is no dataset 58"),
        (history(1, 1, [0.0, 1.0], kind=4), "is a time response"),
        (history(1, 1, [0.0, 1.0], said=9), "has 2 of 9 samples"),
        (history(1, 1, [0.0, 1.0]) + history(1, -1, [0.0, 1.0]), "'n1_x' was measured twice"),
        (history(1, 9, [0.0, 1.0]), "9 is no direction"),
    ],
)
def test_universal_files_without_histories(tmp_path: Path, text: str, told: str) -> None:
    (tmp_path / "run.uff").write_text(text, encoding="ascii")
    with pytest.raises(InputError) as refused:
        read_table(tmp_path / "run.uff")
    assert told in str(refused.value)
