"""Settings are refused for every field out of range and every pair at odds, by the field's number."""

from __future__ import annotations

import ctypes
import dataclasses
import random
import struct

import pytest

from fdvv.firmware.limits import limits_like, refused_because
from fdvv.protocol.tables import BoardLimits, Settings
from tests.safety._build import safety_library
from tests.safety._checks import STEEPEST, steepest_gain
from tests.safety._script import c_settings_check

NAMES = [field.name for field in dataclasses.fields(Settings)]


def packed(**changes: int) -> bytes:
    """Pack settings that may be out of range, which Settings itself refuses."""
    values = dataclasses.asdict(Settings()) | changes
    return struct.pack(Settings.FORMAT, *(values[name] for name in NAMES))


LOOSEST = BoardLimits(
    **{
        name: low if name in ("full_duty_rise_K", "tick_low_us") else high
        for name, (low, high) in BoardLimits.LIMITS.items()
    }
)
"""A board that leaves every setting its whole range."""


def refused(limits: BoardLimits = LOOSEST, /, **changes: int) -> str:
    """Name the field that is refused; empty if none is."""
    number = c_settings_check(packed(**changes), limits)
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


def test_the_largest_displacement_must_fit_19_bits() -> None:
    rng = random.Random(1)
    for _ in range(300):
        reads, high = rng.randint(1, 64), rng.randint(100, 65535)
        edge = steepest_gain(reads * high)
        assert edge * reads * high < (2**19 - 0.5) * 2**14
        assert (edge + 2) * reads * high > 2**33 - 2**14 - 2
        for gain in (edge, -edge, edge + 1, -edge - 1, rng.randint(-STEEPEST, STEEPEST)):
            if 0 < abs(gain) <= STEEPEST:
                found = refused(reads=reads, reading_high=high, position_gain_q14=gain)
                assert found == ("" if abs(gain) <= edge else "position_gain_q14")


def test_settings_that_older_firmware_took_are_taken() -> None:
    """Its displacements were a product of 32 bits, shifted by 14, from an offset of 400000 at most."""
    rng = random.Random(5)
    for _ in range(300):
        reads, high = rng.randint(1, 64), rng.randint(100, 65535)
        edge = min(65535, (2**32 - 1) // (reads * high))
        for gain in (edge, -edge):
            for offset in (-400_000, 400_000):
                rest = {"reads": reads, "reading_high": high, "position_offset_um16": offset}
                assert refused(**rest, position_gain_q14=gain) == ""


def test_a_sensor_of_25_mm_is_taken() -> None:
    gain = round(25 * 16_000 * 2**14 / (25 * 4095))
    assert gain * 25 * 4095 > 2**32
    assert refused(position_gain_q14=gain, position_offset_um16=-40_000) == ""


def test_a_gain_of_zero_would_hide_every_displacement() -> None:
    assert refused(position_gain_q14=0) == "position_gain_q14"


DEFAULT = limits_like(Settings())
BOUNDS = {
    "tick_us": (250, 1000),
    "force_limit_cN64": (None, 28_160),
    "duty_gain_q16": (None, 25_992),
    "duty_limit_q15": (None, 32_000),
    "supply_high_mV": (None, 14_000),
    "full_duty_rise_K": (596, None),
    "heat_limit_K": (None, 90),
    "host_timeout_ms": (None, 250),
}
"""What a board built for the default rig, with a lower duty limit, leaves to each of these settings."""


@pytest.mark.parametrize("name", BOUNDS)
def test_settings_may_only_be_tighter_than_the_board(name: str) -> None:
    board = dataclasses.replace(DEFAULT, duty_limit_q15=32_000)
    for bound, way in zip(BOUNDS[name], (-1, 1), strict=True):
        if bound is not None:
            assert refused(board, **{"duty_limit_q15": 32_000, name: bound}) == ""
            assert refused(board, **{"duty_limit_q15": 32_000, name: bound + way}) == name
            assert refused(board, **{"duty_limit_q15": 32_000, name: bound - way}) == ""


def test_any_other_setting_may_have_any_value_of_its_range() -> None:
    for name in set(NAMES) - set(BOUNDS) - {"nominal_supply_mV"}:
        for value in Settings.LIMITS[name]:
            assert refused(DEFAULT, **{name: value}) == refused(LOOSEST, **{name: value}), name


def test_a_higher_nominal_supply_leaves_less_duty_per_force() -> None:
    at_most = DEFAULT.duty_gain_q16 * DEFAULT.nominal_supply_mV
    for nominal_mV in (3000, 11_999, 12_001, 24_000, 48_000):
        gain = at_most // nominal_mV
        assert refused(DEFAULT, nominal_supply_mV=nominal_mV, duty_gain_q16=gain) == ""
        assert refused(DEFAULT, nominal_supply_mV=nominal_mV, duty_gain_q16=gain + 1) == "duty_gain_q16"


def test_the_largest_duty_per_force_at_the_highest_supply_does_not_overflow() -> None:
    board = dataclasses.replace(LOOSEST, nominal_supply_mV=48_000)
    assert refused(board, duty_gain_q16=2**20, nominal_supply_mV=48_000) == ""
    weak = dataclasses.replace(LOOSEST, nominal_supply_mV=3000)
    most = 2**20 * 3000 // 48_000
    assert refused(weak, duty_gain_q16=most, nominal_supply_mV=48_000) == ""
    assert refused(weak, duty_gain_q16=most + 1, nominal_supply_mV=48_000) == "duty_gain_q16"


def tightened(settings: Settings, limits: BoardLimits) -> Settings:
    """Let the C code tighten settings."""
    data = ctypes.create_string_buffer(settings.pack(), Settings.length_bytes())
    safety_library().fdvv_settings_tighten(data, ctypes.create_string_buffer(limits.pack(), 64))
    return Settings.unpack(data.raw)


def test_a_board_starts_with_settings_no_looser_than_itself() -> None:
    rng = random.Random(2)
    for _ in range(500):
        limits = BoardLimits(
            **{
                name: rng.choice([low, high, rng.randint(low, high)])
                for name, (low, high) in BoardLimits.LIMITS.items()
                if name not in ("tick_low_us", "supply_high_mV", "duty_gain_q16")
            },
            tick_low_us=50,
            supply_high_mV=rng.randint(3000, 57_000),
            duty_gain_q16=rng.randint(5000, 2**20),
        )
        started = tightened(Settings(), limits)
        assert c_settings_check(started.pack(), limits) == 0
        for name in NAMES:
            was, now = getattr(Settings(), name), getattr(started, name)
            assert now == was or name in (*BOUNDS, "derate_start_K", "supply_low_mV")
            assert now >= was if name == "full_duty_rise_K" else now <= was
    assert tightened(Settings(), DEFAULT) == Settings()


@pytest.mark.parametrize("name", BOUNDS)
def test_the_refusal_names_the_field_and_the_limit_of_the_board(name: str) -> None:
    board = dataclasses.replace(DEFAULT, duty_limit_q15=32_000, tick_high_us=900)
    for bound, way in zip(BOUNDS[name], (-1, 1), strict=True):
        if bound is not None:
            bound = min(bound, 900) if name == "tick_us" else bound
            settings = dataclasses.replace(Settings(), **{name: bound + way})
            said = refused_because(name, settings, board)
            assert f"{name} is {bound + way}" in said
            assert f"{'at least' if way < 0 else 'at most'} {bound};" in said
            assert "needs firmware built for another rig" in said
    assert "out of its range" in refused_because("window_end_um16", Settings(), DEFAULT)
