"""The two strokes of a press."""

import numpy as np
import pytest

from fdvv.compensation.presses import mean_speed_mm_s, split_strokes, why_incomplete
from fdvv.units import FloatArray

T = np.arange(0.0, 0.301, 0.001)


def record(*corners: tuple[float, float]) -> FloatArray:
    """Make displacement from (time, displacement) corners."""
    times, places = zip(*corners, strict=True)
    return np.asarray(np.interp(T, times, places))


PRESS = record((0.0, 0.0), (0.02, 0.0), (0.10, 4.0), (0.15, 4.0), (0.25, 0.0), (0.3, 0.0))


def test_a_plain_press_is_one_way_down_and_one_way_up() -> None:
    press, release = split_strokes(PRESS, 4.0)
    assert PRESS[press.start] == pytest.approx(0.15)
    assert PRESS[press.stop - 1] == pytest.approx(3.85)
    assert PRESS[release.start] < 3.9 <= PRESS[release.start - 1]
    assert PRESS[release.stop - 1] > 0.1 >= PRESS[release.stop]


def test_a_bounce_at_the_stop_belongs_to_neither_stroke() -> None:
    x = record((0.0, 0.0), (0.08, 4.02), (0.09, 3.6), (0.1, 4.0), (0.15, 4.0), (0.25, 0.0))
    press, release = split_strokes(x, 4.0)
    assert press.stop <= 80
    assert release.start >= 150


def test_a_false_start_belongs_to_neither_stroke() -> None:
    x = record((0.0, 0.0), (0.02, 0.6), (0.04, 0.0), (0.1, 4.0), (0.15, 4.0), (0.25, 0.0))
    press, _ = split_strokes(x, 4.0)
    assert press.start > 40


def test_a_release_ends_where_the_cap_stays() -> None:
    x = record((0.0, 0.0), (0.1, 4.0), (0.15, 4.0), (0.2, 2.0), (0.3, 2.0))
    _, release = split_strokes(x, 4.0)
    assert x[release.stop - 1] == pytest.approx(2.12, abs=0.05)


def test_a_cap_that_never_leaves_the_stop_has_no_release() -> None:
    x = record((0.0, 0.0), (0.1, 4.0), (0.3, 4.0))
    _, release = split_strokes(x, 4.0)
    assert release.start == release.stop


def test_the_mean_speed_is_length_over_time_and_positive() -> None:
    press, release = split_strokes(PRESS, 4.0)
    assert mean_speed_mm_s(T, PRESS, press) == pytest.approx(50.0)
    assert mean_speed_mm_s(T, PRESS, release) == pytest.approx(40.0)
    assert np.isnan(mean_speed_mm_s(T, PRESS, slice(3, 4)))


def test_a_press_that_starts_deep_says_so() -> None:
    assert "rested at 3.00 mm" in why_incomplete(record((0.0, 3.0), (0.1, 4.0), (0.2, 0.0)), 4.0)
