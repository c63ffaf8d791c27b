"""The load cell in the cap: energy is accounted for, a push is read, and a bare finger never pulls."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fdvv.model.file import load_builtin
from fdvv.model.surface import ForceSurface
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger, PressVariability, bare
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise, silence
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import LoadCell
from fdvv.twin.simulate import simulate_program
from fdvv.twin.trace import Trace

RIG = load_rig("recommended")
TABLE = ForceSurface.of_model(load_builtin("mx-clear"), [100.0])


def pressed(step_s: float = 1e-5, audit: bool = False) -> Trace:
    finger = bare(Finger())
    gesture = plan(finger, 4e-3, 0.08)
    image = image_of(TABLE, 4.0).image
    return simulate_program(RIG, finger, gesture, image, silence(RIG, gesture), 100.0, step_s, audit)


def test_the_energy_of_a_press_is_accounted_for() -> None:
    trace = pressed(audit=True)
    assert trace.energy_J is not None
    work_J = np.sum(np.abs(0.01 * trace.force_cN[1:] * 1e-3 * np.diff(trace.displacement_mm)))
    assert np.abs(trace.energy_J).max() < 1e-3 * work_J


def test_half_the_step_gives_the_same_press() -> None:
    one, other = pressed(), pressed(5e-6)
    assert one.force_cN == pytest.approx(other.force_cN, abs=0.02)


def test_the_force_at_the_finger_never_pulls() -> None:
    finger = replace(Finger(), habit=replace(Finger().habit, lift_m=0.003))
    gesture = plan(bare(finger), 4e-3, 0.05)
    noise = draw_noise(RIG, finger, gesture, np.random.default_rng(1))
    trace = simulate_program(RIG, finger, gesture, image_of(TABLE, 4.0).image, noise, 150.0)
    assert trace.force_cN.min() >= 0
    assert trace.force_cN[-1] == 0


def test_a_finger_that_hovers_leaves_the_plate_on_the_cap() -> None:
    plant = RigPlant(RIG, Finger(habit=PressVariability(lift_m=0.003)), seed=None, stop_us=1600)
    counts = [int(plant.step(0, True, 1600)["force_counts"]) for _ in range(50)]
    assert np.ptp(counts) <= 1


def read_cN(cell: LoadCell, push_N: float) -> float:
    """Return what the board reads of a steady push against the bottom stop."""
    rig = replace(RIG, load_cell=cell)
    plant = RigPlant(rig, Finger(), seed=None, stop_us=1600)
    plant.push(push_N)
    counts = [int(plant.step(0, True, 1600)["force_counts"]) for _ in range(8000)][-500:]
    return float(100 * (np.mean(counts) - 2048) * 2 * cell.full_scale_N / 4096)


def test_a_steady_push_is_read_with_the_errors_of_the_cell() -> None:
    assert read_cN(RIG.load_cell, 1.0) == pytest.approx(100.0, abs=0.5)
    wrong = replace(RIG.load_cell, gain_error_ratio=0.1, offset_N=0.05)
    assert read_cN(wrong, 1.0) == pytest.approx(115.0, abs=0.5)
