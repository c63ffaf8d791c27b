"""Settings are refused for every field out of range and every pair at odds, by the field's number."""

from __future__ import annotations

import dataclasses
import random
import struct

import pytest

from fdvv.protocol.tables import Settings
from tests.safety._script import c_settings_check

NAMES = [field.name for field in dataclasses.fields(Settings)]


def packed(**changes: int) -> bytes:
    """Pack settings that may be out of range, which Settings itself refuses."""
    values = dataclasses.asdict(Settings()) | changes
    return struct.pack(Settings.FORMAT, *(values[name] for name in NAMES))


def refused(**changes: int) -> str:
    """Name the field that is refused; empty if none is."""
    number = c_settings_check(packed(**changes))
    return NAMES[number - 1] if number else ""


def holds(name: str, value: int) -> bool:
    """Whether a field of that type can hold the value."""
    try:
        packed(**{name: value})
    except struct.error:
        return False
    return True


def test_the_defaults_are_accepted() -> None:
    assert refused() == ""


@pytest.mark.parametrize("name", NAMES)
def test_a_field_just_out_of_range_is_refused_by_its_number(name: str) -> None:
    low, high = Settings.LIMITS[name]
    for value in (low - 1, high + 1):
        assert not holds(name, value) or refused(**{name: value}) == name
    assert holds(name, low)
    assert holds(name, high)


@pytest.mark.parametrize(
    ("name", "lower", "value"),
    [
        ("window_end_um16", "window_start_um16", 8000),
        ("supply_high_mV", "supply_low_mV", 9000),
        ("reading_high", "reading_low", 20),
        ("heat_limit_K", "derate_start_K", 60),
    ],
)
def test_an_end_must_lie_beyond_its_start(name: str, lower: str, value: int) -> None:
    assert refused(**{lower: value, name: value}) == name
    assert refused(**{lower: value, name: value + 1}) == ""


def test_the_largest_displacement_must_fit_32_bits() -> None:
    rng = random.Random(1)
    for _ in range(300):
        reads, high = rng.randint(1, 64), rng.randint(100, 65535)
        edge = min(65535, (2**32 - 1) // (reads * high))
        for gain in (edge, -edge, edge + 1, -edge - 1, rng.randint(-65535, 65535)):
            if abs(gain) <= 65535:
                fits = 0 < abs(gain) * reads * high < 2**32
                found = refused(reads=reads, reading_high=high, position_gain_q14=gain)
                assert found == ("" if fits else "position_gain_q14")


def test_a_gain_of_zero_would_hide_every_displacement() -> None:
    assert refused(position_gain_q14=0) == "position_gain_q14"
