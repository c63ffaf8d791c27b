"""From readings to a displacement and a direction."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.firmware.core import Core
from fdvv.protocol.tables import Settings, TickFlag
from tests.support.inputs import inputs_at, inputs_like


@given(
    gain=st.integers(-262143, 262143).filter(bool), offset=st.integers(-400000, 400000), part=st.floats(0, 1)
)
def test_the_displacement_is_the_scaled_sum_to_the_nearest(gain: int, offset: int, part: float) -> None:
    settings = replace(Settings(), position_gain_q14=gain, position_offset_um16=offset, reads=64)
    total = int(part * min((2**33 - 2**14) // abs(gain), 64 * 65535))
    found = int(Core(unchecked(settings)).run(inputs_like(settings, [total]))["displacement_um16"][0])
    assert abs(found - offset - gain * total / 2**14) <= 0.5


def unchecked(settings: Settings) -> Settings:
    """Bound single readings so that the largest sum keeps the product below 2^33."""
    largest = (2**33 - 2**16) // ((abs(settings.position_gain_q14) + 1) * settings.reads)
    return replace(settings, reading_low=0, reading_high=max(1, min(65535, largest)))


@pytest.mark.parametrize("ticks", range(2, 33))
def test_a_sliding_mean_is_exact(ticks: int) -> None:
    settings = replace(Settings(), sliding_ticks=ticks)
    sums = np.random.default_rng(ticks).integers(600, 100000, 300)
    raw = Core().run(inputs_like(Settings(), sums))["displacement_um16"].astype(int)
    found = Core(settings).run(inputs_like(settings, sums))["displacement_um16"]
    for k, mean in enumerate(found):
        newest = raw[max(0, k - ticks + 1) : k + 1]
        assert mean == (newest.sum() + len(newest) // 2) // len(newest)


def strokes(path_mm: list[float]) -> list[bool]:
    flags = Core().run(inputs_at(Settings(), path_mm))["flags"]
    return [bool(f & TickFlag.RELEASE) for f in flags]


def test_the_way_back_turns_a_press_into_a_release_and_again() -> None:
    path_mm = [0.5, 1.0, 0.95, 0.901, 0.899, 0.95, 0.998, 1.001]
    assert strokes(path_mm) == [False] * 4 + [True] * 3 + [False]


def test_a_hover_within_the_reversal_never_turns() -> None:
    rng = np.random.default_rng(3)
    assert not any(strokes(list(1.0 + rng.uniform(-0.049, 0.049, 500))))


def test_a_new_press_begins_near_the_top() -> None:
    assert strokes([0.5, 0.2, 0.15, 0.101, 0.099, 0.2]) == [False, True, True, True, False, False]


def test_the_way_back_counts_from_the_deepest_point() -> None:
    assert strokes([1.0, 1.05, 1.02, 1.06, 0.97, 0.9599, 0.9]) == [False] * 5 + [True, True]
