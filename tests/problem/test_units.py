"""Units: what is written is what comes out, to the last bit, and what is wrong is said."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from magshell.errors import InputError
from magshell.units import (
    ACCELERATION,
    ANGLE,
    DENSITY,
    FLUX_DENSITY,
    FORCE,
    INVERSE_LENGTH,
    LENGTH,
    MOMENT,
    NUMBER,
    QUANTITIES,
    REMANENCE,
    STRESS,
    Dimension,
    parse,
    show,
)

EXACT = [(dimension, unit) for dimension in QUANTITIES for unit in dimension.units if unit != "deg"]
finite = st.floats(min_value=-1e100, max_value=1e100, allow_nan=False).filter(lambda x: x == 0 or abs(x) > 1e-100)


@pytest.mark.parametrize(
    ("text", "dimension", "expected"),
    [
        ("0.9 mm", LENGTH, 0.9e-3),
        ("22.9cm", LENGTH, 0.229),
        (" 90 um ", LENGTH, 90e-6),
        ("90 \u00b5m", LENGTH, 90e-6),
        ("90 \u03bcm", LENGTH, 90e-6),
        ("3 \u03bcN m", MOMENT, 3e-6),
        ("4\u03bcT", FLUX_DENSITY, 4e-6),
        ("135 kPa", STRESS, 135e3),
        ("3.25 N/mm^2", STRESS, 3.25e6),
        ("94 mT", FLUX_DENSITY, 0.094),
        ("940 G", FLUX_DENSITY, 0.094),
        ("940 G", REMANENCE, 0.094),
        ("1000 kA/m", REMANENCE, 0.4 * math.pi),
        ("1e6 A/m", REMANENCE, 0.4 * math.pi),
        ("1000 emu/cm^3", REMANENCE, 0.4 * math.pi),
        ("15 deg", ANGLE, 0.26179938779914943654),
        ("1/m", INVERSE_LENGTH, 1.0),
        ("2.5 1/mm", INVERSE_LENGTH, 2500.0),
        ("2/mm", INVERSE_LENGTH, 2000.0),
        ("-1e-3 m", LENGTH, -1e-3),
        ("2 mN", FORCE, 2e-3),
        ("1e-3 N m", MOMENT, 1e-3),
        ("1 N mm", MOMENT, 1e-3),
        ("5  mN  mm", MOMENT, 5e-6),
        ("-9.81 m/s^2", ACCELERATION, -9.81),
        ("9810 mm/s^2", ACCELERATION, 9.81),
        ("1.1 g/cm^3", DENSITY, 1100.0),
        ("1070 kg/m^3", DENSITY, 1070.0),
        (0, LENGTH, 0.0),
        ("0", STRESS, 0.0),
        (0.0, ANGLE, 0.0),
        (3, NUMBER, 3.0),
        ("0.25", NUMBER, 0.25),
    ],
)
def test_reads(text: object, dimension: Dimension, expected: float) -> None:
    assert parse(text, dimension) == expected


@given(number=finite, which=st.sampled_from(EXACT))
def test_round_trip_is_the_nearest_double(number: float, which: tuple[Dimension, str]) -> None:
    dimension, unit = which
    expected = float(Fraction(repr(number)) * Fraction(dimension.units[unit]))
    assert parse(f"{number!r} {unit}", dimension) == expected


@given(number=finite)
def test_an_angle_in_degrees_stays_what_it_was(number: float) -> None:
    assert parse(f"{number!r} deg", ANGLE, unit="deg") == number
    assert parse(f"{number!r} deg", ANGLE) == pytest.approx(math.radians(number), rel=1e-15)


@given(number=finite, dimension=st.sampled_from(QUANTITIES))
def test_what_is_shown_reads_back(number: float, dimension: Dimension) -> None:
    text = show(number, dimension, digits=17)
    assert parse(text, dimension) == pytest.approx(number, rel=4e-16), text


@given(number=finite.filter(bool), dimension=st.sampled_from(QUANTITIES))
def test_a_bare_number_is_refused_where_a_unit_belongs(number: float, dimension: Dimension) -> None:
    for value in (number, repr(number)):
        with pytest.raises(InputError, match="has no unit") as caught:
            parse(value, dimension)
        assert all(unit in str(caught.value) for unit in dimension.units)


@given(value=st.one_of(st.text(max_size=30), st.integers(), st.floats(), st.booleans(), st.none()))
def test_anything_else_is_an_input_error(value: object) -> None:
    for dimension in (*QUANTITIES, NUMBER):
        try:
            result = parse(value, dimension)
        except InputError:
            continue
        assert math.isfinite(result), f"{value!r} became {result}"


@pytest.mark.parametrize(
    ("value", "dimension", "words"),
    [
        ("0.9 kPa", LENGTH, ("0.9 kPa", "stress", "length", "m, cm, mm, um")),
        ("94 MT", FLUX_DENSITY, ("94 MT", "did you mean 'mT'", "magnetic flux density")),
        ("135 Kpa", STRESS, ("135 Kpa", "did you mean 'kPa'")),
        ("3 mm", NUMBER, ("unit 'mm'",)),
        ("3 N", MOMENT, ("force", "moment", "N m, N mm")),
        ("3 Nm", MOMENT, ("did you mean 'N m'",)),
        ("9.81 m/s2", ACCELERATION, ("did you mean 'm/s^2'",)),
        ("9.81 N", ACCELERATION, ("force", "acceleration", "m/s^2")),
        ("1.1 kg/m3", DENSITY, ("did you mean 'kg/m^3'",)),
        ("3 N mm", FORCE, ("moment", "force", "N, kN, mN")),
        ("100 Oe", REMANENCE, ("oersted", "field strength H", "kA/m or emu/cm^3")),
        ("100 Oe", FLUX_DENSITY, ("oersted", "field strength H", "flux density of 1 G")),
        ("1 kOe", STRESS, ("oersted", "stress", "Pa, kPa")),
        ("8 kA/m", FLUX_DENSITY, ("magnetisation or field strength", "1.2566 mT", "units: T, mT")),
        ("8 ka/m", REMANENCE, ("did you mean 'kA/m'",)),
        ("nan mm", LENGTH, ("not a finite number",)),
        (float("inf"), LENGTH, ("not a finite number",)),
        ("1e400 mm", LENGTH, ("not a finite number",)),
        ("1e308 GPa", STRESS, ("not a finite number",)),
        pytest.param(10**5000, NUMBER, ("not a finite number",), id="huge"),
        ("0,8 mm", LENGTH, ("decimal comma", '"0.8 mm"')),
        ("-,5e1 mm", LENGTH, ("decimal comma", '"-.5e1 mm"')),
        ("0,8", NUMBER, ("decimal comma", '"0.8"')),
        ("1/2 mm", LENGTH, ("fraction", "decimal number")),
        ("1 millimetre", LENGTH, ("did you mean 'mm'",)),
        ("90 \u00b0", ANGLE, ("did you mean 'deg'",)),
        ("1,234,567 mm", LENGTH, ("unknown unit",)),
        ("thin", LENGTH, ("does not begin with a number", '"1 mm"')),
        (30, LENGTH, ('"30 mm"',)),
        (30.0, LENGTH, ('"30 mm"',)),
        ("0.5", LENGTH, ('"0.5 mm"',)),
        (0.0011, LENGTH, ('"0.0011 m"',)),
        (303, STRESS, ('"303 kPa"',)),
        ("303e3", STRESS, ('"303e3 Pa"',)),
        (0.3, STRESS, ('"0.3 MPa"',)),
        (-143, REMANENCE, ('"-143 mT"',)),
        (1.2, REMANENCE, ('"1.2 T"',)),
        (0.05, FLUX_DENSITY, ('"0.05 T"',)),
        (90, ANGLE, ('"90 deg"',)),
        (1.57, ANGLE, ('"1.57 rad"',)),
        ("", LENGTH, ("does not begin with a number",)),
        (True, LENGTH, ("True", "length")),
        (["1 mm"], LENGTH, ("length",)),
    ],
)
def test_says_what_is_wrong(value: object, dimension: Dimension, words: tuple[str, ...]) -> None:
    with pytest.raises(InputError) as caught:
        parse(value, dimension)
    for word in words:
        assert word in str(caught.value)


@pytest.mark.parametrize(
    ("value", "dimension", "text"),
    [
        (0.9e-3, LENGTH, "0.9 mm"),
        (0.12, LENGTH, "120 mm"),
        (90e-6, LENGTH, "90 um"),
        (3.25e6, STRESS, "3.25 MPa"),
        (-50e-3, FLUX_DENSITY, "-50 mT"),
        (0.0, FLUX_DENSITY, "0"),
        (2e-3, FORCE, "2 mN"),
        (1e-5, MOMENT, "0.01 N mm"),
        (-2.5, MOMENT, "-2.5 N m"),
        (-9.81, ACCELERATION, "-9.81 m/s^2"),
        (1100.0, DENSITY, "1100 kg/m^3"),
        (math.radians(15), ANGLE, "15 deg"),
        (0.123456, NUMBER, "0.1235"),
    ],
)
def test_shows_for_people(value: float, dimension: Dimension, text: str) -> None:
    assert show(value, dimension) == text
