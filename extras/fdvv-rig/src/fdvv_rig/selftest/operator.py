"""Who lays gauges and weights on a rig while it is tested: the twin's own hands, or a person who is asked."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Protocol

from fdvv.device.plant import Inputs, PressedPlant
from fdvv.errors import DeviceError
from fdvv.protocol.tables import NONE, Settings
from fdvv.twin.finger import Finger
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv.units import mm_from_m
from fdvv_rig.selftest.faults import FULL, RigFault

HOVER_m = 0.008
LAY_s, LAY_mm = 0.2, 0.7
HAND_N = 4.0
"""Overcomes a slider that sticks."""
SOUND = RigFault("", "nothing is wrong")
"""The fault of a rig that has none."""
G_cN = 0.980665
"""Weight of a gram."""


class Operator(Protocol):
    """Someone at the rig."""

    def gauge(self, size_mm: float | None) -> None:
        """Lay a thing of this size between stop and cap and press the cap onto it, or take it out."""
        ...

    def let_go(self) -> None:
        """Take the hand off the cap."""
        ...

    def weight(self, mass_g: float | None) -> None:
        """Lay a weight onto the force sensor on the cap, or take it off."""
        ...


class PromptedOperator:
    """A person at a real rig: every step is said, and waited for."""

    def __init__(self, ask: Callable[[str], None]) -> None:
        self._ask = ask

    def gauge(self, size_mm: float | None) -> None:
        """Ask for a gauge."""
        if size_mm is None:
            self._ask("Take the gauge out; do not touch the cap.")
        else:
            self._ask(f"Lay the gauge of {size_mm:g} mm under the cap, press the cap onto it, and let go.")

    def let_go(self) -> None:
        """Nothing is left to ask."""

    def weight(self, mass_g: float | None) -> None:
        """Ask for a weight."""
        if mass_g is None:
            self._ask("Take the weight off; do not touch the cap.")
        else:
            self._ask(f"Lay the weight of {mass_g:g} g onto the force sensor on the cap, and let go.")


class SimulatedOperator:
    """A simulated rig with one fault, or none, upright, that nobody presses. Simulated.

    Parameters
    ----------
    rig : what the settings are made for: the builder's own idea of it.
    built : what was really built; the same if None.
    fault, seed : what is wrong; of everything random.

    It is the person of a LinkedDevice as well as the hands of a self-test.
    """

    settle_s = 0.0

    def __init__(
        self, rig: Rig | None = None, seed: int = 0, fault: RigFault = SOUND, built: Rig | None = None
    ) -> None:
        rig = rig or Rig()
        hovering = Finger()
        hovering = replace(hovering, habit=replace(hovering.habit, lift_m=HOVER_m))
        self._fault = fault
        self._rig = fault.rig(built or rig)
        self._plant = RigPlant(self._rig, hovering, seed)
        self._plant.lift(HOVER_m)
        self._gauge_mm: float | None = None
        self._laid_s = 0.0
        self._tick = 0
        self.settings: Settings = settings_of(rig)

    def step(self, duty_q15: int, enable: int, stop_us: int, slot: int) -> Inputs:
        """Let one tick pass, as the fault has it."""
        tick_s = self._rig.controller.tick_s
        ratio = self._fault.duty(duty_q15 / (FULL + 1), self._tick * tick_s, tick_s)
        self._tick += 1
        duty = 0 if ratio is None else max(-FULL, min(FULL, round(ratio * (FULL + 1))))
        sensed = self._plant.step(
            duty,
            bool(enable) and ratio is not None,
            self._pulse_us(stop_us),
            NONE if self._fault.silent else slot,
        )
        sensor = self._rig.position_sensor
        return self._fault.inputs(Inputs(*sensed.item()), sensor.reads, 2**sensor.converter_bits)

    def _pulse_us(self, stop_us: int) -> int:
        if self._gauge_mm is not None:
            return self._gauge_us(self._gauge_mm)
        if self._fault.stop_mm is not None:
            return self._pulse_for(self._fault.stop_mm)
        return stop_us + self._fault.stop_us if stop_us else 0

    def _gauge_us(self, size_mm: float) -> int:
        servo, tick_s = self._rig.servo, self._rig.controller.tick_s
        deep = self._tick * tick_s - self._laid_s < LAY_s
        return self._pulse_for(size_mm + LAY_mm if deep else size_mm - float(mm_from_m(servo.play_m)))

    def _pulse_for(self, depth_mm: float) -> int:
        servo = self._rig.servo
        return round(servo.pulse_zero_us + servo.pulse_us_mm * depth_mm)

    def gauge(self, size_mm: float | None) -> None:
        """Put the bottom stop exactly there, whatever the servo does, and press the cap onto it."""
        self._gauge_mm, self._laid_s = size_mm, self._tick * self._rig.controller.tick_s
        if size_mm is not None:
            self._plant.push(HAND_N)

    def let_go(self) -> None:
        """Take the finger off."""
        self._plant.lift(HOVER_m)

    def weight(self, mass_g: float | None) -> None:
        """Let the finger push with that weight, or go away."""
        if mass_g is None:
            self._plant.lift(HOVER_m)
        else:
            self._plant.push(0.01 * G_cN * mass_g)

    def press(self, image: bytes, velocity_mm_s: float, settings: Settings) -> PressedPlant:
        """Refuse: nobody presses here."""
        raise DeviceError("nobody presses a rig under test; open it without one")

    def load(self, image: bytes) -> None:
        """Return the vibration board the waveforms of a program."""
        self._plant.load(image)

    def rest(self, settings: Settings) -> SimulatedOperator:
        """Leave the button alone."""
        return self
