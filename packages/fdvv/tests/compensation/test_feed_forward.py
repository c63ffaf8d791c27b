"""The command for a known rig: fed back into its plant it gives the target; first tables, spreads."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import numpy.typing as npt
import pytest

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import Tuning
from fdvv.compensation.rig_learning import (
    command_cN,
    feedforward_cN,
    inertia_cN,
    table_change,
    tuning_of,
    unrepeatable_cN,
)
from fdvv.compensation.stroke_samples import StrokeSample
from fdvv.units import FloatArray
from tests.compensation._plant import Plant, TRAVEL_mm, known_of

GRID_mm = np.linspace(0.0, 4.0, 401)
TARGET_cN = 55.0 + 4.0 * GRID_mm + 12.0 * np.exp(-(((GRID_mm - 1.4) / 0.4) ** 2))
UNCHANGED = (np.zeros(1), np.zeros(1), np.zeros(1))
CURRENT = Plant(back_emf_N_s_m=0.0, viscous_N_s_m=0.8, electric_lag_s=1e-4)
VOLTAGE = Plant()
FRICTION_mm_s = 10.0


def rows_of(x_mm: FloatArray, v_mm_s: FloatArray, down: bool) -> npt.NDArray[np.intp]:
    """Pick one stroke, off the stops and where friction is whole."""
    moving = v_mm_s > 20.0 if down else v_mm_s < -20.0
    return np.flatnonzero(moving & (x_mm > 0.3) & (x_mm < 3.7))


def fed_back_cN(plant: Plant, velocity_mm_s: float, down: bool) -> float:
    """Return the largest error of the force, off the ends, with the wanted table fed back at one motion."""
    known = known_of(plant)
    tuning = tuning_of(known, TRAVEL_mm, 100.0, FRICTION_mm_s)
    t, x, v, a = motion = plant.motion(velocity_mm_s, tremor_mm=0.0)
    # what a press on any table would have shown of the rig itself
    coil, own = plant.forces_cN(motion, np.full(t.size, 80.0))
    rows = rows_of(x, v, down)
    stroke = StrokeSample(
        x[rows], v[rows], a[rows] / 1000, (coil + own)[rows], own[rows], 1e-3, velocity_mm_s
    )
    place, more = table_change(known, tuning, stroke, UNCHANGED, (GRID_mm, TARGET_cN))
    np.testing.assert_array_equal(place, x[rows])
    order = np.argsort(place)
    table = command_cN(known, GRID_mm, TARGET_cN) + np.interp(GRID_mm, place[order], more[order])
    # a controller that foresees place and speed without error, each as far ahead as its settings say
    late_s = known.position_lag_s
    soon, speed = (
        np.interp(t + lead_s - late_s, t, column)
        for lead_s, column in ((tuning.lead_s, x), (tuning.brake_lead_s, v))
    )
    rendered = sum(plant.forces_cN(motion, np.interp(soon, GRID_mm, table) - feedforward_cN(tuning, speed)))
    off = (rendered - np.interp(x, GRID_mm, TARGET_cN))[rows]
    return float(np.abs(off[(x[rows] > 0.6) & (x[rows] < 3.4)]).max())


@pytest.mark.parametrize("down", [True, False], ids=["press", "release"])
@pytest.mark.parametrize(("plant", "close_cN"), [(CURRENT, 0.1), (VOLTAGE, 0.7)], ids=["current", "voltage"])
def test_the_wanted_table_fed_back_gives_the_target_at_the_same_motion(
    plant: Plant, close_cN: float, down: bool
) -> None:
    assert fed_back_cN(plant, 100.0, down) < close_cN


@pytest.mark.parametrize("down", [True, False], ids=["press", "release"])
@pytest.mark.parametrize("velocity_mm_s", [50.0, 100.0, 200.0])
def test_what_is_left_goes_with_the_square_of_the_coils_lag(velocity_mm_s: float, down: bool) -> None:
    # where the gain changes along the stroke, some goes with the lag itself
    even = replace(VOLTAGE, gain=(0.95, 0.0, 0.0))
    left = [fed_back_cN(replace(even, electric_lag_s=s), velocity_mm_s, down) for s in (4e-4, 2e-4)]
    assert left[1] < 0.3 * left[0]


@pytest.mark.parametrize("velocity_mm_s", [50.0, -200.0])
def test_without_lag_the_identity_is_exact_also_for_a_changed_motion(velocity_mm_s: float) -> None:
    known = RigModel((0.9, 0.05, -0.01), 3e-4, 0.0, 5e-4, 5.0, 4.5, 3.0, 15.0, 20.0)
    tuning = tuning_of(known, TRAVEL_mm, 100.0, FRICTION_mm_s)
    random = np.random.default_rng(3)
    x, v, a = np.linspace(0.5, 3.5, 40), np.full(40, velocity_mm_s), random.normal(0, 5, 40)
    own = known.opposing_cN(v, a, x) - 0.1 * known.back_emf_N_s_m * known.gain_at(x) ** 2 * v
    change = (0.05 * random.normal(size=40), 0.1 * random.normal(size=40), random.normal(size=40))
    stroke = StrokeSample(x, v, a, np.zeros(40), own, 1e-3, abs(velocity_mm_s))
    place, more = table_change(known, tuning, stroke, change, (GRID_mm, TARGET_cN))
    wanted_cN = np.interp(place, GRID_mm, TARGET_cN)
    v2, a2 = v + change[1], a + change[2]
    command = command_cN(known, place, wanted_cN) + more - feedforward_cN(tuning, v2)
    rendered = known.gain_at(place) * command + known.opposing_cN(v2, a2, place)
    np.testing.assert_allclose(rendered, wanted_cN, atol=1e-9)


def test_a_tuning_looks_ahead_by_all_that_is_late_and_pushes_at_the_gain_of_mid_travel() -> None:
    known = known_of(VOLTAGE)
    tuning = tuning_of(known, TRAVEL_mm, 120.0, FRICTION_mm_s)
    gain = 0.85 + 2 * 0.08 - 4 * 0.012
    assert tuning.lead_s == pytest.approx(7e-4 + 2e-4 + 4e-4)
    assert tuning.brake_lead_s == pytest.approx(7e-4 + 2e-4)
    assert tuning.drag_N_s_m == pytest.approx((0.4 + 4.0 * gain**2) / gain)
    assert tuning.friction_cN == pytest.approx(5.0 / gain)
    assert (tuning.bandwidth_Hz, tuning.friction_mm_s, tuning.paced) == (120.0, FRICTION_mm_s, True)


def test_a_drag_or_friction_found_below_zero_is_not_pushed_against() -> None:
    known = RigModel(drag_N_s_m=-0.3, friction_cN=-1.0)
    tuning = tuning_of(known, TRAVEL_mm, 100.0, FRICTION_mm_s)
    assert (tuning.drag_N_s_m, tuning.friction_cN) == (0.0, 0.0)


def test_what_the_controller_adds_is_drag_and_friction_that_turns_within_its_band() -> None:
    tuning = Tuning(100.0, drag_N_s_m=2.0, friction_cN=4.0, friction_mm_s=10.0)
    added = feedforward_cN(tuning, np.array([-100.0, -5.0, 0.0, 5.0, 10.0, 100.0]))
    np.testing.assert_allclose(added, [-24.0, -3.0, 0.0, 3.0, 6.0, 24.0])


def test_faster_presses_differ_more_and_inertia_grows_with_the_square_of_speed() -> None:
    known = known_of(VOLTAGE)
    spread = [unrepeatable_cN(known, speed) for speed in (20.0, 50.0, 100.0, 200.0, 300.0)]
    assert spread == sorted(spread)
    assert unrepeatable_cN(RigModel(residual_cN=3.0), 100.0) == pytest.approx(np.hypot(3.0, 1.0))
    np.testing.assert_allclose(inertia_cN(known, np.array([50.0, 100.0, 200.0])), [1.75, 7.0, 28.0])
