"""Modes found in windows get their names by their shapes, whatever their order and number."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import polars as pl
import pytest

import rga
from rga.arrays import FloatArray
from rga.errors import InputError
from rga.model import Model, read_model
from rga.records.modal.read import load_modal_record
from rga.simulation.modal.simulator import ModalSimulator
from rga.simulation.modal.windows import OPEN, named_modes

COUNT = 6
POINTS = tuple(f"A{at}" for at in range(COUNT))
ALONG = np.linspace(0.1, 0.9, COUNT)
SHAPES = np.array([np.sin((k + 1) * np.pi * ALONG) for k in range(3)])
NEAR = (4.0, 4.3, 9.0)
START = "2026-03-01T12:00:00"


@pytest.fixture(scope="module")
def model() -> Model:
    build = rga.ModelBuilder("beam", plane="xz").add_material("steel", E=210e9, density=7850)
    build.add_section("box", A=0.02, Iy=4e-4)
    for at, x in enumerate([0.0, *(10 * ALONG), 10.0]):
        build.add_node(f"n{at}", x)
        if at:
            build.add_member(f"n{at - 1}", f"n{at}", "box", kind="frame")
    build.support("n0", "pinned").support(f"n{COUNT + 1}", "uz")
    build.context("air", "degC", (-20.0, 40.0))
    content = build.build().model_dump(mode="json", exclude_defaults=True)
    content["points"] = {
        name: {"node": f"n{at + 1}", "direction": [0, 0, 1]} for at, name in enumerate(POINTS)
    }
    content["modes"] = {
        f"m{k}": {"near": near, "shape": dict(zip(POINTS, SHAPES[k].tolist(), strict=True))}
        for k, near in enumerate(NEAR)
    }
    content["sensors"] = {
        **{f"f{k}": {"kind": "frequency", "mode": f"m{k}", "unit": "Hz"} for k in range(3)},
        "a": {"kind": "mode_shape", "mode": "m1", "point": "A1", "unit": "-"},
    }
    return read_model(content, "a test")


def table(entries: list[tuple[int, float, FloatArray]], **more: object) -> pl.DataFrame:
    """Entries as (window, frequency, shape)."""
    return pl.DataFrame(
        {
            "time": [f"2026-03-01T{12 + window}:00:00" for window, _, _ in entries],
            "f": [frequency for _, frequency, _ in entries],
            **{name: [shape[at] for _, _, shape in entries] for at, name in enumerate(POINTS)},
            **more,
        }
    )


def read(frame: pl.DataFrame, folder: Path, model: Model) -> rga.records.modal.record.ModalRecord:
    file = folder / "modes.csv"
    frame.write_csv(file)
    return load_modal_record(file, model)


def test_shapes_name_modes_that_trade_places(tmp_path: Path, model: Model) -> None:
    entries = [
        (0, 4.0, SHAPES[0]), (0, 4.3, 2 * SHAPES[1]), (0, 9.1, -SHAPES[2]),
        (1, 4.1, -3 * SHAPES[1]), (1, 4.2, SHAPES[0]),
    ]  # fmt: skip
    record = read(table(entries), tmp_path, model)
    assert record.windows.tolist() == [0, 0, 0, 1, 1]
    assert (record.start, record.time[-1]) == (START, 3600.0)
    found = named_modes(record, model, ModalSimulator(model).expected)
    assert found.mode.tolist() == [0, 1, 2, 1, 0]
    expected = [[4.0, 4.3, 9.1, SHAPES[1, 1]], [4.2, 4.1, np.nan, SHAPES[1, 1]]]
    np.testing.assert_allclose(found.readings, expected, rtol=1e-9)
    assert not len(found.doubtful)
    assert found.in_doubt == ()


def test_modes_in_doubt_are_named(tmp_path: Path, model: Model) -> None:
    """Of two neighbours no shape was measured."""
    nothing = np.full(COUNT, np.nan)
    record = read(
        table([(0, 4.1, nothing), (0, 4.2, nothing), (0, 9.0, SHAPES[2])]), tmp_path, model
    )
    found = named_modes(record, model, ModalSimulator(model).expected)
    assert found.doubtful.tolist() == [0]
    assert found.in_doubt == ("m0", "m1")


def test_what_is_no_expected_mode_has_no_name(tmp_path: Path, model: Model) -> None:
    odd = np.array([1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
    record = read(
        table([(0, 4.05, SHAPES[0]), (0, 4.2, odd), (0, 30.0, SHAPES[2])]), tmp_path, model
    )
    found = named_modes(record, model, ModalSimulator(model).expected)
    assert found.mode.tolist() == [0, -1, -1]


def test_a_mode_of_which_a_point_is_turned_keeps_its_name(tmp_path: Path, model: Model) -> None:
    turned = SHAPES * np.where(np.arange(COUNT) == 2, -1.0, 1.0)
    record = read(table([(0, 4.0, turned[0]), (0, 9.1, SHAPES[2])]), tmp_path, model)
    found = named_modes(record, model, ModalSimulator(model).expected)
    assert found.mode.tolist() == [0, 2]
    assert found.mac[0] < 0.5 < found.mac[1]
    assert not len(found.doubtful)


def test_of_close_modes_one_that_was_found_alone_may_be_either(
    tmp_path: Path, model: Model
) -> None:
    both = [SHAPES[0] + SHAPES[1], SHAPES[0] - SHAPES[1]]
    record = read(
        table([(0, 4.0, both[0]), (0, 4.02, both[1]), (1, 4.01, both[0]), (1, 9.0, SHAPES[2])]),
        tmp_path,
        model,
    )
    given = ModalSimulator(model).expected
    close = {**given, "m1": replace(given["m1"], near=given["m0"].near)}
    found = named_modes(record, model, close)
    assert found.mode.tolist() == [0, 1, OPEN, 2]
    assert not len(found.doubtful)
    # Of what was measured without shapes the two are one.
    blind = replace(record, shapes=np.full_like(record.shapes, np.nan))
    assert OPEN not in named_modes(blind, model, close).mode


def test_a_window_in_which_the_structure_is_another_has_modes_of_its_own(
    tmp_path: Path, model: Model
) -> None:
    odd = np.array([1.0, -1.0, 1.0, 1.0, -1.0, 1.0])
    record = read(table([(0, 4.05, SHAPES[0]), (1, 2.5, odd)]), tmp_path, model)
    expected = ModalSimulator(model).expected
    name, look = next(iter(expected.items()))
    changed = {1: {name: replace(look, near=2.5, shape=odd[look.at])}}
    as_expected = named_modes(record, model, expected)
    found = named_modes(record, model, expected, changed)
    assert (as_expected.mode.tolist(), found.mode.tolist()) == ([0, -1], [0, 0])
    assert found.cost < as_expected.cost


def test_points_that_did_not_measure_are_left_aside(tmp_path: Path, model: Model) -> None:
    shape = SHAPES[1].copy()
    shape[[0, 4]] = np.nan
    record = read(table([(0, 4.3, shape)]), tmp_path, model)
    found = named_modes(record, model, ModalSimulator(model).expected)
    assert found.mode.tolist() == [1]
    assert found.mac[0] == pytest.approx(1.0)


def test_complex_shapes_are_turned(tmp_path: Path, model: Model) -> None:
    turned = SHAPES[1] * np.exp(0.8j)
    frame = table([(0, 4.3, turned.real)]).with_columns(
        **{f"{name}_im": pl.Series([turned[at].imag]) for at, name in enumerate(POINTS)}
    )
    record = read(frame, tmp_path, model)
    assert record.realness.tolist() == pytest.approx([1.0])
    found = named_modes(record, model, ModalSimulator(model).expected)
    assert found.readings[0, 3] == pytest.approx(SHAPES[1, 1])


@pytest.mark.parametrize("times", [[8.0, 9.5, 10.0, 100.0], ["2026-03-01", "2026-03-02"]])
def test_lines_stand_in_any_order(tmp_path: Path, model: Model, times: list[object]) -> None:
    frame = table([(0, 4.0 + 0.01 * k, SHAPES[0]) for k in range(len(times))])
    shuffled = frame.with_columns(time=pl.Series(times))[::-1]
    record = read(shuffled, tmp_path, model)
    assert record.windows.tolist() == list(range(len(times)))[::-1]
    found = named_modes(record, model, ModalSimulator(model).expected)
    np.testing.assert_allclose(found.readings[:, 0], [4.0 + 0.01 * k for k in range(len(times))])


def test_contexts_and_other_columns(tmp_path: Path, model: Model) -> None:
    record = read(table([(0, 4.0, SHAPES[0])], air=[3.5], operator=["Ada"]), tmp_path, model)
    assert record.contexts["air"].tolist() == [3.5]
    assert record.left_out == ("operator",)


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"f": pl.lit(-0.4)}, "not normalised"),
        ({"f": pl.lit(None)}, "there is no frequency"),
        ({"f": pl.lit("x")}, "is no number"),
        ({"time": pl.lit(None)}, "there is no time"),
        ({"duration": pl.lit(0.0)}, "is not above zero"),
        ({"f_sd": pl.lit(-1.0)}, "is not above zero"),
        ({"A0_im": pl.lit(1.0)}, "other points have an imaginary part"),
    ],
)
def test_what_cannot_be_meant_is_refused(
    tmp_path: Path, model: Model, change: dict[str, pl.Expr], told: str
) -> None:
    frame = table([(0, 4.0, SHAPES[0]), (0, 4.3, SHAPES[1])]).with_columns(**change)
    with pytest.raises(rga.InputError) as refused:
        read(frame, tmp_path, model)
    assert told in str(refused.value)


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        (["time", *POINTS], "no column 'f'"),
        (["f", *POINTS], "no column 'time'"),
        (["time", "f", "A0_im"], "there is no 'A0'"),
    ],
)
def test_columns_that_are_missing(
    tmp_path: Path, model: Model, columns: list[str], told: str
) -> None:
    frame = table([(0, 4.0, SHAPES[0])], A0_im=[0.0]).select(columns)
    with pytest.raises(rga.InputError, match="there is no") as refused:
        read(frame, tmp_path, model)
    assert told in str(refused.value)


def test_a_wide_table_has_a_column_a_mode(model: Model, tmp_path: Path) -> None:
    file = tmp_path / "wide.csv"
    file.write_text(
        "time,f0,m2,air,crew\n2026-03-01T12:00:00,4.01,8.9,3.5,1\n2026-03-01T13:00:00,,9.1,4.5,2\n"
    )
    record = load_modal_record(file, model)
    assert record.frequency.tolist() == [4.01, 8.9, 9.1]
    assert record.hint == ("m0", "m2", "m2")
    assert record.time.tolist() == [0.0, 0.0, 3600.0]
    assert record.contexts["air"].tolist() == [3.5, 3.5, 4.5]
    assert record.left_out == ("crew",)
    assert record.shapes.shape == (3, 0)
    named = named_modes(record, model, ModalSimulator(model).expected)
    assert named.mode.tolist() == [0, 2, 2]


@pytest.mark.parametrize(
    ("cells", "said"),
    [
        ("-4.0,9.0", "-4 Hz is no natural frequency"),
        (",", "no mode was found"),
        ("0,9", "0 Hz is no natural frequency"),
    ],
)
def test_a_wide_table_without_frequencies_is_refused(
    model: Model, tmp_path: Path, cells: str, said: str
) -> None:
    file = tmp_path / "wide.csv"
    file.write_text(f"time,m0,m2\n2026-03-01T12:00:00,{cells}\n")
    with pytest.raises(InputError, match=said):
        load_modal_record(file, model)
