"""The real-button twin: what its physics must do, slowly, quickly, at rest and on the plate."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lfilter

from fdvv.errors import ModelError
from fdvv.twin.button import ButtonPhysics, Curve, Housing, Leaf
from fdvv.twin.draw import draw_finger
from fdvv.twin.files import button_names, load_button
from fdvv.twin.finger import Finger, Impedance
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.pace import mean_speed_mm_s, solve_button_pace
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import (
    ButtonTrace,
    draw_button_noise,
    no_button_noise,
    probe_button,
    simulate_button,
)
from tests.support.drawn_button import draw_button
from tests.support.other_rigs import minimum_jerk
from tests.support.reference.cell_press import rms

NAMES = button_names()
SWITCHES = [name for name in NAMES if name.startswith("mx-")]
DOMES = [name for name in NAMES if not name.startswith("mx-")]


def press(
    name: str, press_s: float = 0.08, sensor: ForceSensor | None = None, audit: bool = False
) -> ButtonTrace:
    button, finger = load_button(name), Finger()
    gesture = plan(finger, button.curve.travel_m, press_s)
    return simulate_button(button, finger, gesture, no_button_noise(gesture), sensor, audit=audit)


def spring(held: bool = True, **housing: float) -> ButtonPhysics:
    """A frictionless linear spring of 30 cN and 10 cN/mm, its plate too heavy to move."""
    force_N = np.asarray(0.3 + 10.0 * 2e-5 * np.arange(201), dtype=np.float64)
    heavy = {"first_kg": 100.0, "second_kg": 100.0} if held else {}
    button = load_button("hp-pr1101u")
    return replace(
        button,
        press_N=force_N,
        release_N=force_N,
        curve=Curve(kind="dome", travel_m=0.004, close_m=0.002, open_m=0.002, seat_m=0.0),
        slider=replace(button.slider, viscous_N_s_m=0.0),
        dome=replace(button.dome, law="log", log_ratio=0.0),
        housing=Housing(**heavy, **housing),
    )


@pytest.mark.parametrize("name", NAMES)
def test_a_slow_probe_gives_back_the_curves_the_button_was_made_from(name: str) -> None:
    button = load_button(name)
    probed = probe_button(button)
    at_mm = 1e3 * button.curve.step_m * np.arange(button.press_N.size)
    for got_cN, force_N in ((probed.press_cN, button.press_N), (probed.release_cN, button.release_N)):
        wanted_cN = 100 * np.interp(probed.displacement_mm, at_mm, force_N)
        assert rms(got_cN - wanted_cN) < 0.6
        seated = probed.displacement_mm > 0.1
        assert rms((got_cN - wanted_cN)[seated]) < 0.2


@pytest.mark.parametrize("name", SWITCHES)
def test_friction_of_a_leaf_switch_does_not_depend_on_the_speed_of_a_slow_probe(name: str) -> None:
    slow, faster = probe_button(load_button(name), 0.5), probe_button(load_button(name), 2.0)
    viscous_cN = 100 * load_button(name).slider.viscous_N_s_m * 1.5e-3
    assert rms(slow.press_cN - faster.press_cN) < 0.1 + viscous_cN


@pytest.mark.parametrize("name", DOMES)
@pytest.mark.parametrize("law", ["log", "linear"])
def test_the_peak_of_a_dome_is_12_to_15_percent_higher_at_80_than_at_half_a_mm_per_s(
    name: str, law: str
) -> None:
    button = load_button(name)
    button = replace(button, dome=replace(button.dome, law=law))
    slow, fast = (probe_button(button, v, 0.02) for v in (0.5, 80.0))
    snap = slow.displacement_mm < 0.6 * slow.displacement_mm[-1]
    assert 1.12 <= fast.press_cN[snap].max() / slow.press_cN[snap].max() <= 1.15


def test_the_leaf_closes_the_circuit_where_the_curve_says() -> None:
    for name in SWITCHES:
        button = load_button(name)
        trace = press(name, press_s=0.6)
        assert trace.closing_s is not None
        at_mm = np.interp(trace.closing_s, trace.t_s, trace.displacement_mm - trace.plate_mm)
        assert at_mm == pytest.approx(1e3 * button.curve.close_m, abs=0.03)
        assert trace.opening_s is not None
        assert trace.opening_s > trace.closing_s


def test_a_dome_closes_deeper_than_it_opens() -> None:
    trace = press("hp-pr1101u", press_s=0.3)
    curve = load_button("hp-pr1101u").curve
    in_housing_mm = trace.displacement_mm - trace.plate_mm
    assert trace.closing_s is not None
    assert trace.opening_s is not None
    assert np.interp(trace.closing_s, trace.t_s, in_housing_mm) == pytest.approx(
        1e3 * curve.close_m, abs=0.01
    )
    assert np.interp(trace.opening_s, trace.t_s, in_housing_mm) == pytest.approx(1e3 * curve.open_m, abs=0.02)


def test_a_cap_held_on_the_slope_by_friction_does_not_creep() -> None:
    button, finger = load_button("mx-red"), Finger(impedance=Impedance(stiffness_N_m=255.0))
    nominal = plan(finger, button.curve.travel_m, 0.2)
    # the referent stops where the finger balances the spring about half way down, and stays for a second
    halfway = replace(nominal, end_m=0.001 + 0.4 / 255.0, dwell_s=1.2)
    trace = simulate_button(button, finger, halfway, no_button_noise(halfway))
    late = (trace.t_s > 0.9) & (trace.t_s < 1.3)
    assert 0.2 < trace.displacement_mm[late][0] < 3.0
    # the pulp goes on relaxing (time constant 0.1 s), friction itself must not let go
    assert np.ptp(trace.displacement_mm[late]) < 1e-3


@pytest.mark.parametrize("name", NAMES)
def test_no_more_than_a_thousandth_of_a_press_s_energy_is_unaccounted_for(name: str) -> None:
    trace = press(name, 0.05, ForceSensor(), audit=True)
    assert trace.energy_J is not None
    work_J = 1e-5 * float(np.sum(trace.force_cN[1:] * np.maximum(np.diff(trace.displacement_mm), 0.0)))
    assert work_J > 5e-4
    assert np.abs(trace.energy_J).max() < 1e-3 * work_J


def test_other_units_pressed_by_other_people_stay_stable_over_all_plausible_ranges() -> None:
    random = np.random.default_rng(5)
    for i in range(48):
        button = draw_button(load_button(NAMES[i % len(NAMES)]), random)
        finger, sensor = draw_finger(random), (None, ForceSensor())[i % 2]
        gesture = plan(finger, button.curve.travel_m, float(random.uniform(0.05, 0.15)))
        noise = draw_button_noise(finger, gesture, random, sensor)
        trace = simulate_button(button, finger, gesture, noise, sensor, audit=True)
        assert trace.energy_J is not None
        assert np.abs(trace.energy_J).max() < 1e-5
        assert trace.displacement_mm.max() > 0.9e3 * button.curve.travel_m


@pytest.mark.parametrize("velocity_mm_s", [50.0, 200.0])
def test_a_solved_pace_gives_the_asked_mean_speed(velocity_mm_s: float) -> None:
    button, finger = load_button("mx-clear"), Finger()
    press_s = solve_button_pace(button, finger, velocity_mm_s)
    trace = press("mx-clear", press_s)
    speed = mean_speed_mm_s(trace.t_s, trace.displacement_mm, 1e3 * button.curve.travel_m)
    assert speed == pytest.approx(velocity_mm_s, rel=0.01)


def test_a_pace_is_found_where_the_shortest_stroke_would_diverge() -> None:
    """A finger that drops 4 mm in 10 ms onto a worn sensor is more than the equations bear."""
    button, sensor = load_button("mx-clear"), ForceSensor()
    finger = Finger(habit=replace(Finger().habit, lift_m=0.004))
    sudden = plan(finger, button.curve.travel_m, 0.01)
    with pytest.raises(ModelError, match="diverged"):
        simulate_button(button, finger, sudden, no_button_noise(sudden), sensor)
    press_s = solve_button_pace(button, finger, 150.0, sensor)
    gesture = plan(finger, button.curve.travel_m, press_s)
    trace = simulate_button(button, finger, gesture, no_button_noise(gesture), sensor)
    assert mean_speed_mm_s(trace.t_s, trace.displacement_mm, 4.0) == pytest.approx(150.0, rel=0.01)
    # a pace that no stroke reaches without diverging gives the shortest one that does not
    fastest = plan(finger, button.curve.travel_m, solve_button_pace(button, finger, 5000.0, sensor))
    simulate_button(button, finger, fastest, no_button_noise(fastest), sensor)


def test_a_detour_of_the_referent_is_where_the_finger_goes() -> None:
    """A press of the gesture, and the same press written as a detour of a finger that stays."""
    button, finger = load_button("mx-brown"), Finger()
    gesture = plan(finger, button.curve.travel_m, 0.1)
    noise = no_button_noise(gesture)
    t = np.asarray(1e-3 * (np.arange(noise.effort_ratio.size) - 20.0), dtype=np.float64)
    up_s = gesture.onset_s + gesture.press_s + gesture.dwell_s
    moves = minimum_jerk((t - gesture.onset_s) / 0.1) - minimum_jerk((t - up_s) / 0.1)
    still = replace(gesture, end_m=gesture.start_m)
    wanted = simulate_button(button, finger, gesture, noise)
    got = simulate_button(
        button, finger, still, noise, detour_m=(gesture.end_m - gesture.start_m) * moves, audit=True
    )
    assert np.abs(got.displacement_mm - wanted.displacement_mm).max() < 5e-3
    assert got.energy_J is not None
    assert np.abs(got.energy_J).max() < 1e-6


def test_the_record_of_a_press_is_that_of_every_device() -> None:
    trace = press("mx-clear", sensor=ForceSensor())
    record = trace.press(100.0)
    assert record.simulated
    assert record.sensed_cN is not None
    assert record.tick is not None
    assert record.tick.sum() == -(-record.t_s.size // 10)
    lsb_cN = 981 / 1024
    assert np.allclose(record.sensed_cN / lsb_cN, np.round(record.sensed_cN / lsb_cN), atol=1e-9)
    bare = press("mx-clear").press(100.0)
    assert bare.sensed_cN is None
    assert bare.tick is None


def test_the_force_sensor_is_an_rc_filter_behind_the_contact() -> None:
    light = ForceSensor(
        mass_kg=2e-4, noise_N=0.0, hysteresis_N=0.0, converter_bits=0, contact_stiffness_N_m=2e4
    )
    trace = press("mx-brown", 0.06, light)
    keep = np.exp(-1e-4 / light.filter_s)
    wanted = lfilter([1 - keep], [1, -keep], trace.force_cN, zi=[keep * trace.force_cN[0]])[0]
    assert trace.sensed_cN is not None
    # a row of delay each way of the discrete filter, and the light cone's own inertia
    assert rms((trace.sensed_cN - wanted)[trace.tick]) < 1.5
    assert rms((trace.sensed_cN - trace.force_cN)[trace.tick]) > 1.5 * rms(
        (trace.sensed_cN - wanted)[trace.tick]
    )


def test_a_stiff_light_finger_in_the_air_peaks_at_1_875_times_its_mean_speed() -> None:
    finger = Finger(impedance=Impedance(mass_kg=5e-4, stiffness_N_m=5000.0, damping_N_s_m=3.0))
    gesture = Gesture(-0.025, -0.005, 0.01, 0.1, 0.02, 0.1, 5000.0, 3.0)
    trace = simulate_button(load_button("mx-red"), finger, gesture, no_button_noise(gesture))
    speed = np.gradient(trace.finger_mm, trace.t_s)
    assert speed.max() == pytest.approx(1.875 * 20 / 0.1, rel=0.01)


@pytest.mark.parametrize("loss_s_m", [0.0, 0.3, 1.0])
def test_a_returning_cap_bounces_off_its_top_stop_as_hunt_and_crossley_say(loss_s_m: float) -> None:
    button = spring(top_loss_s_m=loss_s_m, top_stiffness_N_m=5e4)
    # stiff and light, so that it is gone before the cap comes up
    finger = Finger(impedance=Impedance(mass_kg=1e-3, stiffness_N_m=5000.0, damping_N_s_m=5.0))
    gesture = replace(plan(finger, 0.004, 0.2), start_m=-0.03, release_s=0.01)
    trace = simulate_button(button, finger, gesture, no_button_noise(gesture))
    free = trace.t_s > gesture.onset_s + gesture.press_s + gesture.dwell_s
    below = np.flatnonzero(free & (trace.displacement_mm <= 0.0))
    after = below[0] + int(np.argmax(trace.displacement_mm[below[0] :] > 0))
    # from the rows outside the contact to x = 0 under the spring's 0.3 N on 3 g
    arriving, leaving = (
        np.sqrt((1e-3 * trace.velocity_mm_s[row]) ** 2 + 2 * 100 * 1e-3 * trace.displacement_mm[row])
        for row in (below[0] - 1, after)
    )
    assert arriving > 0.1
    assert leaving / arriving == pytest.approx(1 - loss_s_m * arriving, abs=0.01 + (loss_s_m * arriving) ** 2)


def test_the_leaf_rings_on_the_fixed_contact_at_its_own_frequency() -> None:
    button = load_button("mx-red")
    leaf = Leaf(damping_ratio=0.005, fixed_loss_s_m=0.0)
    button = replace(button, leaf=leaf)
    finger = Finger()
    gesture = plan(finger, button.curve.travel_m, 0.05)
    trace = simulate_button(button, finger, gesture, no_button_noise(gesture))
    assert trace.closing_s is not None
    off = (trace.t_s > trace.closing_s + 0.01) & (trace.t_s < trace.closing_s + 0.04)
    ring = (trace.leaf_mm - 0.5 * trace.plate_mm)[off]
    ring = ring - ring.mean()
    power = np.abs(np.fft.rfft(ring, 1 << 14))
    found_Hz = np.fft.rfftfreq(1 << 14, 1e-4)[int(np.argmax(power[400:])) + 400]
    wanted_Hz = np.sqrt((leaf.stiffness_N_m + leaf.fixed_stiffness_N_m) / leaf.mass_kg) / (2 * np.pi)
    assert found_Hz == pytest.approx(wanted_Hz, rel=0.03)


def test_the_plate_rings_in_proportion_to_the_speed_of_the_impact() -> None:
    finger, peaks, speeds = Finger(), [], []
    for press_s in (0.04, 0.08):
        gesture = replace(plan(finger, 0.004, press_s), release_s=0.012)
        button = spring(held=False)
        trace = simulate_button(button, finger, gesture, no_button_noise(gesture))
        down = int(np.argmax(trace.displacement_mm > 4.0))
        speeds.append(float(trace.velocity_mm_s[down]))
        peaks.append(float(np.abs(trace.plate_velocity_mm_s[down : down + 40]).max()))
    exponent = np.log(peaks[0] / peaks[1]) / np.log(speeds[0] / speeds[1])
    assert 0.8 < exponent < 1.2


def test_a_step_that_the_button_cannot_bear_is_refused_with_what_to_do() -> None:
    button, finger = load_button("mx-red"), Finger()
    gesture = plan(finger, button.curve.travel_m, 0.05)
    with pytest.raises(ModelError, match=r"diverged.*raise the lightest mass"):
        simulate_button(button, finger, gesture, no_button_noise(gesture), step_s=5e-5)
    with pytest.raises(ModelError, match="step must divide"):
        simulate_button(button, finger, gesture, no_button_noise(gesture), step_s=7e-6)


def test_a_probe_refuses_a_speed_of_zero() -> None:
    with pytest.raises(ModelError, match="above 0"):
        probe_button(load_button("mx-red"), 0.0)
