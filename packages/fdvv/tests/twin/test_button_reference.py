"""The compiled button beside adaptive solvers that share no code with it."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from fdvv.twin.button import ButtonPhysics
from fdvv.twin.draw import draw_finger
from fdvv.twin.files import button_names, load_button
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import ButtonNoise, ButtonTrace, draw_button_noise, simulate_button
from tests.support.campaign import campaign
from tests.support.drawn_button import draw_button
from tests.support.reference.button import reference_button
from tests.support.reference.cell_press import rms

Call = tuple[ButtonPhysics, Finger, Gesture, ButtonNoise, ForceSensor | None]


def a_plan(name: str, press_s: float, sensor: ForceSensor | None, seed: int = 1) -> Call:
    button, finger = load_button(name), Finger()
    gesture = plan(finger, button.curve.travel_m, press_s)
    noise = draw_button_noise(finger, gesture, np.random.default_rng(seed), sensor)
    return button, finger, gesture, noise, sensor


def agrees(call: Call, method: str = "DOP853", rtol: float = 1e-8) -> None:
    trace = simulate_button(*call)
    reference = reference_button(*call, method, rtol)  # type: ignore[arg-type]
    assert np.abs(trace.displacement_mm - reference.displacement_mm).max() < 1e-3
    assert rms(trace.force_cN - reference.force_cN) < 0.1
    assert np.abs(trace.leaf_mm - reference.leaf_mm).max() < 2e-3


@pytest.mark.parametrize(
    ("name", "sensor"), [("mx-clear", ForceSensor()), ("macbook-pro-2011", None)], ids=["leaf", "dome"]
)
def test_a_fast_press_agrees_with_the_adaptive_solver(name: str, sensor: ForceSensor | None) -> None:
    agrees(a_plan(name, 0.04, sensor))


@pytest.mark.slow
@campaign("name", button_names(), part=3)
@pytest.mark.parametrize(("method", "rtol"), [("DOP853", 1e-8), ("Radau", 1e-7)])
def test_every_button_agrees_with_two_adaptive_solvers(name: str, method: str, rtol: float) -> None:
    agrees(a_plan(name, 0.05, ForceSensor()), method, rtol)


@pytest.mark.slow
@campaign("name", button_names(), part=3)
def test_every_button_under_a_bare_finger_agrees_with_the_adaptive_solver(name: str) -> None:
    agrees(a_plan(name, 0.12, None))


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_drawn_buttons_and_fingers_agree_with_the_adaptive_solver(seed: int) -> None:
    random = np.random.default_rng(seed)
    button = draw_button(load_button(button_names()[seed]), random)
    finger, sensor = draw_finger(random), ForceSensor()
    gesture = plan(finger, button.curve.travel_m, 0.08)
    agrees((button, finger, gesture, draw_button_noise(finger, gesture, random, sensor), sensor))


def test_presses_on_several_threads_are_those_of_one() -> None:
    calls = [a_plan("mx-brown", 0.03 + 0.002 * i, ForceSensor(), i) for i in range(8)]

    def press(call: Call) -> ButtonTrace:
        return simulate_button(*call)

    alone = [press(call) for call in calls]
    with ThreadPoolExecutor(3) as pool:
        for a, b in zip(pool.map(press, calls * 3), alone * 3, strict=True):
            assert np.array_equal(a.force_cN, b.force_cN)
    assert len({trace.t_s.size for trace in alone}) > 1
