"""Presses by formula: a cap of known mass, drag, friction and coil that a finger moves on minimum jerk."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensation.parts.facts import PressFacts
from fdvv.model.press import Press
from fdvv.units import FloatArray
from tests.support.other_rigs import minimum_jerk

TICK_s, TRAVEL_mm = 1e-3, 4.0
WEIGHT_cN, MASS_g, FRICTION_cN, DRAG_cN_s_mm = 15.0, 15.0, 4.0, 0.05
REST_s, STROKE_s, DWELL_s, PUSH_cN = 0.05, 0.12, 0.04, 120.0


@dataclass(frozen=True)
class Scripted:
    """One press. gain : of the coil; zero_cN, scale : of the force sensor; depth_mm : where the stop stands.

    wave_cN : of the command about 50 cN.
    """

    gain: float = 1.0
    zero_cN: float = 0.0
    scale: float = 1.0
    depth_mm: float = TRAVEL_mm
    wave_cN: float = 15.0
    seed: int = 0

    def columns(self) -> tuple[FloatArray, FloatArray, FloatArray]:
        """Return place, command and force of every tick."""
        random = np.random.default_rng(self.seed)
        t = np.arange(round((2 * (REST_s + STROKE_s) + DWELL_s) / TICK_s), dtype=np.float64) * TICK_s
        begun = (t - REST_s) / STROKE_s
        place = self.depth_mm * (minimum_jerk(begun) - minimum_jerk(begun - 1 - DWELL_s / STROKE_s))
        command = 50 + self.wave_cN * np.sin(2 * np.pi * place / 1.6)
        speed = np.gradient(place, TICK_s)
        inertia = MASS_g * np.gradient(speed, TICK_s) / 10_000
        felt = self.gain * command - WEIGHT_cN + inertia + DRAG_cN_s_mm * speed
        felt += FRICTION_cN * np.clip(speed / 5, -1, 1)
        at_stop = place > self.depth_mm - 0.02
        felt = np.where(at_stop, felt + PUSH_cN, felt)
        felt = np.where(place < 0.02, 0.0, felt)
        noise = 0.2 * random.standard_normal(t.size)
        sensed = place + 0.005 * random.standard_normal(t.size)
        return sensed, command, self.scale * felt + self.zero_cN + noise

    def facts(self) -> PressFacts:
        place, command, force = self.columns()
        return PressFacts(TICK_s, place, command, force, TRAVEL_mm)

    def press(self) -> Press:
        place, command, force = self.columns()
        t = np.arange(place.size, dtype=np.float64) * TICK_s
        every = np.ones(t.size, dtype=np.bool_)
        return Press(t, place, force, 50.0, place, force, command, ~every, every)
