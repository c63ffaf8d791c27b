"""The rig's loop by itself: a cap without a finger on a table of constant slope, exact and simulated."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fdvv.firmware.core import Core
from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger, PressVariability
from fdvv.twin.image import image_of
from fdvv.twin.plant import RigPlant
from fdvv.twin.rig import Controller, PositionSensor, Rig
from fdvv.twin.rig_moves import Coil, Exciter, Mover
from fdvv.twin.settings import settings_of
from fdvv.units import FloatArray

AWAY = Finger(habit=PressVariability(lift_m=0.02).still())
"""A finger that does not touch the cap."""
MIDDLE_mm = 1.0


def spring(stiffness_N_m: float) -> ForceSurface:
    """Return a table that pulls the cap to 1 mm from both sides, over 2 mm."""
    force_cN = 0.1 * stiffness_N_m * np.array([[-MIDDLE_mm, MIDDLE_mm]])
    return ForceSurface(np.array([0.0, 2 * MIDDLE_mm]), np.array([50.0]), force_cN, force_cN)


def swings_mm(rig: Rig, stiffness_N_m: float, lasts_s: float = 1.0) -> tuple[float, float]:
    """Let the cap go from its top stop; return how far it moves in the third and in the last fifth of it."""
    settings = settings_of(rig)
    core = Core(settings, image_of(spring(stiffness_N_m), 2 * MIDDLE_mm).image)
    core.arm()
    plant = RigPlant(rig, AWAY, seed=None, stop_us=settings.stop_zero_us + settings.stop_us_mm * 4)
    for _ in range(round(lasts_s / rig.controller.tick_s)):
        out = core.tick(plant.inputs)
        plant.step(out["duty_q15"], out["enable"], settings.stop_zero_us + 4 * settings.stop_us_mm)
    trace = plant.record()
    fifths = np.array_split(trace.displacement_mm, 5)
    return float(np.ptp(fifths[2])), float(np.ptp(fifths[4]))


def cycles(rig: Rig, stiffness_N_m: float, still_mm: float = 0.01) -> bool:
    """Return whether the cap goes on moving: further than the sensor's grain, and without dying away."""
    before, after = swings_mm(rig, stiffness_N_m)
    return after > max(still_mm, 0.9 * before)


def onset_N_m(rig: Rig, low_N_m: float, high_N_m: float, rounds: int = 7) -> float:
    """Find the stiffness at which the cap begins to cycle, by bisection: low rests, high cycles."""
    for _ in range(rounds):
        middle = math.sqrt(low_N_m * high_N_m)
        low_N_m, high_N_m = (low_N_m, middle) if cycles(rig, middle) else (middle, high_N_m)
    return math.sqrt(low_N_m * high_N_m)


@dataclass(frozen=True)
class LinearLoop:
    """The same loop as matrices: x, v, current and filter, with sampled control. Voltage drive, no friction.

    Sources: sampled-data systems by matrix exponentials; the loop as docs/explanation/twin.md tells it.
    """

    rig: Rig

    def limit_N_m(self) -> float:
        """Return the stiffness at which the largest eigenvalue of a tick reaches 1."""
        low, high = 1.0, 1e5
        for _ in range(60):
            middle = math.sqrt(low * high)
            low, high = (low, middle) if self.radius(middle) > 1 else (middle, high)
        return low

    def radius(self, stiffness_N_m: float) -> float:
        """Return the size of the largest eigenvalue of one tick."""
        return float(np.abs(np.linalg.eigvals(self.tick(stiffness_N_m))).max())

    def tick(self, stiffness_N_m: float) -> FloatArray:
        """Map (x, v, A, filter, V held, mean of the reads) from one tick to the next."""
        control, position = self.rig.controller, self.rig.position_sensor
        state = np.eye(6)
        state = self._go(control.compute_s) @ state
        state[4] = self._volts_per_m(stiffness_N_m) * np.eye(6)[5]
        spacing = position.burst_s / position.reads
        reads = control.tick_s - control.compute_s - spacing * np.arange(position.reads)[::-1]
        mean = np.zeros(6)
        for at in reads:
            # a read before the new drive is on belongs to the first part of the tick
            seen = self._go(at) @ state if at >= 0 else self._go(control.compute_s + at)
            mean += seen[3] / position.reads
        state = self._go(control.tick_s - control.compute_s) @ state
        state[5] = mean
        return state

    def _volts_per_m(self, stiffness_N_m: float) -> float:
        coil = self.rig.coil
        return stiffness_N_m / coil.force_constant_N_A * (coil.resistance_ohm + coil.bridge_ohm)

    def _go(self, span_s: float) -> FloatArray:
        from scipy.linalg import expm

        coil, mover = self.rig.coil, self.rig.mover
        kt, ohm = coil.force_constant_N_A, coil.resistance_ohm + coil.bridge_ohm
        omega = 2 * math.pi * self.rig.position_sensor.bandwidth_Hz
        rates = np.zeros((6, 6))
        rates[0, 1] = 1.0
        rates[1, 1], rates[1, 2] = -mover.viscous_N_s_m / mover.mass_kg, -kt / mover.mass_kg
        rates[2] = np.array([0.0, kt, -ohm, 0.0, 1.0, 0.0]) / coil.inductance_H
        rates[3, 0], rates[3, 3] = omega, -omega
        return np.asarray(expm(rates * span_s))


def quantisation_limit_N_m(rig: Rig) -> float:
    """Return the stiffness up to which Coulomb friction swallows what a coarse position feeds in: 2 f / step.

    Source: Abbott and Okamura 2005.
    """
    grain_m = rig.position_sensor.range_m / float(2**rig.position_sensor.converter_bits)
    return 2 * rig.mover.coulomb_N / grain_m


def bare_loop(tick_s: float = 1e-3) -> Rig:
    """Return the rig voltage as LinearLoop has it: linear, without friction, weight or exciter."""
    linear = Coil(droop_ratio=0.0, source_ohm=0.0, reluctance_H_m=0.0, copper_1_K=0.0, command_bits=0)
    return Rig(
        coil=linear,
        exciter=Exciter(fitted="no"),
        mover=Mover(gravity_m_s2=0.0, coulomb_N=0.0),
        position_sensor=PositionSensor(linearity_ratio=0.0),
        controller=Controller(tick_s=tick_s, compute_s=min(3e-4, 0.4 * tick_s)),
    )


def grainy_loop() -> Rig:
    """Return a rig where only the grain of the position feeds energy in: fast loop, coarse converter."""
    linear = bare_loop()
    return replace(
        linear,
        coil=replace(linear.coil, drive="current", current_loop_s=5e-5),
        mover=Mover(gravity_m_s2=0.0, coulomb_N=0.01, viscous_N_s_m=1.0, presliding_m=1e-6),
        position_sensor=PositionSensor(
            linearity_ratio=0.0, converter_bits=10, reads=64, bandwidth_Hz=5000.0, burst_s=2.5e-5
        ),
        controller=Controller(tick_s=1e-4, compute_s=1e-5),
    )
