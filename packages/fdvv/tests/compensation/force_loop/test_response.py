"""The answer of the closed loop to its target, against the equations of motion, and learning with it."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from fdvv.compensation.force_loop.gains import design_controller
from fdvv.compensation.force_loop.response import LoopResponse, SLOPE_N_m
from fdvv.compensation.force_loop.stability import HeldFinger, LoopController, LoopPlant

PLANT = LoopPlant(0.012, 4e-4, 0.5, 5e5, 20.0, 5e-5, 4e-5, 8e-5)
TICK_s = 1e-4


@pytest.fixture(scope="module")
def response() -> LoopResponse:
    return LoopResponse(PLANT, design_controller(PLANT))


@pytest.mark.parametrize("frequency_Hz", [20.0, 70.0, 150.0])
def test_an_open_loop_under_a_stiff_pad_answers_as_its_equation_of_motion(frequency_Hz: float) -> None:
    mass_kg, joint_kg, damping_N_s_m, stiffness_N_m = 0.012, 0.006, 5.0, 700.0
    # a pad and a cell that do not give way: the joint moves with the cap
    finger = HeldFinger(joint_kg, stiffness_N_m, damping_N_s_m, 1e9, 1.0, 1.0, 0.0, 1.0, fresh=True)
    plant = LoopPlant(mass_kg, 0.0, 0.0, 1e12, 0.0, 1e-9, 1e-9, 0.0)
    idle = LoopController(0.0, 0.0, 1e6, 0.0, 0.0, 1.0)
    turn = 2 * np.pi * frequency_Hz

    def rates(t_s: float, state: np.ndarray) -> list[float]:
        x, v = state
        coil_N = SLOPE_N_m * x + 0.01 * np.sin(turn * t_s)
        return [v, -(coil_N + stiffness_N_m * x + damping_N_s_m * v) / (mass_kg + joint_kg)]

    t = np.linspace(1.0, 1.0 + 4 / frequency_Hz, 2000)
    x, v = solve_ivp(rates, (0.0, t[-1]), [0.0, 0.0], t_eval=t, rtol=1e-9, atol=1e-12).y
    a = np.array([rates(time, state)[1] for time, state in zip(t, np.stack([x, v], 1), strict=True)])
    felt_N = -(joint_kg * a + damping_N_s_m * v + stiffness_N_m * x)
    waves = np.stack([np.sin(turn * t), np.cos(turn * t)], 1)
    part = np.linalg.lstsq(waves, (felt_N - SLOPE_N_m * x) / 0.01, rcond=None)[0]
    found = LoopResponse(plant, idle, (finger,)).follows(np.array([frequency_Hz]))[0, 0]
    assert found == pytest.approx(complex(*part), rel=2e-3)


def test_an_error_that_changes_slowly_is_its_own_correction(response: LoopResponse) -> None:
    t = np.arange(4000) * TICK_s
    error = np.sin(2 * np.pi * 8.0 * t) * np.hanning(t.size)
    assert response.correction(error, TICK_s) == pytest.approx(error, abs=0.01)


def test_learning_is_safe_on_every_finger_where_the_error_itself_would_grow(response: LoopResponse) -> None:
    t = np.arange(2000) * TICK_s
    growth, of_the_error_itself = {}, {}
    for frequency_Hz in (20.0, 60.0, 100.0, 150.0, 200.0, 250.0):
        answers = response.follows(np.array([frequency_Hz]))[:, 0]
        wave = np.exp(-(((t - 0.1) / 0.03) ** 2)) * np.cos(2 * np.pi * frequency_Hz * (t - 0.1))
        gain = response.correction(wave, TICK_s)[1000] / wave[1000]
        growth[frequency_Hz] = np.abs(1 - 0.7 * gain * answers).max()
        of_the_error_itself[frequency_Hz] = np.abs(1 - 0.7 * answers).max()
    assert max(growth[20.0], growth[60.0]) < 0.6
    assert max(growth.values()) < 1.25
    assert max(of_the_error_itself.values()) > 1.6


def test_the_correction_of_a_kick_begins_before_it(response: LoopResponse) -> None:
    kick = np.zeros(1000)
    kick[500:520] = 1.0
    correction = response.correction(kick, TICK_s)
    assert np.abs(correction[450:500]).max() > 0.05
    assert np.abs(correction[:200]).max() < 0.01
