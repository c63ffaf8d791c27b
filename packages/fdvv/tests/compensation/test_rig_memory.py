"""What a rig has taught, asked for other places, speeds and travels."""

from __future__ import annotations

import numpy as np

from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.model.surface import ForceSurface

GRID_mm = np.arange(81, dtype=np.float64) * 0.05
SPEEDS_mm_s = np.array([50.0, 100.0, 200.0])
ROWS_cN = SPEEDS_mm_s[:, np.newaxis] ** 2 * 1e-4 + GRID_mm
MEMORY = LearnedRig(
    RigModel(mass_g=12.0),
    ForceSurface(GRID_mm, SPEEDS_mm_s, ROWS_cN, -ROWS_cN),
    4.0,
    np.array([[1.0, 2.0, 5.0], [2.0, 3.0, 6.0]]),
)


def test_on_its_own_grid_and_speeds_it_is_what_was_learned() -> None:
    press, release = MEMORY.rows_cN(GRID_mm, SPEEDS_mm_s, 4.0)
    np.testing.assert_allclose(press, ROWS_cN)
    np.testing.assert_allclose(release, -ROWS_cN)
    np.testing.assert_array_equal(MEMORY.error_at_cN(SPEEDS_mm_s), MEMORY.error_cN)


def test_between_speeds_it_is_straight_in_their_square_and_the_last_row_holds() -> None:
    press, _ = MEMORY.rows_cN(GRID_mm, np.array([150.0, 400.0]), 4.0)
    np.testing.assert_allclose(press[0], 150.0**2 * 1e-4 + GRID_mm)
    np.testing.assert_allclose(press[1], ROWS_cN[2])


def test_below_the_slowest_it_goes_to_one_level_at_rest() -> None:
    press, _ = MEMORY.rows_cN(GRID_mm, np.array([1e-3, 20.0]), 4.0)
    # drawn on to speed 0 the rows leave the grid's own places, 2 in the middle
    np.testing.assert_allclose(press[0], 2.0, atol=1e-6)
    np.testing.assert_allclose(press[1], 0.84 * 2.0 + 0.16 * ROWS_cN[0])


def test_the_error_to_expect_is_straight_between_speeds_and_holds_outside() -> None:
    expected = MEMORY.error_at_cN(np.array([20.0, 75.0, 400.0]))
    np.testing.assert_allclose(expected, [[1.0, 1.5, 5.0], [2.0, 2.5, 6.0]])


def test_on_another_travel_places_are_scaled() -> None:
    grid = np.arange(61, dtype=np.float64) * 0.05
    press, _ = MEMORY.rows_cN(grid, SPEEDS_mm_s[:1], 3.0)
    np.testing.assert_allclose(press[0], 0.25 + grid * 4.0 / 3.0)


def test_a_rig_met_at_one_speed_gives_its_row_at_every_speed() -> None:
    one = ForceSurface(GRID_mm, SPEEDS_mm_s[:1], ROWS_cN[:1], ROWS_cN[:1])
    press, _ = LearnedRig(RigModel(), one, 4.0, np.ones((2, 1))).rows_cN(GRID_mm, SPEEDS_mm_s, 4.0)
    np.testing.assert_allclose(press, np.repeat(ROWS_cN[:1], 3, axis=0))
