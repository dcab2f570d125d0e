"""Rolled sections against the figures that their standards print."""

import csv
from importlib.resources import files

import pytest

from rga.building import angle, rolled_section, rolled_sections
from rga.building.sections.outline import enclosed
from rga.errors import InputError

#: properties that are checked by table: cm2 and cm4 as printed
PRINTED = {"A": 1e4, "Iy": 1e8, "Iz": 1e8}
#: how far printed figures may be off by more than their last digit: standards round on the way
BEYOND_ROUNDING = {
    "i_sections_european": 0.0,
    "channels_european": 0.007,
    "i_sections_indian": 0.01,
    "channels_indian": 0.01,
}
#: whose flange tips are thinner than their radius: the standard takes off more than is there
ODD = dict.fromkeys(("ISLB 250", "ISLB 275", "ISLB 300", "ISLB 325", "ISLB 350"), 0.035)


def lines(table: str) -> list[dict[str, str]]:
    text = files("rga.building.sections").joinpath("tables", f"{table}.csv").read_text("utf-8")
    assert text.startswith("# ")  # the source
    return list(csv.DictReader(line for line in text.splitlines() if not line.startswith("#")))


def last_digit(printed: str) -> float:
    """One unit of the third digit of a number, or of its last one where it has fewer."""
    value = float(printed)
    return max(10.0 ** (len(str(int(value))) - 3), 10.0 ** -len(printed.partition(".")[2]))


class TestPrintedFigures:
    @pytest.mark.parametrize("table", BEYOND_ROUNDING)
    def test_i_sections_and_channels_agree_line_by_line(self, table: str) -> None:
        checked = 0
        for line in lines(table):
            section = rolled_section(line["name"])
            beyond = ODD.get(line["name"], BEYOND_ROUNDING[table])
            for key, scale in PRINTED.items():
                printed, found = float(line[key]), getattr(section, key) * scale
                allowed = max(1.001 * last_digit(line[key]), beyond * printed)
                assert abs(found - printed) <= allowed, (line["name"], key, found)
                checked += 1
        assert checked >= 60

    @pytest.mark.parametrize("table", ["angles_european", "angles_indian"])
    def test_angles_agree_within_the_last_printed_digit(self, table: str) -> None:
        for line in lines(table):
            section = rolled_section(line["name"])
            assert pytest.approx(float(line["A"]), abs=last_digit(line["A"])) == section.A * 1e4
            h, b, t, r, toe = (float(line[key]) / 1000 for key in ("h", "b", "t", "r", "r2"))
            level = enclosed([(0, 0, 0), (b, 0, 0), (b, t, toe), (t, t, r), (t, h, toe), (0, h, 0)])
            assert level.about_y * 1e8 == pytest.approx(
                float(line["I"]), abs=1.001 * last_digit(line["I"])
            )
            assert section.Iy + section.Iz == pytest.approx(level.about_y + level.about_z)
            assert section == angle(h, b, t, r, toe)

    @pytest.mark.parametrize(
        ("name", "area", "inertia", "torsion"),
        [
            # EN 10210-2: A [cm2], I and J [cm4]
            ("CHS 42.4x3.2", 3.94, 7.62, 15.2),
            ("CHS 60.3x5", 8.69, 33.5, 67.0),
            ("CHS 88.9x8", 20.3, 168, 336),
            ("CHS 114.3x6.3", 21.4, 313, 625),
            ("CHS 139.7x8", 33.1, 720, 1440),
            ("CHS 168.3x12.5", 61.2, 1870, 3740),
            ("SHS 40x40x4", 5.59, 11.8, 19.5),
            ("SHS 60x60x5", 10.7, 53.3, 86.4),
            ("SHS 80x80x6.3", 18.1, 162, 262),
            ("SHS 100x100x8", 28.8, 400, 646),
            ("SHS 100x100x10", 34.9, 462, 761),
            ("SHS 120x120x5", 22.7, 498, 777),
        ],
    )
    def test_hollow_sections_agree(
        self, name: str, area: float, inertia: float, torsion: float
    ) -> None:
        section = rolled_section(name)
        assert pytest.approx(area, rel=0.004) == section.A * 1e4
        assert section.Iy * 1e8 == pytest.approx(inertia, rel=0.004)
        assert pytest.approx(torsion, rel=0.005) == section.J * 1e8

    @pytest.mark.parametrize(
        ("name", "torsion"),
        [
            # EN 10365 and EN 10056: J [cm4]
            ("IPE 200", 6.98),
            ("IPE 600", 165.4),
            ("HEB 200", 59.3),
            ("HEM 300", 1408),
            ("UPE 200", 8.89),
            ("UPE 80", 1.47),
            ("UPN 200", 11.9),
            ("UPN 400", 81.6),
            ("L 100x100x10", 6.97),
            ("L 80x80x8", 2.88),
        ],
    )
    def test_torsion_constants_agree(self, name: str, torsion: float) -> None:
        assert pytest.approx(torsion, rel=0.01) == rolled_section(name).J * 1e8


class TestNames:
    def test_every_name_that_is_listed_is_a_section(self) -> None:
        names = rolled_sections()
        assert len(names) > 450
        assert len(set(names)) == len(names)
        for name in names:
            section = rolled_section(name)
            assert section.Iy > (1 - 1e-9) * section.Iz > 0
            assert section.J > 0
            assert len(section.fibres) in (4, 5)

    @pytest.mark.parametrize(
        ("written", "name"),
        [
            ("ipe200", "IPE 200"),
            ("HE 200 A", "HEA 200"),
            ("SHS 100x5", "SHS 100x100x5"),
            ("L 80x8", "L 80x80x8"),
            ("chs 114,3 × 5.0", "CHS 114.3x5"),
            ("ISA 75*75*8", "ISA 75x75x8"),
        ],
    )
    def test_names_may_be_written_in_other_ways(self, written: str, name: str) -> None:
        assert rolled_section(written) == rolled_section(name)

    @pytest.mark.parametrize(
        ("name", "near"),
        [
            ("IPE 205", "IPE 200, IPE 220, IPE 180"),
            ("HEA 1000", "HEA 600"),
            ("CHS 114x5", "CHS 114.3x5"),
            ("SHS 125x6.3", "SHS 120x120x6.3, SHS 120x120x5"),
            ("SHS 125x125x6.3", "SHS 120x120x6.3"),
            ("SHS 125", "SHS 120x120x"),
            ("L 82x8", "L 80x80x8"),
            ("HE 205 A", "HEA 200, HEA 220"),
            ("ISMB 260", "ISMB 250"),
            ("IPPE 200", "IPE 200"),
            ("%$", "see rolled_sections()"),
            ("", "see rolled_sections()"),
        ],
    )
    def test_an_unknown_name_gets_the_nearest(self, name: str, near: str) -> None:
        with pytest.raises(InputError, match="there is no rolled section") as error:
            rolled_section(name)
        assert near in str(error.value)

    def test_no_text_is_no_name(self) -> None:
        with pytest.raises(InputError, match="there is no rolled section 200"):
            rolled_section(200)  # type: ignore[arg-type]
