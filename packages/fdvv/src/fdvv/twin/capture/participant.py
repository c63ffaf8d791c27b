"""A simulated participant of a capture: presses, and how often and how one goes wrong."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from fdvv.errors import ModelError
from fdvv.twin.button import ButtonPhysics
from fdvv.twin.button_kernel import TICK_s
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture, depth_m, vary
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import (
    SETTLE_TICKS,
    ButtonNoise,
    ButtonTrace,
    button_ticks,
    draw_button_noise,
    simulate_button,
)
from fdvv.units import FloatArray, m_from_mm, mm_from_m

WILD = ("pace", "double tap", "hesitation", "marker knocked", "sensor slipped", "marker hidden")
"""How a press can go wild: far off the pace, twice, halting midway, or the bench is hit."""
LEAD_s = 0.18
"""Recorded before the finger moves: the light blinks, the cap rests."""
TAIL_s = 0.12
"""Recorded after the finger has gone."""
SHORT_mm = 0.15
"""An incomplete press stays at least this far from the bottom."""


@dataclass(frozen=True)
class Participant:
    """How often presses of a session go wrong; how good ones vary is the finger's habit.

    Attributes
    ----------
    incomplete_ratio : presses that turn round before the bottom.
    wild_ratio : presses that go wrong otherwise, each in one of kinds, all equally often.
    kinds : out of WILD.
    """

    incomplete_ratio: float = 0.04
    wild_ratio: float = 0.10
    kinds: tuple[str, ...] = WILD

    def __post_init__(self) -> None:
        object.__setattr__(self, "kinds", tuple(self.kinds))
        ratios = (self.incomplete_ratio, self.wild_ratio, 1 - self.incomplete_ratio - self.wild_ratio)
        if not all(math.isfinite(r) and r >= 0 for r in ratios):
            raise ModelError(
                "incomplete_ratio and wild_ratio must be at least 0 and together at most 1, "
                f"got {self.incomplete_ratio} and {self.wild_ratio}"
            )
        if not self.kinds or not set(self.kinds) <= set(WILD):
            raise ModelError(f"kinds must be some of {', '.join(WILD)}, got {self.kinds}")


PARTICIPANTS = {
    "steady": Participant(0.0, 0.0),
    "careful": Participant(0.01, 0.02),
    "typical": Participant(),
    "clumsy": Participant(0.08, 0.25),
}
"""People by name; the ratios are assumed."""


@dataclass(frozen=True)
class Intent:
    """What becomes of one press.

    Attributes
    ----------
    outcome : in one word.
    kind : of a wild one, else empty.
    amount : part of the travel that is reached; times the asked pace; pause or gap s; jump mm; times the
        force; time hidden s.
    part : of the stroke (0 to 1) at which it happens.
    marker : which one it happens to.
    """

    outcome: Literal["good", "incomplete", "wild"] = "good"
    kind: str = ""
    amount: float = 0.0
    part: float = 0.0
    marker: int = 0


def draw_intent(participant: Participant, random: np.random.Generator) -> Intent:
    """Draw what becomes of the next press; always as many draws, so that what follows stays the same."""
    draw, amount, part, which, way, side = (float(value) for value in random.random(6))
    kind = participant.kinds[int(which * len(participant.kinds))]
    if draw < participant.incomplete_ratio:
        return Intent("incomplete", amount=0.5 + 0.4 * amount)
    if draw < participant.incomplete_ratio + participant.wild_ratio:
        return Intent("wild", kind, _amount(kind, amount, way < 0.5), 0.2 + 0.6 * part, int(2 * side))
    return Intent()


def _amount(kind: str, draw: float, fast: bool) -> float:
    ranges = {
        "pace": (1.7, 3.0) if fast else (0.3, 0.6),
        "double tap": (0.02, 0.08),
        "hesitation": (0.08, 0.3),
        "marker knocked": (0.5, 3.0),
        "sensor slipped": (0.6, 0.85),
        "marker hidden": (0.02, 0.06),
    }
    low, high = ranges[kind]
    return low + (high - low) * draw


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
        detoured = {"double tap": _tap_twice, "hesitation": _pause_on_the_way}.get(intent.kind)
        gesture, detour = detoured(gesture, intent) if detoured else (gesture, None)
        return self._simulate(gesture, self._noise(gesture, random), detour)

    def rest(self, duration_s: float, random: np.random.Generator) -> ButtonTrace:
        """Simulate a cap that nobody touches."""
        # a referent 20 mm above the cap all the time
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
            # carried on by its momentum: the same press, aimed less deep
            aim = replace(aim, end_m=aim.start_m + 0.93 * (aim.end_m - aim.start_m))


def _pause_on_the_way(gesture: Gesture, intent: Intent) -> tuple[Gesture, FloatArray]:
    """Go down in two moves with a pause between them; the gesture is the second, the detour the first."""
    first_s, second_s = intent.part * gesture.press_s, (1 - intent.part) * gesture.press_s
    later = replace(gesture, onset_s=gesture.onset_s + first_s + intent.amount, press_s=second_s)
    t = _ticks_s(later)
    moves = _smooth((t - gesture.onset_s) / first_s) - _smooth((t - later.onset_s) / second_s)
    return later, intent.part * (gesture.end_m - gesture.start_m) * moves


def _tap_twice(gesture: Gesture, intent: Intent) -> tuple[Gesture, FloatArray]:
    """Press again after a short gap; the gesture is the first press, the detour the second."""
    before_s = gesture.onset_s + gesture.press_s + gesture.dwell_s + gesture.release_s + intent.amount
    again_s = gesture.press_s + gesture.dwell_s + gesture.release_s
    longer = replace(gesture, tail_s=gesture.tail_s + intent.amount + again_s)
    t = _ticks_s(longer) - before_s
    up = t - gesture.press_s - gesture.dwell_s
    moves = _smooth(t / gesture.press_s) - _smooth(up / gesture.release_s)
    return longer, (gesture.end_m - gesture.start_m) * moves


def _ticks_s(gesture: Gesture) -> FloatArray:
    """Return the times at which a detour is stated, those of settling included."""
    return np.asarray(TICK_s * np.arange(-SETTLE_TICKS, button_ticks(gesture) + 1))


def _smooth(part: FloatArray) -> FloatArray:
    """Minimum jerk from 0 to 1, held outside."""
    s = np.clip(part, 0.0, 1.0)
    return np.asarray(s**3 * (10 + s * (6 * s - 15)))
