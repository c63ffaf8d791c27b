"""The compiled press against SciPy's solvers and a controller in plain Python."""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np
import pytest

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger, PressVariability
from fdvv.twin.gesture import vary
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise
from fdvv.twin.pace import solve_program_pace
from fdvv.twin.rig import Controller, Rig
from fdvv.twin.rig_moves import Coil, Mover
from tests.support.campaign import campaign
from tests.support.reference.cell_press import rms
from tests.support.reference.reference import reference_simulate
from tests.support.table_press import simulate


def compare(
    rig: Rig, finger: Finger, surface: ForceSurface, speed: float, method: Literal["DOP853", "Radau"]
) -> None:
    random = np.random.default_rng(11)
    gesture = vary(
        finger,
        0.004,
        solve_program_pace(rig, finger, image_of(surface, 4.0).image, speed),
        speed / 1000,
        random,
    )
    noise = draw_noise(rig, finger, gesture, random)
    slow = reference_simulate(rig, finger, gesture, surface, 4.0, noise, speed, method)
    fast = simulate(rig, finger, gesture, surface, 4.0, noise, speed)
    assert fast.t_s == pytest.approx(slow.t_s, abs=1e-12)
    # the bounds asked for are 1 um and 0.1 cN; kinks of a chattering contact are what is left
    assert rms(fast.displacement_mm - slow.displacement_mm) < 1e-5
    assert rms(fast.force_cN - slow.force_cN) < 0.05
    # a read on the brink of a converter step may fall either way, now and then: of the force, or one of 25
    assert fast.sensed_cN == pytest.approx(slow.sensed_cN, abs=981 / 1024 + 1e-9)
    assert np.mean(fast.sensed_cN != slow.sensed_cN) < 0.01
    step_mm = 12.7 / 4096 / 25 + 1 / 16000
    assert fast.sensed_mm == pytest.approx(slow.sensed_mm, abs=1.01 * step_mm)
    assert np.mean(np.abs(fast.sensed_mm - slow.sensed_mm) > 1e-9) < 0.02
    assert fast.commanded_cN == pytest.approx(slow.commanded_cN, abs=100 * step_mm)
    assert np.array_equal(fast.release, slow.release > 0.5)


@pytest.mark.parametrize("speed", [pytest.param(50.0, marks=pytest.mark.slow), 200.0])
def test_a_press_agrees_with_the_reference_within_a_tenth_of_a_centinewton(
    tactile: ForceSurface, speed: float
) -> None:
    compare(Rig(), Finger(), tactile, speed, "DOP853")


@pytest.mark.slow
def test_a_current_driven_press_that_hits_the_cap_agrees_too(tactile: ForceSurface) -> None:
    rig = Rig(coil=Coil(drive="current"), controller=Controller(averaging="sliding", average_ticks=5))
    compare(rig, Finger(habit=PressVariability(lift_m=0.001)), tactile, 150.0, "DOP853")


@pytest.mark.slow
@campaign("speed", [50.0, 100.0, 150.0, 200.0], part=1)
def test_a_press_agrees_with_an_implicit_solver(tactile: ForceSurface, speed: float) -> None:
    # an implicit solver steps over the corners of the friction: without it the two can be compared
    rig = Rig(mover=Mover(coulomb_N=0.0))
    compare(rig, Finger(), tactile, speed, "Radau")


def test_halving_the_step_changes_a_press_by_less_than_a_thousandth_of_a_centinewton(
    tactile: ForceSurface,
) -> None:
    rig, finger = Rig(), Finger(habit=replace(PressVariability(), lift_m=0.0).still())
    random = np.random.default_rng(0)
    gesture = vary(finger, 0.004, 0.08, 0.1, random)
    noise = draw_noise(rig, finger, gesture, random)
    coarse, fine = (simulate(rig, finger, gesture, tactile, 4.0, noise, 100.0, h) for h in (1e-5, 5e-6))
    down = coarse.t_s < gesture.onset_s + gesture.press_s
    assert rms((coarse.force_cN - fine.force_cN)[down]) < 1e-3
