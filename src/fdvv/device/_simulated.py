"""The simulated rig and its person, for boards in lockstep."""

from __future__ import annotations

import math

import numpy as np

from fdvv.device._plant import Inputs
from fdvv.protocol import Settings, travel_mm_of
from fdvv.twin import Finger, Rig, RigPlant, Trace, settings_of, solve_program_pace, vary
from fdvv.units import m_from_mm

SETTLE_s = 0.3
"""Without force the cap lies at the stop; it must be up before anyone presses."""


class SimulatedPerson:
    """Presses the twin's rig as the person of `TwinDevice` does, but on whatever board drives it. Simulated.

    Parameters
    ----------
    rig, finger : the default ones if None.
    seed : of everything random.
    """

    def __init__(self, rig: Rig | None = None, finger: Finger | None = None, seed: int = 0) -> None:
        self._plant = RigPlant(rig, finger, seed)
        self._random = np.random.default_rng(seed)
        self._paces: dict[tuple[bytes, float, Settings], float] = {}
        self._ticks = 0
        self.settle_s = SETTLE_s
        self.settings: Settings = settings_of(self._plant.rig)

    @property
    def ticks(self) -> int:
        """How many steps the press begun last takes."""
        return self._ticks

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        """Let one tick pass."""
        return Inputs(*self._plant.step(duty_q15, bool(enable), stop_us, slot).item())

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> SimulatedPerson:
        """Begin a press at about this speed; what happened before it is forgotten."""
        travel_m, speed_m_s = float(m_from_mm(travel_mm_of(image))), float(m_from_mm(velocity_mm_s))
        pace_s = self._pace_s(image, velocity_mm_s, settings)
        gesture = vary(self._plant.finger, travel_m, pace_s, speed_m_s, self._random)
        self._plant.record()
        self._plant.press(gesture)
        self._ticks = math.ceil(gesture.duration_s / (settings.tick_us * 1e-6))
        return self

    def _pace_s(self, image: bytes, velocity_mm_s: float, settings: Settings) -> float:
        key = image, velocity_mm_s, settings
        if key not in self._paces:
            self._paces[key] = solve_program_pace(
                self._plant.rig, self._plant.finger, image, velocity_mm_s, settings=settings
            )
        return self._paces[key]

    def record(self) -> Trace:
        """Give what happened since the press began."""
        return self._plant.record()

    def load(self, image: bytes) -> None:
        """Give the vibration board the waveforms of a program."""
        self._plant.load(image)

    def rest(self, settings: Settings) -> SimulatedPerson:
        """Leave the button alone: the finger rests once its press is over."""
        return self
