from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.errors import ModelError
from fdvv.model.vibration import Mode, Vibration

SNAP = Mode(239.0, 4.6, 130.7, 0.3)


def vibration(*modes: Mode, **fields: Any) -> Vibration:
    whole: dict[str, Any] = {"stroke": "press", "velocity_mm_s": None, "onset_mm": 2.3, "duration_s": 0.016}
    return Vibration(**{**whole, **fields}, modes=modes)


@given(st.floats(0, 0.016))
def test_a_single_mode_is_its_closed_form(t: float) -> None:
    expected = 4.6 * np.exp(-130.7 * t) * np.sin(2 * np.pi * 239.0 * t + 0.3)
    assert float(vibration(SNAP).acceleration_m_s2(t)) == pytest.approx(expected, abs=1e-12)


def test_modes_add_up() -> None:
    t, other = np.linspace(-0.01, 0.03, 200), Mode(560.0, 1.2, 40.0)
    both = vibration(SNAP, other).acceleration_m_s2(t)
    apart = vibration(SNAP).acceleration_m_s2(t) + vibration(other).acceleration_m_s2(t)
    np.testing.assert_allclose(both, apart, rtol=0, atol=1e-12)


def test_there_is_silence_before_the_onset_and_after_the_end() -> None:
    t = [-1e3, -1e-9, 0.0160001, 1.0, 1e6]
    np.testing.assert_array_equal(vibration(SNAP).acceleration_m_s2(t), 0.0)


@pytest.mark.parametrize(
    "numbers",
    [(0, 1, 1), (-1, 1, 1), (np.nan, 1, 1), (1, np.inf, 1), (1, 1, -1), (1, 1, np.nan), (1, 1, 1, np.nan)],
)
def test_numbers_that_are_no_mode_are_refused(numbers: tuple[float, ...]) -> None:
    with pytest.raises(ModelError, match="a mode needs a positive frequency and a decay of at least 0"):
        Mode(*numbers)


@pytest.mark.parametrize(
    ("fields", "said"),
    [
        ({"velocity_mm_s": 0.0}, "velocity_mm_s must be positive and finite, got 0.0"),
        ({"onset_mm": np.nan}, "onset_mm must be finite, got nan"),
        ({"duration_s": 0.0}, "duration_s must be positive, got 0.0"),
        ({"duration_s": np.inf}, "duration_s must be positive, got inf"),
    ],
)
def test_numbers_that_are_no_vibration_are_refused(fields: dict[str, Any], said: str) -> None:
    with pytest.raises(ModelError, match=said):
        vibration(SNAP, **fields)


def test_a_vibration_without_a_mode_is_refused() -> None:
    with pytest.raises(ModelError, match="at least one mode"):
        vibration()
