"""Eq. 3 and the gain that follows from it."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.compensation.method import error_cN
from fdvv.compensation.tables import GainSchedule
from fdvv.errors import ModelError


def test_the_error_is_the_weighted_mean_and_largest_deviation() -> None:
    target, rendered = np.array([10.0, 20.0, 30.0, 40.0]), np.array([11.0, 18.0, 30.0, 45.0])
    # |d| = 1, 2, 0, 5: mean 2, largest 5
    assert error_cN(target, rendered, 0.7) == pytest.approx(0.7 * 2 + 0.3 * 5)
    assert error_cN(target, rendered, 1.0) == pytest.approx(2.0)
    assert error_cN(target, rendered, 0.0) == pytest.approx(5.0)


def test_bins_that_were_not_visited_do_not_count() -> None:
    assert error_cN(np.array([1.0, 2.0]), np.array([np.nan, 5.0])) == pytest.approx(3.0)


def test_an_error_of_nothing_is_refused() -> None:
    with pytest.raises(ModelError, match="no bin"):
        error_cN(np.array([1.0]), np.array([np.nan]))


def test_the_gain_is_its_most_far_above_the_floor_and_its_least_on_it() -> None:
    schedule = GainSchedule(0.6, 0.1, 3.0)
    assert schedule.gain(1e6) == pytest.approx(0.6)
    assert schedule.gain(6.0) == pytest.approx(0.6 * 0.75)
    assert schedule.gain(3.0) == schedule.gain(0.0) == 0.1


@given(st.floats(0.01, 1e3), st.floats(0.01, 1e3))
def test_the_gain_never_falls_as_the_error_rises(a: float, b: float) -> None:
    schedule = GainSchedule(0.6, 0.1, 3.0)
    assert schedule.gain(min(a, b)) <= schedule.gain(max(a, b))


@pytest.mark.parametrize("numbers", [(0.1, 0.5, 0.0), (2.5, 0.1, 0.0), (0.5, -0.1, 0.0), (0.5, 0.1, -1.0)])
def test_gains_that_cannot_converge_are_refused(numbers: tuple[float, float, float]) -> None:
    with pytest.raises(ModelError):
        GainSchedule(*numbers)
