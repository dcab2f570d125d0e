"""Which mode is which: by shape, whatever its number."""

import numpy as np

from rga.arrays import FloatArray
from rga.simulation.modal.expected import SHAPE_ERROR, Expected
from rga.simulation.modal.mixed_shapes import (
    apart,
    couplings,
    freedom_of_parts,
    parts_of_others,
    unlike_computed,
    unlike_mixed,
)
from rga.simulation.modal.pairing import mixture, paired, turned
from rga.simulation.modal.points import motion_at

POINTS = 12
ALONG = np.linspace(0, 1, POINTS)


def waves(count: int) -> FloatArray:
    """Shapes of a beam between two supports."""
    return np.array([np.sin((k + 1) * np.pi * ALONG) for k in range(count)])


def expected(shapes: FloatArray, near: list[float]) -> list[Expected]:
    return [
        Expected(one, 0.15, np.arange(POINTS), shape)
        for one, shape in zip(near, shapes, strict=True)
    ]


def test_modes_that_have_traded_places_keep_their_names() -> None:
    shapes = waves(3)
    found = paired(expected(shapes, [4.0, 4.5, 9.0]), np.array([4.1, 4.6, 9.0]), shapes[[1, 0, 2]])
    assert found.computed.tolist() == [1, 0, 2]
    assert found.others == ()


def test_neither_sign_nor_scale_matters() -> None:
    shapes = waves(3)
    scaled = shapes * np.array([[-3.0], [1e-6], [1e4]])
    found = paired(expected(shapes, [4.0, 4.5, 9.0]), np.array([4.0, 4.5, 9.0]), scaled)
    assert found.computed.tolist() == [0, 1, 2]
    again = turned(expected(shapes, [4.0, 4.5, 9.0]), found, np.array([4.0, 4.5, 9.0]), scaled)
    np.testing.assert_allclose(again, shapes, atol=1e-12)


def test_without_shapes_the_frequency_decides_and_doubt_is_told() -> None:
    modes = [Expected(near, 0.15, np.zeros(0, np.int64), np.zeros(0)) for near in (4.0, 4.1)]
    found = paired(modes, np.array([4.02, 4.08, 7.0]), waves(3))
    assert found.computed.tolist() == [0, 1]
    assert [one.tolist() for one, _ in found.others] == [[1, 0]]
    assert np.isnan(found.mac).all()


def test_neighbours_that_look_half_alike_are_told_apart() -> None:
    """MAC up to a half between different modes, order swapped, scatter on shapes."""
    draw = np.random.default_rng(11)
    right = 0
    for _ in range(300):
        one, other = draw.normal(size=(2, POINTS))
        one /= np.linalg.norm(one)
        other -= (other @ one) * one
        other = other / np.linalg.norm(other) + one
        pair = np.array([one, other / np.linalg.norm(other)])
        seen = pair[::-1] + draw.normal(0, 0.03, pair.shape)
        found = paired(expected(pair, [4.0, 4.2]), np.array([4.0, 4.2]), seen)
        told = [1, 0] in [one.tolist() for one, _ in found.others]
        right += found.computed.tolist() == [1, 0] or told
    assert right >= 297


def test_modes_of_equal_frequency_are_turned_to_what_is_expected() -> None:
    shapes = waves(2)
    angle = 0.7
    turn = np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])
    modes, frequencies = expected(shapes, [4.0, 4.0]), np.array([4.0, 4.0])
    found = paired(modes, frequencies, turn @ shapes)
    np.testing.assert_allclose(turned(modes, found, frequencies, turn @ shapes), shapes, atol=1e-12)


def test_where_modes_are_lacking_one_has_no_pair() -> None:
    shapes = waves(3)
    found = paired(expected(shapes, [4.0, 4.5, 9.0]), np.array([4.0, 9.0]), shapes[[0, 2]])
    assert found.computed.tolist() == [0, -1, 1]


def rotation(angle: float) -> FloatArray:
    return np.array([[np.cos(angle), np.sin(angle)], [-np.sin(angle), np.cos(angle)]])


def test_close_modes_are_turned_to_what_is_expected_by_any_angle() -> None:
    shapes = waves(3)
    modes, log_f = expected(shapes, [4.0, 4.0, 9.0]), np.log([4.0, 4.001, 9.0])
    for angle in (0.7, -1.4, 3.0):
        there = shapes[[1, 0, 2]]
        there[:2] = rotation(angle) @ there[:2]
        turn = mixture(modes, np.array([1, 0, 2]), log_f, there)
        np.testing.assert_allclose((turn @ there)[[1, 0, 2]], shapes, atol=1e-12)


def test_a_mode_of_equal_frequency_turns_with_the_one_that_has_a_pair() -> None:
    shapes = waves(3)
    modes, log_f = expected(shapes[[0, 2]], [4.0, 9.0]), np.log([4.0, 4.0, 9.0])
    for angle in (0.7, -1.4, 3.0):
        there = shapes.copy()
        there[:2] = rotation(angle) @ there[:2]
        turn = mixture(modes, np.array([0, 2]), log_f, there)
        np.testing.assert_allclose((turn @ there)[[0, 2]], shapes[[0, 2]], atol=1e-12)
        np.testing.assert_allclose(turn @ turn.T, np.eye(3), atol=1e-12)


def test_modes_that_lie_apart_are_not_turned() -> None:
    shapes = waves(2)
    modes = expected(shapes, [4.0, 4.1])
    turn = mixture(modes, np.arange(2), np.log([4.0, 4.1]), rotation(0.7) @ shapes)
    np.testing.assert_array_equal(turn, np.eye(2))


def test_mixtures_of_all_computed_modes_at_once_are_those_of_one_after_the_other() -> None:
    draw = np.random.default_rng(5)
    shapes, measured = draw.normal(size=(6, POINTS)), draw.normal(size=(2, POINTS))
    log_f = np.log([4.0, 4.001, 4.03, 4.2, 9.0, 9.1])
    some = np.arange(POINTS - 2)
    looks = [
        *(Expected(4.0, 0.1, np.arange(POINTS), shape) for shape in measured),
        Expected(9.0, 0.1, some, measured[0, some]),
        Expected(9.0, 0.1, some[:0], measured[0, :0]),
    ]
    at_once, freedom = unlike_computed(looks, couplings(log_f), shapes)
    for look, found in zip(looks[:3], at_once, strict=False):
        at = shapes[:, look.at]
        one_by_one = [
            unlike_mixed(look.shape, own, parts_of_others(log_f, at, number))
            for number, own in enumerate(at)
        ]
        np.testing.assert_allclose(found, one_by_one, rtol=1e-12)
    for look, found in zip(looks[:3], freedom, strict=False):
        at = shapes[:, look.at]
        spread = float(np.sqrt(0.5 * SHAPE_ERROR))
        one_by_one = []
        for number, own in enumerate(at):
            _, parts = apart(own / np.linalg.norm(own), own, parts_of_others(log_f, at, number))
            one_by_one.append(freedom_of_parts(parts, spread))
        np.testing.assert_allclose(found, one_by_one, rtol=1e-9, atol=1e-12)
    assert np.isnan(at_once[3]).all()
    assert not freedom[3].any()
    shape = measured[0]
    alone = 1.0 - (shape @ shapes[0]) ** 2 / (shape @ shape) / (shapes[0] @ shapes[0])
    assert at_once[0, 0] < alone


def test_a_mode_that_leaves_the_points_still_is_none_that_moves_them() -> None:
    """Rounding of a mode across, at points that measure upward, has a direction too."""
    up = np.array([[0.0, 0.0, one] for one in waves(1)[0]])
    across = np.array([[0.0, 1.0, 1e-13 * one] for one in waves(1)[0]])
    axes = np.tile([0.0, 0.0, 1.0], (POINTS, 1))
    modes = expected(waves(1), [4.0])
    for order in ([across, up], [up, across]):
        shapes = motion_at(np.array(order), axes)
        found = paired(modes, np.array([4.0, 4.1]), shapes)
        assert found.computed.tolist() == [0 if order[0] is up else 1]
        assert sorted(found.mac[0].round(9)) == [0.0, 1.0]
        unlike, _ = unlike_computed(modes, np.zeros((2, 2)), shapes)
        assert sorted(unlike[0].round(9)) == [0.0, 1.0]


def test_a_mode_that_moves_no_point_is_like_nothing_and_breaks_nothing() -> None:
    """Its shape there is rounding: over the length of that, parts of others are without bound."""
    shapes = np.array([[1e-170, 1e-171], [0.3, 0.9]])
    log_f = np.log([2.0, 2.001])
    with np.errstate(all="raise", under="ignore"):
        parts = parts_of_others(log_f, shapes, 0)
        unlike = unlike_mixed(np.array([0.3, 0.9]), shapes[0], parts)
        table, freedom = unlike_computed(
            [Expected(2.0, 0.1, np.arange(2), np.array([0.3, 0.9]))], couplings(log_f), shapes
        )
    assert np.isfinite(parts).all()
    assert 0.0 <= unlike <= 1.0
    assert np.isfinite(table).all()
    assert np.isfinite(freedom).all()


def test_what_hardly_moves_the_points_is_none_that_moves_them() -> None:
    """A brace that swings by itself looks at the points as what is in it of other modes."""
    shapes = waves(3)
    brace = 1e-3 * np.random.default_rng(0).normal(size=(2, POINTS))
    computed, log_f = np.concatenate([shapes, brace]), np.log([4.0, 9.0, 16.0, 9.3, 9.31])
    modes = expected(shapes, [4.0, 9.2, 16.0])
    unlike, freedom = unlike_computed(modes, couplings(log_f), computed)
    assert unlike[1, 3] < 0.01
    assert freedom[1, 3] > 5.0 > 5 * freedom[1, 1]
    found = paired(modes, np.exp(log_f), computed, unlike=unlike, freedom=freedom)
    assert found.computed.tolist() == [0, 1, 2]


def test_by_a_single_point_all_modes_look_alike() -> None:
    """Its share of one shape is as good as that of any other: only frequencies tell."""
    shapes, log_f = waves(3), np.log([4.0, 4.001, 9.0])
    at = np.array([5])
    modes = [Expected(near, 0.15, at, shapes[k, at]) for k, near in enumerate((4.0, 9.0))]
    assert np.isnan(unlike_computed(modes, couplings(log_f), shapes)[0]).all()
    assert np.isnan(unlike_mixed(shapes[0, at], shapes[1, at], np.zeros((0, 1))))
    assert np.isnan(paired(modes, np.exp(log_f), shapes).mac).all()


def test_a_mode_in_which_all_points_stand_still_is_paired_by_its_frequency() -> None:
    shapes = waves(3)
    still = Expected(4.5, 0.15, np.arange(POINTS), np.zeros(POINTS))
    modes = [*expected(shapes[:1], [4.0]), still]
    shapes[1] = 0.0
    found = paired(modes, np.array([4.0, 4.6, 9.0]), shapes)
    assert still.unseen
    assert not modes[0].unseen
    assert found.computed.tolist() == [0, 1]
    assert np.isnan(found.mac[1]).all()
