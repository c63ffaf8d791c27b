"""What is random about one press of a real button, and the force sensor that the finger wears."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import accumulate

import numpy as np

from fdvv.twin._finger import Finger
from fdvv.twin._flatten_button import TICK_s
from fdvv.twin._gesture import Gesture
from fdvv.twin._noise import Effort, lsb_of
from fdvv.twin._rig_senses import ForceSensor
from fdvv.units import FloatArray

SETTLE_s = 0.02
"""The press runs this long before the record starts: leaf and plate come to rest under the resting finger."""


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


def settle_button_ticks() -> int:
    """Count the milliseconds before the record starts."""
    return round(SETTLE_s / TICK_s)


def button_ticks(gesture: Gesture) -> int:
    """Count the milliseconds of the record."""
    return int(np.ceil(gesture.duration_s / TICK_s))


def no_button_noise(gesture: Gesture) -> ButtonNoise:
    """Give no noise at all."""
    n = button_ticks(gesture)
    return ButtonNoise(np.zeros(settle_button_ticks() + n + 1), np.zeros(n))


def draw_button_noise(
    finger: Finger, gesture: Gesture, random: np.random.Generator, sensor: ForceSensor | None = None
) -> ButtonNoise:
    """Draw the noise of muscle and force sensor for one press."""
    n = button_ticks(gesture)
    effort = Effort(finger.habit, TICK_s).draw(settle_button_ticks() + n + 1, random)
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
