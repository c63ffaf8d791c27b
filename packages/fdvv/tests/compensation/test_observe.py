"""What a press teaches, with and without known delays."""

import numpy as np
import pytest

from fdvv.compensation.identification.balance import Delays, observe
from fdvv.compensation.tables import bin_force, grid_mm
from fdvv.errors import ModelError

GRID = grid_mm(4.0, 0.05)
TARGET = 50 + 20 * np.sin(GRID)
T = np.arange(0.0, 0.04, 0.0001)
SPAN = slice(30, 370)


def test_without_delays_the_force_is_binned_as_sensed() -> None:
    x, force = T * 100, np.cos(T * 50)
    found = observe(T, x, force, SPAN, TARGET, GRID, Delays())
    np.testing.assert_array_equal(found, bin_force(x[SPAN], force[SPAN], GRID))


def test_with_the_true_delays_an_error_is_filed_under_the_command_that_made_it() -> None:
    speed, position_s, command_s = 100.0, 0.001, 0.002
    sensed = speed * (T - position_s)
    # rendered: the target where the cap truly is, and a bump that the table put at 2 mm
    commanded_at = speed * (T - position_s - command_s)
    rendered = np.interp(speed * T, GRID, TARGET) - 10 * (np.abs(commanded_at - 2.0) < 0.2)
    found = observe(T, sensed, rendered, SPAN, TARGET, GRID, Delays(position_s, command_s))
    shortfall = TARGET - found
    inside, outside = np.abs(GRID - 2.0) < 0.15, np.abs(GRID - 2.0) > 0.25
    np.testing.assert_allclose(shortfall[inside], 10.0, atol=0.05)
    np.testing.assert_allclose(shortfall[outside & np.isfinite(shortfall)], 0.0, atol=0.05)


def test_without_them_the_error_is_filed_too_deep() -> None:
    speed, lag_s = 100.0, 0.003
    sensed = speed * T
    rendered = np.interp(sensed, GRID, TARGET) - 10 * (np.abs(sensed - speed * lag_s - 2.0) < 0.2)
    shortfall = TARGET - observe(T, sensed, rendered, SPAN, TARGET, GRID, Delays())
    found = GRID[np.nan_to_num(shortfall) > 5].mean()
    assert found == pytest.approx(2.0 + speed * lag_s, abs=0.05)


def test_a_delay_beyond_any_rig_is_refused() -> None:
    with pytest.raises(ModelError, match=r"0\.1 s"):
        Delays(0.2, 0.0)
