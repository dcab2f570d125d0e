"""Sections against closed forms."""

import math

import pytest

from rga.building import angle, channel, circular_hollow, i_section, rectangle, rectangular_hollow
from rga.building.sections.outline import enclosed
from rga.building.sections.solid import rod
from rga.errors import InputError
from rga.model.schema import Section


class TestOutline:
    def test_a_square_rounded_to_a_circle_has_its_moments(self) -> None:
        r = 0.3
        corners = [(1 + r, 2 + r, r), (1 - r, 2 + r, r), (1 - r, 2 - r, r), (1 + r, 2 - r, r)]
        circle = enclosed(corners)
        assert circle.area == pytest.approx(math.pi * r**2, rel=2e-4)
        assert circle.about_y == pytest.approx(math.pi * r**4 / 4, rel=4e-4)
        assert (circle.y, circle.z) == pytest.approx((1, 2))
        assert circle.product == pytest.approx(0, abs=1e-12)

    def test_the_sense_of_turning_does_not_matter(self) -> None:
        corners = [(0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (0.0, 3.0, 0.0)]
        one, other = enclosed(corners), enclosed(corners[::-1])
        assert one.area == other.area == 3.0
        # b h^3 / 36, and -b^2 h^2 / 72 of a right triangle.
        assert one.about_y == pytest.approx(1.5)
        assert other.about_z == pytest.approx(2 / 3)
        assert one.product == pytest.approx(-0.5)
        assert other.product == pytest.approx(-0.5)

    def test_a_radius_that_does_not_fit_is_refused(self) -> None:
        with pytest.raises(InputError, match=r"a radius of 0\.6 m does not fit"):
            enclosed([(0.0, 0.0, 0.6), (1.0, 0.0, 0.6), (1.0, 1.0, 0.0), (0.0, 1.0, 0.0)])


class TestClosedForms:
    def test_a_rod_and_a_tube(self) -> None:
        bar, tube = rod(0.1), circular_hollow("100 mm", "10 mm")
        hole = rod(0.08)
        assert pytest.approx(bar.A - hole.A) == tube.A
        assert tube.Iz == pytest.approx(bar.Iz - hole.Iz)
        assert pytest.approx(2 * tube.Iy) == tube.J
        assert tube.fibres["top"] == (0.0, 0.05)
        assert tube.fibres["left"] == (0.05, 0.0)

    def test_a_rectangle_stands_upright(self) -> None:
        beam = rectangle("400 mm", "200 mm")
        assert beam.Iy == pytest.approx(4 * beam.Iz)
        # 0.229 and 0.141 of long x short^3 for ratios of 2 and 1 (Timoshenko and Goodier).
        assert pytest.approx(0.2287 * 0.4 * 0.2**3, rel=1e-3) == beam.J
        assert pytest.approx(0.14058, rel=1e-4) == rectangle(1, 1).J
        assert pytest.approx(beam.J) == rectangle(0.2, 0.4).J

    def test_a_sharp_box_is_the_difference_of_two_rectangles(self) -> None:
        box = rectangular_hollow(0.3, 0.2, 0.01, outer_radius=0, inner_radius=0)
        outer, inner = rectangle(0.3, 0.2), rectangle(0.28, 0.18)
        assert pytest.approx(outer.A - inner.A) == box.A
        assert box.Iy == pytest.approx(outer.Iy - inner.Iy)
        assert box.Iz == pytest.approx(outer.Iz - inner.Iz)
        # Bredt: 4 A^2 t / length, and the wall's own.
        length, within = 2 * (0.29 + 0.19), 0.29 * 0.19
        assert pytest.approx(4 * within**2 * 0.01 / length + 0.01**3 * length / 3) == box.J

    def test_an_i_section_without_fillets(self) -> None:
        beam = i_section(0.4, 0.2, 0.01, 0.02)
        assert pytest.approx(2 * 0.2 * 0.02 + 0.36 * 0.01) == beam.A
        assert beam.Iy == pytest.approx((0.2 * 0.4**3 - 0.19 * 0.36**3) / 12)
        assert beam.Iz == pytest.approx((2 * 0.02 * 0.2**3 + 0.36 * 0.01**3) / 12)
        assert beam.Iy > beam.Iz
        assert beam.fibres["top left"] == (0.1, 0.2)
        assert beam.fibres["bottom right"] == (-0.1, -0.2)

    def test_fillets_add_what_the_formula_of_catalogues_says(self) -> None:
        h, b, tw, tf, r = 0.3, 0.15, 0.0071, 0.0107, 0.015
        sharp, filleted = i_section(h, b, tw, tf), i_section(h, b, tw, tf, root=r)
        assert pytest.approx((4 - math.pi) * r**2, rel=1e-3) == filleted.A - sharp.A
        more = 0.03 * r**4 + 0.2146 * r**2 * (h - 2 * tf - 0.4468 * r) ** 2
        assert filleted.Iy - sharp.Iy == pytest.approx(more, rel=1e-3)

    def test_a_channel_counts_from_its_centroid(self) -> None:
        one = channel(0.2, 0.08, 0.01, 0.02)
        web, flanges = 0.2 * 0.01, 2 * 0.07 * 0.02
        y = (web * 0.005 + flanges * 0.045) / (web + flanges)
        assert pytest.approx(web + flanges) == one.A
        about = 0.2 * 0.01**3 / 12 + web * (y - 0.005) ** 2
        about += 2 * (0.02 * 0.07**3 / 12) + flanges * (0.045 - y) ** 2
        assert one.Iz == pytest.approx(about)
        assert one.Iy == pytest.approx((0.08 * 0.2**3 - 0.07 * 0.16**3) / 12)
        assert one.fibres["top right"] == pytest.approx((-y, 0.1))
        assert one.fibres["bottom left"] == pytest.approx((0.08 - y, -0.1))

    def test_an_angle_is_about_its_principal_axes(self) -> None:
        one = angle(0.1, 0.1, 0.01)
        whole = enclosed([(0, 0, 0), (0.1, 0, 0), (0.1, 0.01, 0), (0.01, 0.01, 0), (0.01, 0.1, 0),
                          (0, 0.1, 0)])  # fmt: skip
        assert one.Iy + one.Iz == pytest.approx(whole.about_y + whole.about_z)
        assert one.Iy == pytest.approx(whole.about_y + abs(whole.product))
        # The strong axis is that of symmetry: the heel lies on it, the legs to either side.
        assert one.fibres["heel"] == pytest.approx((-whole.y * math.sqrt(2), 0.0), abs=1e-12)
        up = one.fibres["end of the height, outside"]
        across = one.fibres["end of the width, outside"]
        assert up == pytest.approx((across[0], -across[1]))
        assert up[1] == pytest.approx(0.1 / math.sqrt(2))

    def test_an_unequal_angle_has_no_product_of_inertia_about_its_axes(self) -> None:
        one = angle("200 mm", "100 mm", "12 mm", root="12 mm", toe="4.8 mm")
        # IS 808: Iu 1530, Iv 161 cm4.
        assert one.Iy * 1e8 == pytest.approx(1530, rel=0.01)
        assert one.Iz * 1e8 == pytest.approx(161, rel=0.01)


class TestRefusedSections:
    @pytest.mark.parametrize(
        ("build", "what"),
        [
            (lambda: circular_hollow("100 mm", "50 mm"), "a wall of 0.05 m fills 0.1 m"),
            (lambda: circular_hollow("-100 mm", "5 mm"), "is no size"),
            (lambda: circular_hollow("100 kN", "5 mm"), "another dimension"),
            (lambda: rectangular_hollow(0.1, 0.1, 0.06), "fills"),
            (lambda: rectangular_hollow(0.1, 0.1, 0.01, outer_radius=0.06), "does not fit"),
            (lambda: i_section(0.2, 0.1, 0.2, 0.01), "a web of 0.2 m is wider"),
            (lambda: i_section(0.2, 0.1, 0.01, 0.1), "flanges of 0.1 m fill"),
            (lambda: i_section(0.2, 0.1, 0.01, 0.01, root=0.06), "does not fit"),
            (lambda: i_section(0.2, 0.1, 0.01, 0.01, root=-0.06), "is no radius"),
            (lambda: i_section(0.2, 0.1, 0.01, 0.01, slope=0.9), "tapers to nothing"),
            (lambda: i_section(0.2, 0.1, 0.01, 0.01, slope=98), "a slope of 98"),
            (lambda: channel(0.2, 0.1, 0.2, 0.01), "a web of 0.2 m is wider"),
            (lambda: channel(0.2, 0.1, 0.01, 0.1), "flanges of 0.1 m fill"),
            (lambda: angle(0.1, 0.1, 0.1), "thicker than a leg is long"),
            (lambda: rod(0), "is no size"),
            (lambda: rectangle("1 m", "0 mm"), "is no size"),
        ],
    )
    def test_dimensions_that_make_none_are_refused(self, build: type[Section], what: str) -> None:
        with pytest.raises(InputError) as error:
            build()
        assert what in str(error.value)
