"""Sensors and controller of the compiled press."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor
from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger, Impedance
from fdvv.twin.gesture import plan
from fdvv.twin.noise import draw_noise, silence
from fdvv.twin.rig import Controller, Rig
from fdvv.twin.rig_kernel import grid_of
from tests.support.table_press import simulate
from tests.twin.conftest import FRICTIONLESS, PERFECT_POSITION, Bench, flat


def test_the_position_is_the_lagged_one_averaged_over_the_burst() -> None:
    bench = Bench.of(flat(0.0), **FRICTIONLESS, **PERFECT_POSITION, force_constant_N_A=0.0)
    trace, lag = bench.run(), 1 / bench.plant.lvdt_rate
    ticks = np.flatnonzero(trace.tick & (trace.t_s > 0.001) & (trace.t_s < 0.025))
    reads = trace.t_s[ticks][:, None] - 1e-5 * np.arange(25)
    settled = lag**2 * (1 - np.exp(-reads / lag))
    lagged_mm = 1000 * 9.81 * (reads**2 / 2 - lag * reads + settled)
    assert trace.sensed_mm[ticks] == pytest.approx(lagged_mm.mean(axis=1), abs=5e-4)


def test_sensed_values_lie_on_the_steps_of_their_converters(tactile: ForceSurface) -> None:
    rig, gesture = Rig(), plan(Finger(), 0.004, 0.06)
    noise = draw_noise(rig, Finger(), gesture, np.random.default_rng(0))
    trace = simulate(rig, Finger(), gesture, tactile, 4.0, noise, 100.0)
    force_steps = trace.sensed_cN / (981 / 1024)
    place_steps = trace.sensed_mm * 16000
    assert force_steps == pytest.approx(np.round(force_steps), abs=1e-6)
    assert place_steps == pytest.approx(np.round(place_steps), abs=1e-6)
    assert np.unique(trace.sensed_cN).size > 10


def test_sensed_values_hold_between_ticks(tactile: ForceSurface) -> None:
    rig, gesture = Rig(), plan(Finger(), 0.004, 0.06)
    trace = simulate(rig, Finger(), gesture, tactile, 4.0, silence(rig, gesture), 100.0)
    assert np.array_equal(np.flatnonzero(trace.tick), np.arange(0, trace.t_s.size, 10))
    for column in (trace.sensed_mm, trace.sensed_cN, trace.commanded_cN):
        assert np.array_equal(column, np.repeat(column[trace.tick], 10))


def test_a_command_beyond_the_limit_is_cut_and_flagged() -> None:
    low, high = Bench.of(flat(439.0)).run(), Bench.of(flat(480.0)).run()
    assert not low.saturated.any()
    assert high.saturated.all()
    assert high.commanded_cN == pytest.approx(440.0)


def speed_surface() -> ForceSurface:
    """A table whose force in cN is the speed in mm/s it was read at."""
    speeds = np.array([20.0, 400.0])
    table = np.tile(speeds[:, None], (1, 2))
    return ForceSurface(np.array([0.0, 4.0]), speeds, table, table)


@pytest.mark.parametrize("press_s", [0.4, 0.05, 0.02])
def test_the_speed_is_found_from_the_window_even_in_fast_presses(press_s: float) -> None:
    rig = Rig()
    gesture = plan(Finger(), 0.004, press_s)
    noise = silence(rig, gesture)
    trace = simulate(rig, Finger(), gesture, speed_surface(), 4.0, noise, 60.0)
    ticks = trace.tick & (trace.t_s < gesture.onset_s + gesture.press_s + gesture.dwell_s)
    t, x, found = trace.t_s[ticks], trace.sensed_mm[ticks], trace.commanded_cN[ticks]
    first = int(np.argmax(x > 1.0))
    assert found[:first] == pytest.approx(60.0)
    used = np.flatnonzero((x[:first] >= 0.5) & (x[:first] <= 1.0))
    used = used if used.size >= 3 else np.arange(first - 2, first + 1)
    slope = rig.controller.velocity_scale * np.polyfit(t[used], x[used], 1)[0]
    assert found[first:] == pytest.approx(np.clip(slope, 20, 400), rel=1e-3)


def test_threads_give_the_same_bits_as_one_after_the_other(tactile: ForceSurface) -> None:
    rig, finger = Rig(), Finger()
    gestures = [plan(finger, 0.004, 0.05 + 0.01 * k) for k in range(6)]

    def one(k: int) -> bytes:
        noise = draw_noise(rig, finger, gestures[k], np.random.default_rng(k))
        return simulate(rig, finger, gestures[k], tactile, 4.0, noise, 100.0).force_cN.tobytes()

    with ThreadPoolExecutor(3) as pool:
        assert list(pool.map(one, range(6))) == [one(k) for k in range(6)]


def test_a_duration_off_the_grid_of_steps_is_refused() -> None:
    rig = Rig(controller=Controller(compute_s=2.97e-4))
    with pytest.raises(ModelError, match="compute_s must be a multiple of the step 1e-05 s"):
        grid_of(rig)


def test_noise_of_another_press_is_refused(tactile: ForceSurface) -> None:
    rig, finger = Rig(), Finger()
    long, short = plan(finger, 0.004, 0.2), plan(finger, 0.004, 0.1)
    with pytest.raises(ModelError, match="noise must last"):
        simulate(rig, finger, long, tactile, 4.0, silence(rig, short), 100.0)


def test_a_bridge_that_cannot_pull_gives_no_negative_force() -> None:
    rig = replace(Rig(), coil=replace(Rig().coil, bipolar="no"))
    gesture = plan(Finger(), 0.004, 0.1)
    trace = simulate(rig, Finger(), gesture, flat(-20.0), 4.0, silence(rig, gesture), 100.0)
    assert trace.saturated.all()


def test_a_plant_too_stiff_for_the_step_is_refused_instead_of_giving_nonsense() -> None:
    finger = Finger(impedance=Impedance(mass_kg=5e-4, damping_N_s_m=100.0))
    rig, gesture = Rig(), plan(finger, 0.004, 0.1)
    with pytest.raises(ModelError, match="too stiff or too light for steps of 1e-05 s"):
        simulate(rig, finger, gesture, flat(40.0), 4.0, silence(rig, gesture), 100.0)
