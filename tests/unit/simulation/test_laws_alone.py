"""Structures whose laws alone differ are told from those that differ in more."""

import numpy as np
import pytest

from rga.model import read_model
from rga.model.structure import Law, Structure, build_structure
from rga.simulation.paths.unilateral import laws_alone
from rga_bench.synthetic import draw_case


@pytest.fixture(scope="module")
def plain() -> Structure:
    case = draw_case(5, bridge="pratt", kind="null", rows=10)
    return build_structure(read_model(case.model, "case"))


def stopped(plain: Structure, stiffness: float, node: int = 0, size: float = 1e-3) -> Structure:
    found = plain.copy()
    spring = len(found.arrays["spring_dof"])
    found.add_spring(node, -1, 0, stiffness)
    found.laws.append(Law("play", None, spring, size))
    return found


def test_stops_of_other_stiffness_and_none_are_one_table(plain: Structure) -> None:
    several = [plain, stopped(plain, 3e6), stopped(plain, 2e6, size=2e-3)]
    found = laws_alone(several)
    assert found is not None
    structure, table = found
    assert structure is several[2]
    assert table.size.tolist() == [[np.inf], [1e-3], [2e-3]]
    assert table.stiffness.tolist() == [[2e6], [3e6], [2e6]]


def test_what_differs_in_more_is_refused(plain: Structure) -> None:
    one = stopped(plain, 2e6)
    elsewhere = stopped(plain, 3e6, node=1)
    softer = stopped(plain, 3e6)
    softer.arrays["A"][0] *= 0.9
    gauge = stopped(plain, 3e6)
    gauge.outputs["vector"][0] += 0.1
    warm = stopped(plain, 3e6)
    warm.alpha[0] *= 2.0
    tied = plain.copy()
    tied.add_spring(1, 2, 0, 1e6)
    # The softest stop has a number that the other structure has no spring of.
    assert laws_alone([one, stopped(tied, 1e6)]) is None
    for other in (elsewhere, softer, gauge, warm):
        assert laws_alone([one, other]) is None
    assert laws_alone([plain, plain]) is None


def test_a_copy_is_changed_by_itself_and_the_first_cannot_be(plain: Structure) -> None:
    copy, before = plain.copy(), plain.arrays["E"].copy()
    copy.arrays["E"][:] *= 2.0
    assert np.array_equal(plain.arrays["E"], before)
    for name, array in copy.arrays.items():
        if name != "E":
            assert not array.flags.writeable  # type: ignore[attr-defined]
