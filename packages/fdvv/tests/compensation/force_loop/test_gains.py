"""The constants that the firmware gets: a stable estimator, and numbers of the identified rig."""

from __future__ import annotations

import math
from dataclasses import asdict, replace

import numpy as np
import pytest

from fdvv.compensation.force_loop.constants import of_earlier_version
from fdvv.compensation.force_loop.gains import estimator_gains, force_loop_gains, rate
from fdvv.compensation.force_loop.stability import LoopController
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import ModelError
from fdvv.protocol.tables import CellSpec

CELL = CellSpec(plate_kg=4e-4, stiffness_N_m=5e5, damping_N_s_m=1.4, filter_s=4e-5)
RIG = RigModel(
    gain=(0.95, 0.02, -0.003),
    delay_s=1.3e-4,
    electric_lag_s=5e-5,
    position_lag_s=5.5e-4,
    drag_N_s_m=0.4,
    friction_cN=3.0,
    weight_cN=11.8,
    mass_g=11.6,
    position_noise_mm=0.01,
)
CONTROLLER = LoopController(4.0, 1e-3, 4000.0, 0.4, 12.0, 300.0)


@pytest.mark.parametrize("late_s", [0.0, 1e-4, 5e-4, 2e-3])
def test_the_estimator_forgets_a_wrong_start(late_s: float) -> None:
    tick_s, mass_kg = 1e-4, 0.0116
    gains = estimator_gains(tick_s, late_s, mass_kg, 1e-5, 0.05)
    late, h = rate(tick_s, late_s), tick_s
    motion = np.array(
        [[1, h, 0.5 * h * h / mass_kg, 0], [0, 1, h / mass_kg, 0], [0, 0, 1, 0], [late, 0, 0, 1 - late]]
    )
    error = motion @ (np.eye(4) - np.outer(gains, [0, 0, 0, 1]))
    assert np.abs(np.linalg.eigvals(error)).max() < 1


def test_a_less_noisy_sensor_is_believed_more() -> None:
    quiet, loud = (estimator_gains(1e-4, 5e-4, 0.0116, noise, 0.05) for noise in (2e-6, 2e-5))
    assert quiet[0] > loud[0]
    assert quiet[3] > loud[3]


def test_every_constant_comes_from_the_rig_the_cell_and_the_controller() -> None:
    gains = force_loop_gains(RIG, CELL, 1e-4, CONTROLLER)
    assert gains.lead_s == pytest.approx(1.3e-4 + 4e-5)
    assert gains.mass_kg == pytest.approx(0.0116)
    assert gains.own_N == pytest.approx((-0.118,) * 8)
    assert (gains.gain, gains.gain_1_m, gains.gain_1_m2) == pytest.approx((0.95, 20.0, -3000.0))
    assert gains.compute_ratio == pytest.approx(0.3)
    assert gains.position_rate == pytest.approx(rate(1e-4, 5.1e-4))
    assert gains.lowpass_rate == pytest.approx(-math.expm1(-2 * math.pi * 0.4))
    assert gains.brake_N_s_m == 0.0


def test_a_coil_driven_by_a_voltage_brakes_and_its_braking_is_not_led() -> None:
    gains = force_loop_gains(replace(RIG, drag_N_s_m=5.2, back_emf_N_s_m=4.8), CELL, 1e-4, CONTROLLER)
    assert (gains.drag_N_s_m, gains.brake_N_s_m) == pytest.approx((0.4, 4.8))
    assert gains.velocity_lead_s == pytest.approx(gains.lead_s - 5e-5)


def test_the_rig_s_own_force_is_kept_at_eight_even_steps() -> None:
    sloped = replace(RIG, own_cN=(-14.0, 0.0, 14.0), own_step_mm=2.0)
    gains = force_loop_gains(sloped, CELL, 1e-4, CONTROLLER)
    assert gains.own_N == pytest.approx([0.01 * (force - 11.8) for force in range(-14, 15, 4)])
    assert gains.own_per_m == pytest.approx(7 / 4e-3)
    bent = replace(RIG, own_cN=tuple(6.0 * np.sin(np.arange(17) * 0.4)), own_step_mm=0.25)
    gains = force_loop_gains(bent, CELL, 1e-4, CONTROLLER)
    x_mm = np.linspace(0.0, 4.0, 50)
    kept = 100 * np.interp(1e-3 * x_mm * gains.own_per_m, np.arange(8), gains.own_N)
    assert np.abs(kept - bent.own_at(x_mm)).max() < 0.5


def test_gains_of_a_file_that_knows_a_weight_alone_become_a_constant_own_force() -> None:
    now = asdict(force_loop_gains(RIG, CELL, 1e-4, CONTROLLER))
    before = {name: value for name, value in now.items() if name not in ("own_N", "own_per_m")}
    del before["friction_m"]
    found = of_earlier_version({**before, "weight_N": 0.118, "friction_m_s": 0.01})
    assert found["own_N"] == pytest.approx([-0.118] * 8)
    assert set(found) == set(now)
    assert of_earlier_version(now) == now
    with pytest.raises(ModelError, match="own_N has 8 numbers"):
        replace(force_loop_gains(RIG, CELL, 1e-4, CONTROLLER), own_N=(0.0,))
