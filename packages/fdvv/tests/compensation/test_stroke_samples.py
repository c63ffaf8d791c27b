"""Motion, force on the finger and the rig's own part of it, from a record of a plant in closed form."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.compensation.identification.balance import Sensor
from fdvv.compensation.stroke_samples import StrokeSample, stroke_samples
from fdvv.model.press import Press
from fdvv.units import FloatArray
from tests.compensation._plant import FINE, Plant, TRAVEL_mm, known_of

CLEAN = Plant()
NOISY = Plant(position_noise_mm=0.003, force_noise_cN=0.3)
SENSOR = Sensor(CLEAN.filter_s, CLEAN.cone_g)
TREMOR_mm = 0.02


def made(plant: Plant, velocity_mm_s: float) -> tuple[Press, dict[str, FloatArray]]:
    """Return a press under a command that waves with 20 Hz, and the truth at its ticks."""
    t, x, v, a = motion = plant.motion(velocity_mm_s, TREMOR_mm)
    command = 70 + 10 * np.sin(2 * np.pi * 20 * t)
    coil, own = plant.forces_cN(motion, command)
    truth = {"displacement_mm": x, "velocity_mm_s": v, "acceleration_m_s2": a / 1000}
    truth |= {"rendered_cN": coil + own, "own_cN": own}
    return plant.pressed(velocity_mm_s, motion, command), {n: c[::FINE] for n, c in truth.items()}


def begins(one: StrokeSample, x_mm: FloatArray) -> int:
    """Find the row of the record where a stroke begins, by its places."""
    count = one.displacement_mm.size
    off = [np.abs(x_mm[k : k + count] - one.displacement_mm).sum() for k in range(x_mm.size - count)]
    return int(np.argmin(off))


CLOSE = {
    "displacement_mm": (0.006, 0.006),
    "velocity_mm_s": (2.0, 2.5),
    "acceleration_m_s2": (0.1, 4.0),
    "rendered_cN": (0.9, 1.1),
    "own_cN": (0.3, 0.7),
}
"""Rms, without noise and with 3 um and 0.3 cN of it per tick. The first is what the window evens out, half
its variance of 0.5 ms2 times the second derivative: 1.9 mm/s and 0.8 cN in a stroke of 200 mm/s."""


@pytest.mark.parametrize("velocity_mm_s", [50.0, 100.0, 200.0])
@pytest.mark.parametrize(("plant", "noisy"), [(CLEAN, 0), (NOISY, 1)], ids=["clean", "noisy"])
def test_motion_and_forces_are_found_again(plant: Plant, noisy: int, velocity_mm_s: float) -> None:
    press, truth = made(plant, velocity_mm_s)
    for one in stroke_samples(press, TRAVEL_mm, known_of(plant), SENSOR):
        # where a stroke turns, friction does so at once and the window cannot
        inner = slice(20, one.rendered_cN.size - 20)
        start = begins(one, truth["displacement_mm"])
        for name, column in truth.items():
            off = getattr(one, name)[inner] - column[start:][: one.rendered_cN.size][inner]
            assert np.sqrt(np.mean(off**2)) < CLOSE[name][noisy], name


def test_the_strokes_are_the_press_and_the_release_between_the_guards() -> None:
    press, truth = made(CLEAN, 100.0)
    down, up = stroke_samples(press, TRAVEL_mm, known_of(CLEAN), SENSOR)
    assert begins(down, truth["displacement_mm"]) < begins(up, truth["displacement_mm"])
    for one, sign in ((down, 1.0), (up, -1.0)):
        assert 0.1 < one.displacement_mm.min() < 0.2
        assert 3.8 < one.displacement_mm.max() < 3.9
        assert (sign * one.velocity_mm_s > 0).all()
        assert one.tick_s == pytest.approx(CLEAN.tick_s)
        # a cosine is slow where it begins: between the guards it is faster than over all
        assert 105.0 < one.speed_mm_s < 130.0


def test_half_of_the_play_is_taken_off_where_the_force_rises_or_falls() -> None:
    plant = replace(CLEAN, half_play_cN=1.5)
    press, truth = made(plant, 100.0)

    def off_cN(play_cN: float) -> float:
        known = replace(known_of(plant), play_cN=play_cN)
        found = []
        for one in stroke_samples(press, TRAVEL_mm, known, SENSOR):
            start = begins(one, truth["displacement_mm"])
            found.append(np.abs(one.rendered_cN - truth["rendered_cN"][start : start + one.rendered_cN.size]))
        return float(np.mean(np.concatenate(found)))

    assert off_cN(3.0) < 0.5 * off_cN(0.0)
