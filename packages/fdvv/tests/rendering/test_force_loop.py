"""The recommended rig: identified, its loop closed, learned, judged on fresh presses. Simulated."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.compensation.rig_aware import RigAware
from fdvv.device.boards import LibraryBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import SimulatedPerson, TwinDevice
from fdvv.errors import DeviceError
from fdvv.model.file import load_builtin
from fdvv.model.press import Press
from fdvv.rendering.actuation_file import load_actuation, save_actuation
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.probe import ProbeResult, probe
from fdvv.rendering.session import Session
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger, FingerPad, Impedance, bare
from fdvv.twin.gesture import Gesture, depth_m, plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise
from fdvv.twin.simulate import simulate_program
from fdvv.units import FloatArray

RIG = load_rig("recommended")
CLEAR = load_builtin("mx-clear")
SPEEDS = [50.0, 100.0]


@pytest.fixture(scope="module")
def learned() -> CompensationResult:
    return compensate(TwinDevice(RIG, seed=1), CLEAR, SPEEDS, RigAware())


def judged(surface_of: CompensationResult, seed: int = 91) -> ProbeResult:
    device = TwinDevice(RIG, seed=seed)
    return probe(device, CLEAR, surface_of.surface, SPEEDS, 4, tuning=surface_of.outcome.tuning)


def means(result: ProbeResult) -> list[float]:
    return [curve.outcome.mean_error_cN for curve in result.curves]


def test_fresh_presses_are_within_a_centinewton_and_a_half(learned: CompensationResult) -> None:
    result = judged(learned)
    assert max(means(result)) < 1.5
    assert max(curve.outcome.max_error_cN for curve in result.curves) < 8.0


def test_the_loop_beats_the_tables_on_the_same_rig(learned: CompensationResult) -> None:
    job = learned.outcome
    assert job.tuning.loop is not None
    opened = TwinDevice(RIG, seed=91)
    tables = probe(opened, CLEAR, learned.surface, SPEEDS, 4)
    assert max(means(judged(learned))) < 0.5 * min(means(tables))


@pytest.mark.slow
def test_the_firmware_over_the_wire_learns_what_the_twin_learns(learned: CompensationResult) -> None:
    def linked(seed: int) -> LinkedDevice:
        return LinkedDevice(LibraryBoard(), SimulatedPerson(RIG, seed=seed))

    found = compensate(linked(1), CLEAR, SPEEDS, RigAware())
    gains, wanted = found.outcome.tuning.loop, learned.outcome.tuning.loop
    assert gains is not None
    assert wanted is not None
    assert gains.mass_kg == pytest.approx(wanted.mass_kg, rel=0.03)
    assert gains.own_N == pytest.approx(wanted.own_N, abs=0.01)
    result = probe(linked(91), CLEAR, found.surface, SPEEDS, 4, tuning=found.outcome.tuning)
    assert max(means(result)) < 2.0


def test_a_known_rig_needs_no_press(learned: CompensationResult) -> None:
    known = RigAware(0, learned.learned_rig)
    fresh = compensate(TwinDevice(RIG, seed=2), CLEAR, SPEEDS, known)
    assert fresh.presses == 0
    assert max(means(judged(fresh))) < 2.0


def test_an_actuation_file_keeps_the_loop(learned: CompensationResult, tmp_path: Path) -> None:
    save_actuation(learned, tmp_path / "clear.actuation.json")
    assert load_actuation(tmp_path / "clear.actuation.json").outcome.tuning == learned.outcome.tuning


def test_a_session_continues_where_it_stopped(learned: CompensationResult, tmp_path: Path) -> None:
    class Leaves(TwinDevice):
        left = 6

        def press(self, velocity_mm_s: float) -> Press:
            if not self.left:
                raise KeyboardInterrupt
            self.left -= 1
            return super().press(velocity_mm_s)

    with pytest.raises(KeyboardInterrupt):
        compensate(Leaves(RIG, seed=1), CLEAR, SPEEDS, RigAware(), session=Session(tmp_path / "s"))
    again = compensate(TwinDevice(RIG, seed=3), CLEAR, SPEEDS, RigAware(), session=Session(tmp_path / "s"))
    assert again.presses == 10
    assert again.outcome.tuning.loop == learned.outcome.tuning.loop


def test_a_rig_without_a_cell_refuses_an_actuation_of_a_loop(learned: CompensationResult) -> None:
    with pytest.raises(DeviceError, match="no load cell"):
        probe(TwinDevice(seed=1), CLEAR, learned.surface, SPEEDS, 1, tuning=learned.outcome.tuning)


FINGERS = {
    "soft": Finger(Impedance(0.0035, 180.0, 2.5), FingerPad(0.08, 2000.0, 0.2)),
    "middle": Finger(),
    "stiff": Finger(Impedance(0.0087, 1700.0, 7.4), FingerPad(0.15, 4000.0, 0.4)),
    "nail": Finger(Impedance(0.0087, 1255.0, 4.0), FingerPad(0.15, 15000.0, 0.9)),
    "hand": Finger(Impedance(0.05, 5000.0, 30.0)),
}


def ripple_cN(t_s: FloatArray, force_cN: FloatArray) -> FloatArray:
    """Return a force after a high pass of 12 ms."""
    width = round(0.012 / (t_s[1] - t_s[0]))
    return np.asarray(force_cN - np.convolve(force_cN, np.ones(width) / width, mode="same"))


@pytest.mark.parametrize("name", FINGERS)
@pytest.mark.parametrize("at_mm", [0.8, 2.0, 3.4])
def test_a_held_cap_is_silent_under_any_finger(learned: CompensationResult, name: str, at_mm: float) -> None:
    loop = learned.outcome.tuning.loop
    assert loop is not None
    finger, surface = bare(FINGERS[name]), learned.surface
    force_N = 0.01 * float(np.interp(at_mm, surface.displacement_mm, surface.press_cN[0]))
    stiffness = finger.impedance.stiffness_N_m
    start = plan(finger, 4e-3, 0.2).start_m
    end = max(start, 1e-3 * at_mm + depth_m(finger, force_N, stiffness))
    gesture = Gesture(start, end, 0.01, 0.25, 0.35, 0.1, stiffness, finger.impedance.damping_N_s_m)
    noise = draw_noise(RIG, finger, gesture, np.random.default_rng(5))
    image = image_of(surface, CLEAR.travel_mm, paced=True).image
    trace = simulate_program(RIG, finger, gesture, image, noise, 50.0, loop=loop.pack())
    held = (trace.t_s > 0.36) & (trace.t_s < 0.6)
    assert np.std(ripple_cN(trace.t_s, trace.force_cN)[held]) < 1.2


def test_a_free_cap_rests(learned: CompensationResult) -> None:
    loop = learned.outcome.tuning.loop
    assert loop is not None
    gesture = Gesture(-3e-3, -3e-3, 0.01, 0.05, 0.3, 0.05, 450.0, 4.5)
    noise = draw_noise(RIG, Finger(), gesture, np.random.default_rng(5))
    image = image_of(learned.surface, CLEAR.travel_mm, paced=True).image
    trace = simulate_program(RIG, Finger(), gesture, image, noise, 50.0, loop=loop.pack())
    assert np.std(trace.cap_velocity_mm_s[trace.t_s > 0.1]) < 3.2
    assert abs(trace.displacement_mm[-1]) < 0.05
