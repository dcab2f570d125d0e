"""Labels that do not cover each other."""

from itertools import combinations

import numpy as np
import pytest

from rga.drawing.labels import Room, overlap


class TestRoom:
    def test_labels_in_a_crowd_do_not_overlap(self) -> None:
        points = np.random.default_rng(0).random((60, 2)) * 3
        room = Room()
        placed = [room.place(f"node {k}", at) for k, at in enumerate(points)]
        boxes = [one.box for one in placed if one is not None]
        assert len(boxes) > 20
        assert not any(overlap(one, other) for one, other in combinations(boxes, 2))

    def test_nothing_is_put_outside_the_limits(self) -> None:
        room = Room(limits=(0.0, 0.0, 1.0, 1.0))
        inside = room.place("S1", (1.0, 1.0))
        assert inside is not None
        assert max(inside.box) <= 1.0
        assert room.place("a name far too long for so little room", (0.5, 0.5)) is None

    def test_a_label_stands_clear_of_a_line_where_it_can(self) -> None:
        line = np.column_stack([np.linspace(0.0, 1.0, 50), np.full(50, 0.1)])
        placed = Room(lines=line).place("chord", (0.0, 0.05))
        assert placed is not None
        left, bottom, right, top = placed.box
        covered = (line > (left, bottom)) & (line < (right, top))
        assert not covered.all(axis=1).any()

    def test_a_label_may_have_a_way_to_stand(self) -> None:
        for way in ((0.0, -1.0), (1.0, 0.0), (-0.6, 0.8)):
            placed = Room().place("-44.9", (1.0, 2.0), beyond=np.array(way))
            assert placed is not None
            middle = np.reshape(placed.box, (2, 2)).mean(axis=0) - (1.0, 2.0)
            assert middle / np.linalg.norm(middle) == pytest.approx(way)

    def test_a_label_stands_nearer_to_its_point_than_any_rival(self) -> None:
        points = np.column_stack([np.arange(8) * 0.3, np.zeros(8)])
        room = Room(boxes=[(0.5, -0.2, 0.7, 0.2)])
        placed = [room.place("L1-L2", at, rivals=points) for at in points]
        found = [one is not None for one in placed]
        assert any(found)
        assert not found[2]  # nothing is free about it but places beside its neighbours
        for k, one in enumerate(placed):
            if one is not None:
                middle = np.reshape(one.box, (2, 2)).mean(axis=0)
                assert np.argmin(np.linalg.norm(points - middle, axis=1)) == k
