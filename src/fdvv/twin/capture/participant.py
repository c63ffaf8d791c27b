"""One press of a capture: what the participant does, simulated on the button. Simulated."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.twin._button import ButtonPhysics
from fdvv.twin._button_noise import ButtonNoise, button_ticks, draw_button_noise, settle_button_ticks
from fdvv.twin._finger import Finger
from fdvv.twin._flatten_button import TICK_s
from fdvv.twin._gesture import Gesture, depth_m, vary
from fdvv.twin._participant import Intent
from fdvv.twin._rig_senses import ForceSensor
from fdvv.twin._simulate_button import ButtonTrace, simulate_button
from fdvv.units import FloatArray, m_from_mm, mm_from_m

LEAD_s = 0.18
"""Recorded before the finger moves: the light blinks, the cap rests."""
TAIL_s = 0.12
"""Recorded after the finger has gone."""
SHORT_mm = 0.15
"""An incomplete press stays at least this far from the bottom."""


@dataclass(frozen=True)
class Presser:
    """Who presses what, with which force sensor on the finger; zero_N is that sensor's zero today."""

    button: ButtonPhysics
    finger: Finger
    sensor: ForceSensor
    zero_N: float

    def press(
        self, press_s: float, velocity_mm_s: float, intent: Intent, random: np.random.Generator
    ) -> ButtonTrace:
        """Simulate one press; press_s is the referent's stroke for the asked pace."""
        travel_m = self.button.curve.travel_m
        drawn = vary(self.finger, travel_m, press_s, float(m_from_mm(velocity_mm_s)), random)
        gesture = replace(drawn, onset_s=drawn.onset_s + LEAD_s, tail_s=TAIL_s)
        if intent.kind == "pace":
            times = {name: getattr(gesture, name) / intent.amount for name in ("press_s", "release_s")}
            gesture = replace(gesture, **times)
        if intent.outcome == "incomplete":
            return self._incomplete(gesture, intent.amount, random)
        detoured = {"double tap": _tapped_twice, "hesitation": _halted}.get(intent.kind)
        gesture, detour = detoured(gesture, intent) if detoured else (gesture, None)
        return self._simulate(gesture, self._noise(gesture, random), detour)

    def rest(self, duration_s: float, random: np.random.Generator) -> ButtonTrace:
        """Simulate a cap that nobody touches."""
        away = Gesture(-0.02, -0.02, 0.0, duration_s / 2, 0.0, duration_s / 2, 450.0, 4.5, 0.0)
        return self._simulate(away, self._noise(away, random), None)

    def _noise(self, gesture: Gesture, random: np.random.Generator) -> ButtonNoise:
        noise = draw_button_noise(self.finger, gesture, random, self.sensor)
        return replace(noise, force_N=noise.force_N + self.zero_N)

    def _simulate(self, gesture: Gesture, noise: ButtonNoise, detour: FloatArray | None) -> ButtonTrace:
        return simulate_button(self.button, self.finger, gesture, noise, self.sensor, detour_m=detour)

    def _incomplete(self, gesture: Gesture, part: float, random: np.random.Generator) -> ButtonTrace:
        """Turn where the finger balances the button at that part of the travel, or above if it overshoots."""
        curve = self.button.curve
        force_N = float(np.interp(part, np.linspace(0, 1, self.button.press_N.size), self.button.press_N))
        beyond = depth_m(self.finger, curve.force_ratio * force_N, gesture.stiffness_N_m)
        aim = replace(gesture, end_m=part * curve.travel_m + beyond, dwell_s=0.0)
        noise = self._noise(aim, random)
        while True:
            trace = self._simulate(aim, noise, None)
            if trace.displacement_mm.max() <= mm_from_m(curve.travel_m) - SHORT_mm:
                return trace
            aim = replace(aim, end_m=aim.start_m + 0.93 * (aim.end_m - aim.start_m))


def _halted(gesture: Gesture, intent: Intent) -> tuple[Gesture, FloatArray]:
    """Go down in two moves with a pause between them; the gesture is the second, the detour the first."""
    first_s, second_s = intent.part * gesture.press_s, (1 - intent.part) * gesture.press_s
    later = replace(gesture, onset_s=gesture.onset_s + first_s + intent.amount, press_s=second_s)
    t = _ticks_s(later)
    moves = _smooth((t - gesture.onset_s) / first_s) - _smooth((t - later.onset_s) / second_s)
    return later, intent.part * (gesture.end_m - gesture.start_m) * moves


def _tapped_twice(gesture: Gesture, intent: Intent) -> tuple[Gesture, FloatArray]:
    """Press again after a short gap; the gesture is the first press, the detour the second."""
    before_s = gesture.onset_s + gesture.press_s + gesture.dwell_s + gesture.release_s + intent.amount
    again_s = gesture.press_s + gesture.dwell_s + gesture.release_s
    longer = replace(gesture, tail_s=gesture.tail_s + intent.amount + again_s)
    t = _ticks_s(longer) - before_s
    up = t - gesture.press_s - gesture.dwell_s
    moves = _smooth(t / gesture.press_s) - _smooth(up / gesture.release_s)
    return longer, (gesture.end_m - gesture.start_m) * moves


def _ticks_s(gesture: Gesture) -> FloatArray:
    """Give the times at which a detour is stated, those of settling included."""
    settle = settle_button_ticks()
    return np.asarray(TICK_s * (np.arange(settle + button_ticks(gesture) + 1) - settle))


def _smooth(part: FloatArray) -> FloatArray:
    """Minimum jerk from 0 to 1, held outside."""
    s = np.clip(part, 0.0, 1.0)
    return np.asarray(s**3 * (10 + s * (6 * s - 15)))
