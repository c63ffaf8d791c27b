"""A cap on a linear guide in real time, and the finger that presses it; simulated."""

from __future__ import annotations

import math

import numpy as np

from fdvv.device.own_rig import Hand, RigNumbers

STEP_s = 1e-4
LONGEST_s = 0.25
"""A process that was held up for longer skips the rest."""


class CapOnGuide:
    """A mass between two stiff stops, with drag and dry friction (fdvv.device.own_rig.OwnRig)."""

    numbers = RigNumbers("guide", full_duty_N=6.0, force_limit_N=5.0)
    MASS_kg, DRAG_N_s_m, FRICTION_N = 0.03, 0.8, 0.02
    STOP_N_m, STOP_N_s_m = 3e4, 25.0

    def __init__(self, travel_mm: float) -> None:
        self.travel_mm = travel_mm
        self.x_m = self.v_m_s = 0.0

    def step(self, motor_N: float, finger_N: float, stop_mm: float, dt_s: float) -> float:
        """Move on; the stage has a bottom of its own, so that stop_mm, if finite, can only be above it."""
        bottom_m = 1e-3 * min(stop_mm, self.travel_mm)
        beyond_m = self.x_m - min(bottom_m, max(0.0, self.x_m))
        force_N = finger_N - motor_N - self.DRAG_N_s_m * self.v_m_s
        if beyond_m:
            force_N -= self.STOP_N_m * beyond_m + self.STOP_N_s_m * self.v_m_s
        else:
            force_N -= self.FRICTION_N * math.tanh(self.v_m_s / 1e-3)
        self.v_m_s += force_N / self.MASS_kg * dt_s
        self.x_m += self.v_m_s * dt_s
        return 1e3 * self.x_m


class LivePlant:
    """The cap and a hand (fdvv.device.own_rig.Hand), advanced to the present whenever someone looks.

    Attributes
    ----------
    travel_mm : of the cap. motor_N : against the finger, as the drive makes it now.
    finger_N : between finger and cap.
    """

    LAG_s = 3e-4
    """Of the drive's current loop."""

    def __init__(self, travel_mm: float, seed: int = 0) -> None:
        self.travel_mm = travel_mm
        self.cap, self.hand = CapOnGuide(travel_mm), Hand(np.random.default_rng(seed))
        self.motor_N = self.finger_N = 0.0
        self.x_mm = 0.0
        self._v_mm_s, self._time_s = 0.0, 0.0
        self._press_s, self._asked = (0.0, 0.0, 0.0), (0.0, 0.0)

    def press(self, travel_mm: float, velocity_mm_s: float) -> None:
        """Have the hand press once from now on; it learns the pace from press to press."""
        entered_s, left_s, span_mm = self._press_s
        pace_mm_s = span_mm / (left_s - entered_s) if left_s > entered_s > 0 else 0.0
        if 0.3 * velocity_mm_s < pace_mm_s < 3.0 * velocity_mm_s:  # else it pressed no button
            self.hand.learn_speed(pace_mm_s)
        self._asked = 0.1 * travel_mm, 0.9 * travel_mm
        self._press_s = (0.0, 0.0, 0.8 * travel_mm)
        self.hand.press(travel_mm, velocity_mm_s)

    def release(self) -> None:
        """Take the finger off, at once; whose it was is forgotten."""
        self.hand, self._press_s = Hand(np.random.default_rng(0)), (0.0, 0.0, 0.0)

    def advance(self, now_s: float, command_N: float) -> None:
        """Move on to now with this force commanded all the while."""
        if self._time_s == 0.0 or now_s - self._time_s > LONGEST_s:
            self._time_s = now_s
        share = 1.0 - math.exp(-STEP_s / self.LAG_s)
        while self._time_s + STEP_s <= now_s:
            self._time_s += STEP_s
            self.motor_N += share * (command_N - self.motor_N)
            self.finger_N = self.hand.step(self.x_mm, self._v_mm_s, STEP_s)
            x_mm = self.cap.step(self.motor_N, self.finger_N, math.inf, STEP_s)
            self._v_mm_s, self.x_mm = 1e3 * self.cap.v_m_s, x_mm
            self._note_pace()

    def _note_pace(self) -> None:
        entered_s, left_s, span_mm = self._press_s
        if not entered_s and self.x_mm > self._asked[0] > 0:
            self._press_s = (self._time_s, 0.0, span_mm)
        elif entered_s and not left_s and self.x_mm > self._asked[1]:
            self._press_s = (entered_s, self._time_s, span_mm)
