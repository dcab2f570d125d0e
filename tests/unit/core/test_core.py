"""The binding: what crosses the border between NumPy and the core."""

from typing import Any

import numpy as np
import pytest

from rga import _core
from rga.arrays import LoadArrays, OutputArrays, StructureArrays

Arrays = dict[str, np.ndarray[Any, Any]]
LENGTH, STIFFNESS, FORCE = 3.0, 2.1e11 * 8e-3, 1e4


def bar() -> tuple[Arrays, Arrays, Arrays]:
    """A truss member along x, fixed at its first node and pulled at its second."""
    one, none = np.ones(1), np.zeros(0)
    fixed = np.ones((2, 6), dtype=bool)
    fixed[1, 0] = False
    structure: Arrays = {
        "coordinates": np.array([[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0]]),
        "ends": np.array([[0, 1]]),
        "frame": np.array([False]),
        "local_y": np.full((1, 3), np.nan),
        "connection": np.full((1, 12), np.inf),
        "rigid_end": np.zeros((1, 2)),
        "fixed": fixed,
        "inclined_node": none.astype(np.int64),
        "inclined_direction": np.zeros((0, 3)),
        "spring_node": np.zeros((0, 2), dtype=np.int64),
        "spring_dof": none.astype(np.int64),
        "spring_stiffness": none,
        "tie_node": np.zeros((0, 2), dtype=np.int64),
        "tie_dof": none.astype(np.int64),
        **dict.fromkeys(("G", "Iy", "Iz", "J", "Asy", "Asz"), one),
        "E": 2.1e11 * one,
        "A": 8e-3 * one,
    }
    forces = np.zeros((1, 2, 6))
    forces[0, 1, 0] = FORCE
    loads: Arrays = {
        "forces": forces,
        "strain": np.zeros((1, 1, 3)),
        "prescribed": np.zeros((1, 2, 6)),
        "prescribed_inclined": np.zeros((1, 0)),
        **{f"member_{key}": none.astype(np.int64) for key in ("pattern", "index", "axis")},
        **{f"member_{key}": none for key in ("from", "to", "start", "end")},
    }
    outputs: Arrays = {
        "kind": np.array([0]),
        "index": np.array([1]),
        "other": np.array([-1]),
        "vector": np.array([[1.0, 0.0, 0.0]]),
        "total": np.array([False]),
    }
    return structure, loads, outputs


def test_bar_lengthens() -> None:
    assert _core.respond(*bar()) == pytest.approx(FORCE * LENGTH / STIFFNESS)


def test_memory_order_does_not_matter() -> None:
    structure, loads, outputs = bar()
    expected = _core.respond(structure, loads, outputs)
    spread = {key: np.repeat(array, 2, axis=0)[::2] for key, array in loads.items()}
    fortran = {key: np.asfortranarray(array) for key, array in structure.items()}
    assert np.array_equal(_core.respond(fortran, spread, outputs), expected)


@pytest.mark.parametrize(
    ("key", "value", "words"),
    [
        ("ends", None, "lacks the key"),
        ("ends", np.array([[0, 1]], dtype=np.int32), "int64"),
        ("E", [2.1e11], "numpy array of float64"),
        ("coordinates", np.array(1.0), "shape"),
        ("fixed", np.zeros((3, 6), dtype=bool), "shape"),
        ("ends", np.array([[0, 2]]), "below 2"),
    ],
)
def test_bad_array_is_named(key: str, value: Any, words: str) -> None:
    structure, loads, outputs = bar()
    if value is None:
        del structure[key]
    else:
        structure[key] = value
    with pytest.raises(_core.InvalidInput, match=words) as refusal:
        _core.respond(structure, loads, outputs)
    assert key in str(refusal.value)
    assert isinstance(refusal.value, ValueError)


@pytest.mark.parametrize("place", range(3))
def test_typed_names_are_those_that_the_core_reads(place: int) -> None:
    given = bar()
    names = (StructureArrays, LoadArrays, OutputArrays)[place].__annotations__
    assert names.keys() == given[place].keys()
    for name in names:
        lacking = list(given)
        lacking[place] = {key: array for key, array in given[place].items() if key != name}
        with pytest.raises(_core.InvalidInput, match=f'lacks the key "{name}"'):
            _core.respond(*lacking)


def test_mechanism_is_named() -> None:
    structure, loads, outputs = bar()
    structure["fixed"][1, 2] = False
    with pytest.raises(_core.UnstableStructure) as refusal:
        _core.respond(structure, loads, outputs)
    assert (refusal.value.node, refusal.value.dof) == (1, 2)
    assert refusal.value.direction == pytest.approx([0.0, 0.0, 1.0, 0.0, 0.0, 0.0])


def test_friction_holds_then_slides() -> None:
    free = np.array([[1e-3], [5e-3]])
    normal, flexibility = np.full((2, 1), 1e5), np.array([[1e-6]])
    settled = flexibility, normal, np.zeros((1, 1)), np.array([0.03])
    forces = _core.slide(free, *settled, np.zeros((2, 1)))
    assert forces[:, 0] == pytest.approx([-1e3, -3e3])
    before = np.array([free[0], forces[0]])
    assert _core.slide(free[1:], flexibility, normal[1:], *settled[2:], before) == forces[1]
