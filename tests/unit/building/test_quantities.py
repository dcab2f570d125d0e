"""Quantities as people write them."""

import pint
import pytest

from rga.building.quantities import amount, amounts, difference
from rga.errors import InputError


class TestAmount:
    @pytest.mark.parametrize(
        ("given", "unit", "number"),
        [
            (20, "m", 20.0),
            ("20 m", "m", 20.0),
            ("70mm", "m", 0.07),
            ("3.2 kN", "N", 3200.0),
            ("210 GPa", "Pa", 2.1e11),
            ("235 N/mm2", "Pa", 2.35e8),
            ("12e-6/K", "1/K", 1.2e-5),
            ("12e-6 / °C", "1/K", 1.2e-5),
            ("28.5 cm²", "m^2", 2.85e-3),
            ("1943 cm4", "m^4", 1.943e-5),
            ("12 kNm", "N m", 12000.0),
            ("20 MN m/rad", "N m", 2e7),
            ("−4.5 kN/m", "N/m", -4500.0),
            ("15 degC", "degC", 15.0),
            ("288.15 K", "degC", 15.0),
            ("3 µm/m", "microstrain", 3.0),
            ("5 µε", "microstrain", 5.0),
            ("0.05 deg", "mrad", 0.872664625997165),
            ("50 %", "", 0.5),
        ],
    )
    def test_a_text_is_converted_and_a_number_is_taken_as_it_is(
        self, given: float | str, unit: str, number: float
    ) -> None:
        assert amount(given, unit, "here") == pytest.approx(number, rel=1e-12)

    def test_a_quantity_of_any_registry_is_converted(self) -> None:
        own = pint.UnitRegistry()
        assert amount(own.Quantity(70, "mm"), "m", "here") == 0.07
        assert difference(own.Quantity(0.3, "degC"), "degC", "noise") == 0.3

    @pytest.mark.parametrize(
        ("given", "unit", "what"),
        [
            ("20", "m", "has no unit"),
            ("3,2 kN", "N", "the decimal sign is a point"),
            ("3 kg", "N", "is of another dimension"),
            ("3 people", "N", "the unit 'people' is unknown"),
            ("3 kPa", "people", "'people' is no unit that is known"),
            ("fast", "m", "is no number with a unit"),
            ("nan m", "m", "is no number with a unit"),
            ("1e999 m", "m", "is no finite number"),
            ("9" * 99 + " m", "m", "is no number with a unit"),
            ("2 m**99999", "m", "is unknown"),
            ("2 __import__('os')", "m", "is unknown"),
            ("2 (", "m", "is unknown"),
            ("2 m**9**9**9", "m", "is unknown"),
            ("2 (9)^(9)^(9)", "m", "is unknown"),
            ("2 m/0", "m", "is unknown"),
            (float("inf"), "m", "is no finite number"),
            (True, "m", "is no quantity"),
            (None, "m", "is no quantity"),
            ([1.0], "m", "is no quantity"),
        ],
    )
    def test_what_is_none_gets_one_error_with_what_to_write(
        self, given: float, unit: str, what: str
    ) -> None:
        with pytest.raises(InputError, match=r"a span") as error:
            amount(given, unit, "a span")
        assert what in str(error.value)
        assert len(str(error.value)) < 250

    def test_several_have_their_number(self) -> None:
        assert amounts((0, 0, "-10 kN"), "N", "force", 3) == [0.0, 0.0, -10000.0]
        for wrong in ((1, 2), "1 2 3", 7):
            with pytest.raises(InputError, match="no list of 3"):
                amounts(wrong, "N", "force", 3)

    def test_a_deviation_has_no_zero_of_its_own(self) -> None:
        assert difference("0.3 K", "degC", "noise") == 0.3
        assert difference("0.5 degF", "degC", "noise") == pytest.approx(0.5 / 1.8)
        assert difference(0.3, "degC", "noise") == 0.3
