"""A finger that is led live on a rig with the firmware's core."""

from __future__ import annotations

from dataclasses import fields, replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Mode
from fdvv.twin.files import load_rig
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.interactive import InteractiveRig, InteractiveTicks
from fdvv.twin.noise import draw_ticks, silence
from fdvv.twin.plant import LIFTED_m
from fdvv.twin.rig import Rig
from fdvv.units import mm_from_m
from tests.support.table_press import simulate

LIFTED_mm = float(mm_from_m(LIFTED_m))


def led(surface: ForceSurface, rig: Rig | None = None, seed: int | None = None) -> InteractiveRig:
    return InteractiveRig(image_of(surface, 4.0).image, rig, seed=seed)


def minimum_jerk(way: float, span_s: float, t_s: float) -> tuple[float, float]:
    s = min(max(t_s / span_s, 0.0), 1.0)
    return way * s**3 * (10 + s * (6 * s - 15)), way * 30 * s**2 * (1 - s) ** 2 / span_s


def test_a_rig_is_handed_out_armed_at_rest_and_untouched(tactile: ForceSurface) -> None:
    ticks = led(tactile).advance(200)
    assert set(ticks.mode) == {Mode.ARMED}
    assert np.abs(ticks.displacement_mm).max() < 0.03
    assert ticks.force_cN.max() == 0.0
    assert ticks.finger_mm == pytest.approx(np.full(200, -LIFTED_mm), abs=0.01)
    assert ticks.t_s[0] == 0.0


def test_a_led_finger_in_the_air_follows_the_critically_damped_way_to_its_goal(tactile: ForceSurface) -> None:
    """Oracle: gap (1 + w t) exp(-w t), which the stiff finger trails by little."""
    rig, w = led(tactile), 40.0
    rig.lead(-0.5, near_1_s=w)
    ticks = rig.advance(300)
    gap = (LIFTED_mm - 0.5) * (1 + w * ticks.t_s) * np.exp(-w * ticks.t_s)
    assert ticks.finger_mm == pytest.approx(-0.5 - gap, abs=0.06)
    assert ticks.finger_mm[-1] == pytest.approx(-0.5, abs=1e-3)


def test_a_goal_that_moves_is_followed_without_a_lag(tactile: ForceSurface) -> None:
    rig = led(tactile)
    rig.lead(-1.9, velocity_mm_s=5.0)
    ticks = rig.advance(300)
    assert ticks.finger_mm[-1] == pytest.approx(-1.9 + 5.0 * ticks.t_s[-1], abs=0.005)


def test_led_along_a_gesture_the_press_is_that_of_the_gesture(tactile: ForceSurface) -> None:
    """The gesture's own path through the kernel is the oracle for the door that leads."""
    habit = replace(Finger().habit, lift_m=LIFTED_m, onset_s=0.0)
    finger = replace(Finger(), habit=habit)
    gesture = plan(finger, 0.004, 0.08)
    rig = Rig()
    whole = simulate(rig, finger, gesture, tactile, 4.0, silence(rig, gesture), 100.0)
    live = led(tactile)
    live.announce(100.0)
    pieces, way = [], float(mm_from_m(gesture.end_m - gesture.start_m))
    for k in range(int(whole.tick.sum())):
        t = k * rig.controller.tick_s
        down, speed = minimum_jerk(way, gesture.press_s, t)
        if t > gesture.press_s + gesture.dwell_s:
            up, back = minimum_jerk(way, gesture.release_s, t - gesture.press_s - gesture.dwell_s)
            down, speed = way - up, -back
        live.lead(down - LIFTED_mm, speed, near_1_s=1000.0)
        pieces.append(live.advance(1))
    ticks = InteractiveTicks.concatenate(pieces)
    assert ticks.displacement_mm == pytest.approx(whole.displacement_mm[whole.tick], abs=0.05)
    off = np.abs(ticks.force_cN - whole.force_cN[whole.tick])
    assert off.mean() < 1.0
    assert ticks.displacement_mm.max() > 3.9


@pytest.mark.parametrize("force_cN", [30.0, 150.0])
def test_a_push_is_felt_whole_once_all_is_at_rest(tactile: ForceSurface, force_cN: float) -> None:
    rig = led(tactile)
    rig.push(force_cN)
    assert rig.advance(1500).force_cN[-1] == pytest.approx(force_cN, rel=0.02)


def test_from_place_to_push_and_back_the_force_does_not_jump(tactile: ForceSurface) -> None:
    rig = led(tactile)
    rig.lead(2.0)
    held = rig.advance(800).force_cN[-1]
    rig.push(float(held))
    pushed = rig.advance(400)
    assert np.abs(pushed.force_cN - held).max() < 1.0
    rig.lead(2.0)
    assert np.abs(np.diff(rig.advance(400).force_cN)).max() < 1.0


def test_the_speed_of_the_finger_does_not_jump_when_the_hand_does(tactile: ForceSurface) -> None:
    rig = led(tactile)
    rig.lead(-0.5)
    steps = [rig.advance(8)]
    for goal in (-1.8, -0.3, -1.5, -0.2):
        rig.lead(goal)
        steps.append(rig.advance(8))
    speed = np.diff(InteractiveTicks.concatenate(steps).finger_mm)
    assert np.abs(np.diff(speed)).max() < 0.03  # mm per tick and tick; a jump of the goal is 1.5 mm


@pytest.mark.parametrize("name", ["paper", "light", "ideal"])
def test_the_same_leads_give_the_same_press_however_time_is_cut(tactile: ForceSurface, name: str) -> None:
    found = []
    for cuts in ([600, 900], [1, 599, 3, 509, 388]):
        rig = led(tactile, load_rig(name), seed=7)
        pieces, done = [], 0
        for count in cuts:
            if done in (0, 600):
                rig.lead(4.0 if done == 0 else -1.0)
            pieces.append(rig.advance(count))
            done += count
        found.append(InteractiveTicks.concatenate(pieces))
    for column in fields(InteractiveTicks):
        assert np.array_equal(*(getattr(ticks, column.name) for ticks in found)), column.name


@pytest.mark.parametrize("numbers", [(np.nan, 0.0, 100.0), (1.0, np.inf, 100.0), (1.0, 0.0, 0.0)])
def test_a_lead_that_is_no_number_is_refused(
    tactile: ForceSurface, numbers: tuple[float, float, float]
) -> None:
    with pytest.raises(ModelError, match="finite"):
        led(tactile).lead(*numbers)


def test_a_copy_goes_on_as_the_original_would_and_leaves_it_alone(tactile: ForceSurface) -> None:
    rig, alone = led(tactile, seed=3), led(tactile, seed=3)
    rig.lead(1.0)
    alone.lead(1.0)
    both = [one.advance(300) for one in (rig.copy(), alone)]
    for field in fields(InteractiveTicks):
        assert np.array_equal(*(getattr(one, field.name) for one in both)), field.name
    assert rig.time_s == 0.0


def test_a_copy_may_be_given_noise_of_its_own(tactile: ForceSurface) -> None:
    rig = led(tactile, seed=3)
    noise = draw_ticks(rig.rig, rig.finger, 700, np.random.default_rng(5))
    once, again = (rig.copy(noise).advance(700).sensed_mm for _ in range(2))
    assert np.array_equal(once, again)
    assert not np.array_equal(once, rig.copy().advance(700).sensed_mm)
    with pytest.raises(ModelError, match="position_m"):
        rig.copy(replace(noise, position_m=noise.position_m[:, :1]))


def test_a_pressed_finger_goes_where_the_same_gesture_takes_it_in_a_press_of_its_own(
    tactile: ForceSurface,
) -> None:
    """Oracle: simulate(), whose finger starts where the gesture does."""
    finger = Finger(habit=replace(Finger().habit, lift_m=LIFTED_m))
    gesture = plan(finger, 0.004, 0.08)
    rig = InteractiveRig(image_of(tactile, 4.0).image, finger=finger, seed=None)
    rig.announce(50.0)
    rig.press(gesture)
    ticks = rig.advance(150)
    trace = simulate(rig.rig, finger, gesture, tactile, 4.0, silence(rig.rig, gesture), 50.0)
    assert ticks.displacement_mm == pytest.approx(trace.displacement_mm[trace.tick][:150], abs=0.02)
