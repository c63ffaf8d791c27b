"""Simulate presses and probing of a real button."""

from __future__ import annotations

import ctypes
import math
from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from fdvv._native import address
from fdvv.errors import ModelError
from fdvv.model.press import Press
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.button_kernel import (
    ButtonGrid,
    ROW_s,
    STEP_s,
    TICK_s,
    button_library,
    button_plant,
    prepare,
    run_button,
)
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, plan
from fdvv.twin.noise import Effort, lsb_of
from fdvv.twin.rig import ForceSensor
from fdvv.twin.trace import BoolArray
from fdvv.units import FloatArray, cN_from_N, m_from_mm, mm_from_m

SETTLE_TICKS = 20
"""Milliseconds before the record starts: leaf and plate come to rest under the resting finger."""
BEYOND_mm = 0.1
"""The tester goes on beyond the bottom by this before it turns, as the kernel does; no row is taken there."""


@dataclass(frozen=True, eq=False)
class ButtonNoise:
    """Random disturbances of one press of a real button.

    Attributes
    ----------
    effort_ratio : (milliseconds of settling and record + 1,) modulation of the finger's own force.
    force_N : (recorded milliseconds,) added to each force sample.
    """

    effort_ratio: FloatArray
    force_N: FloatArray


def button_ticks(gesture: Gesture) -> int:
    """Count the milliseconds of the record."""
    return int(np.ceil(gesture.duration_s / TICK_s))


def no_button_noise(gesture: Gesture) -> ButtonNoise:
    """Return no noise at all."""
    n = button_ticks(gesture)
    return ButtonNoise(np.zeros(SETTLE_TICKS + n + 1), np.zeros(n))


def draw_button_noise(
    finger: Finger, gesture: Gesture, random: np.random.Generator, sensor: ForceSensor | None = None
) -> ButtonNoise:
    """Draw the noise of muscle and force sensor for one press."""
    n = button_ticks(gesture)
    effort = Effort(finger.habit, TICK_s).draw(SETTLE_TICKS + n + 1, random)
    return ButtonNoise(effort, (sensor.noise_N if sensor else 0.0) * random.standard_normal(n))


def read_force_N(sensor: ForceSensor, filtered_N: FloatArray, noise_N: FloatArray) -> FloatArray:
    """Read the sensor once per millisecond: play, gain, noise, range, converter; (n,)."""
    half = 0.5 * sensor.hysteresis_N

    def play(held: float, now: float) -> float:
        return now - half if held < now - half else now + half if held > now + half else held

    filtered: list[float] = filtered_N.tolist()
    held = np.array(list(accumulate(filtered, play, initial=0.0))[1:])
    value = np.clip((1 + sensor.gain_error_ratio) * held + noise_N, -sensor.full_scale_N, sensor.full_scale_N)
    lsb = lsb_of(sensor.full_scale_N, sensor.converter_bits)
    return np.asarray(lsb * np.floor(value / lsb + 0.5) if lsb else value)


@dataclass(frozen=True, eq=False)
class ButtonTrace:
    """All that the twin knows of one press of a real button, simulated; columns (n,) on one 10 kHz clock.

    Attributes
    ----------
    t_s : from 0.
    displacement_mm, velocity_mm_s, acceleration_m_s2 : of the cap, true.
    force_cN : between finger (or the sensor on it) and cap, true.
    sensed_cN : what the force sensor on the finger gives, sampled at tick and held; None for a bare finger.
    tick : rows at which the force was sampled, every millisecond.
    finger_mm : of the finger.
    leaf_mm, fixed_cN : the leaf, 0 where it reaches the fixed contact, and the force of that contact.
    plate_mm, plate_velocity_mm_s : of the plate under the button.
    closed : the circuit is closed.
    closing_s, opening_s : when it first closed and last opened; None if it never did.
    energy_J : energy that the balance cannot account for, 0 if integration were exact; None if not asked.
    """

    t_s: FloatArray
    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray
    force_cN: FloatArray
    sensed_cN: FloatArray | None
    tick: BoolArray
    finger_mm: FloatArray
    leaf_mm: FloatArray
    fixed_cN: FloatArray
    plate_mm: FloatArray
    plate_velocity_mm_s: FloatArray
    closed: BoolArray
    closing_s: float | None
    opening_s: float | None
    energy_J: FloatArray | None

    def press(self, velocity_mm_s: float) -> Press:
        """Return the record that devices share, as a bench with perfect displacement would capture it."""
        return Press(
            self.t_s,
            self.displacement_mm,
            self.force_cN,
            velocity_mm_s,
            sensed_cN=self.sensed_cN,
            tick=None if self.sensed_cN is None else self.tick,
            simulated=True,
        )


def simulate_button(
    button: ButtonPhysics,
    finger: Finger,
    gesture: Gesture,
    noise: ButtonNoise,
    sensor: ForceSensor | None = None,
    step_s: float = STEP_s,
    audit: bool = False,
    detour_m: FloatArray | None = None,
) -> ButtonTrace:
    """Simulate one press of a real button in compiled C.

    sensor : the force sensor worn on the fingertip; None for a bare finger, which senses nothing.
    audit : also account for the energy of the press.
    detour_m : added to where the gesture leads the referent, one for each of noise.effort_ratio.

    Raises ModelError if button or finger are too stiff for the step. Safe to call from threads.
    """
    ticks = button_ticks(gesture)
    per_tick, per_row = _whole(TICK_s / step_s), _whole(ROW_s / step_s)
    table = prepare(button).table
    grid = ButtonGrid(SETTLE_TICKS, ticks, per_tick, per_row, len(table), int(audit))
    plant = button_plant(button, finger, gesture, sensor, step_s=step_s)
    rows, switching = run_button(plant, grid, table, noise.effort_ratio, detour_m)
    if not np.isfinite(rows[:-1, -1]).all():
        raise ModelError(
            f"the press diverged: button or finger are too stiff or too light for steps of {step_s:g} s; "
            "raise the lightest mass or lower the largest stiffness, damping or loss"
        )
    return _trace(rows, switching, noise, sensor, audit)


def _whole(ratio: float) -> int:
    count = round(ratio)
    if count < 1 or abs(count - ratio) > 1e-6:
        raise ModelError(f"the step must divide {ROW_s:g} s")
    return count


def _trace(
    rows: FloatArray, switching: FloatArray, noise: ButtonNoise, sensor: ForceSensor | None, audit: bool
) -> ButtonTrace:
    t, x, v, a, force, filtered, finger, leaf, fixed, plate, shake, closed, energy = rows
    per_tick = round(TICK_s / ROW_s)
    tick = np.arange(t.size) % per_tick == 0
    sensed = None
    if sensor is not None:
        sensed = cN_from_N(np.repeat(read_force_N(sensor, filtered[tick], noise.force_N), per_tick))
    closing, opening = (None if math.isnan(value) else float(value) for value in switching)
    cap = (mm_from_m(x), mm_from_m(v), a, cN_from_N(force))
    around = (mm_from_m(finger), mm_from_m(leaf), cN_from_N(fixed), mm_from_m(plate), mm_from_m(shake))
    switched = (closed > 0.5, closing, opening)
    return ButtonTrace(t, *cap, sensed, tick, *around, *switched, energy if audit else None)


@dataclass(frozen=True, eq=False)
class ProbedCurve:
    """Force on displacement of one slow stroke pair, simulated; (n,) each, in rising displacement."""

    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray


def probe_button(button: ButtonPhysics, speed_mm_s: float = 0.5, step_mm: float = 0.005) -> ProbedCurve:
    """Lead the slider down to the bottom stop and back at a constant speed; force as the tester reads it.

    The tester is stiff and cannot pull; a sample every step_mm or a little less.
    """
    if not (0 < speed_mm_s < math.inf and step_mm > 0):
        given = f"{speed_mm_s} mm/s and {step_mm} mm"
        raise ModelError(f"a probe needs a finite speed and a step above 0, got {given}")
    travel_m = button.curve.travel_m
    count = max(int(np.ceil(mm_from_m(travel_m) / step_mm - 1e-9)) + 1, 2)
    finger = Finger()
    plant = button_plant(button, finger, plan(finger, travel_m, 0.1), None, clamped=True)
    table, rows = prepare(button).table, np.empty((2 * count, 2))
    way = (travel_m, m_from_mm(speed_mm_s), count)
    if button_library().fdvv_button_probe(
        ctypes.byref(plant), len(table), address(table), *way, address(rows)
    ):
        raise ModelError(f"the compiled button cannot be probed at {speed_mm_s} mm/s in {count} rows")
    force_cN = cN_from_N(rows[:, 1])
    return ProbedCurve(mm_from_m(rows[:count, 0]), force_cN[:count], force_cN[count:][::-1])
