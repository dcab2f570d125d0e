"""Which mode is which: by shape, whatever its number."""

import numpy as np

from rga.arrays import FloatArray
from rga.simulation.modal.pairing import Expected, paired, turned

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
