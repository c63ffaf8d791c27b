"""A slow press for checking the fast one: SciPy's adaptive solvers and a controller in plain Python.

Shares no code with the compiled kernel and reads rig and finger directly, so that a slip in either shows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from fdvv.model import ForceSurface
from fdvv.twin._finger import Finger
from fdvv.twin._firmware import Firmware
from fdvv.twin._gesture import Gesture
from fdvv.twin._noise import Noise, count_ticks, reads_of, settle_ticks
from fdvv.twin._rig import Rig
from fdvv.units import FloatArray, cN_from_N, m_from_mm, mm_from_m

STATES = 11
"""Finger x, v; fast and slow arm; cone x, v; cap x, v; current; position filter; force filter."""

ROW_s, TINY_s = 1e-4, 1e-12
LONGEST_STEP_s = 2e-4
"""Cap on the solver's step, so that it cannot stride over a short contact."""


@dataclass(frozen=True, eq=False)
class ReferenceTrace:
    """What the reference gives, simulated; columns (n,) at the times of a Trace, sensed ones held."""

    t_s: FloatArray
    displacement_mm: FloatArray
    force_cN: FloatArray
    sensed_mm: FloatArray
    sensed_cN: FloatArray
    commanded_cN: FloatArray


def _smooth_step(s: float) -> tuple[float, float]:
    """Give minimum jerk (position, rate) on the unit interval."""
    s = min(max(s, 0.0), 1.0)
    return 10 * s**3 - 15 * s**4 + 6 * s**5, 30 * s**2 - 60 * s**3 + 30 * s**4


def _hunt_crossley(k: float, alpha: float, depth: float, rate: float) -> float:
    return max(0.0, k * max(depth, 0.0) * (1 + 1.5 * alpha * rate))


@dataclass
class _Plant:
    """The equations of motion, with the drive and the muscle's modulation of the present moment."""

    rig: Rig
    finger: Finger
    gesture: Gesture
    travel_m: float
    drive: float = 0.0
    modulation: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 0.0)

    def referent(self, t: float) -> tuple[float, float]:
        """Give where the finger means to be, and how fast."""
        g = self.gesture
        down, rate_down = _smooth_step((t - g.onset_s) / g.press_s)
        up, rate_up = _smooth_step((t - g.onset_s - g.press_s - g.dwell_s) / g.release_s)
        reach = g.end_m - g.start_m
        return g.start_m + reach * (down - up), reach * (rate_down / g.press_s - rate_up / g.release_s)

    def touch(self, y: FloatArray) -> float:
        """Give the force between cone and cap."""
        sensor = self.rig.force_sensor
        depth, rate = float(y[4] - y[6]), float(y[5] - y[7])
        return _hunt_crossley(sensor.contact_stiffness_N_m, sensor.contact_loss_s_m, depth, rate)

    def pulp(self, y: FloatArray) -> tuple[float, float, float]:
        """Give the force beyond the strap's, and the rates of the two arms."""
        p = self.finger.pulp
        relaxed_N = p.relaxed_ratio * p.scale_N
        rest = math.log((p.strap_N + relaxed_N) / relaxed_N)
        grown = p.scale_N * math.exp(p.exponent_1_m * (y[0] - y[4]) + rest)
        rate = p.exponent_1_m * grown * (y[1] - y[5])
        force = p.relaxed_ratio * (grown - p.scale_N) + y[2] + y[3] - p.strap_N
        fast = (1 - p.relaxed_ratio) * p.fast_share * rate - y[2] / p.fast_s
        slow = (1 - p.relaxed_ratio) * (1 - p.fast_share) * rate - y[3] / p.slow_s
        return float(force), float(fast), float(slow)

    def muscle(self, t: float, y: FloatArray) -> float:
        """Give the pull of the referent, with the noise of its effort."""
        t0, t1, u0, u1 = self.modulation
        x, v = self.referent(t)
        pull = self.gesture.stiffness_N_m * (x - y[0]) + self.gesture.damping_N_s_m * (v - y[1])
        return float(pull * (1 + u0 + (u1 - u0) * (t - t0) / (t1 - t0)))

    def coil(self, y: FloatArray) -> tuple[float, float]:
        """Give the force up and the rate of the current."""
        c = self.rig.coil
        off = (y[6] - c.centre_m) / (0.5 * c.stroke_m)
        constant = c.force_constant_N_A * (1 - c.droop_ratio * off**2)
        volts = self.drive
        if c.drive == "current":
            volts = c.resistance_ohm * y[8] - constant * y[7]
            volts += c.inductance_H * (self.drive - y[8]) / c.current_loop_s
            volts = min(max(volts, -c.supply_V), c.supply_V)
        amps_rate = (volts - c.resistance_ohm * y[8] + constant * y[7]) / c.inductance_H
        return float(constant * y[8]), float(amps_rate)

    def cap(self, y: FloatArray, touch: float, up: float) -> float:
        """Give the acceleration of the cap."""
        mover, stops, v = self.rig.mover, self.rig.stops, float(y[7])
        rub = mover.coulomb_N * v / math.hypot(v, mover.coulomb_speed_m_s) + mover.viscous_N_s_m * v
        deep = float(y[6]) - self.travel_m
        bottom = _hunt_crossley(stops.bottom_stiffness_N_m, stops.bottom_loss_s_m, deep, v)
        top = _hunt_crossley(stops.top_stiffness_N_m, stops.top_loss_s_m, -float(y[6]), -v)
        return (touch - up - rub - bottom + top) / mover.mass_kg + mover.gravity_m_s2

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """Give the time derivative of the state."""
        rig, touch = self.rig, self.touch(y)
        (pulp, fast, slow), (up, amps) = self.pulp(y), self.coil(y)
        finger = (self.muscle(t, y) - pulp) / self.finger.impedance.mass_kg
        cone = (pulp - touch) / rig.force_sensor.mass_kg
        lvdt = 2 * math.pi * rig.position_sensor.bandwidth_Hz * (y[6] - y[9])
        felt = (pulp - y[10]) / rig.force_sensor.filter_s
        cap = self.cap(y, touch, up)
        return np.array([y[1], finger, fast, slow, y[5], cone, y[7], cap, amps, lvdt, felt])


@dataclass
class _Run:
    """A press under way: the plant's state, the controller, and the rows so far."""

    plant: _Plant
    firmware: Firmware
    noise: Noise
    method: Literal["DOP853", "Radau"]
    rtol: float
    y: FloatArray
    lvdt_m: FloatArray
    rows: list[tuple[float, ...]] = field(default_factory=list)

    def tick(self, k: int, start: float, recorded: bool) -> None:
        """Sense, decide, and solve up to the next tick; the new drive comes after the compute delay."""
        rig, noise = self.plant.rig, self.noise
        sensor, control = rig.position_sensor, rig.controller
        u = self.lvdt_m / (sensor.range_m / 2)
        bend = 1.5 * math.sqrt(3) * (u - u**3)
        reads = self.lvdt_m + bend * sensor.linearity_ratio * sensor.range_m / 2
        if k:
            reads = reads + noise.position_m[k]
        seen = self.firmware.tick(start, reads, float(self.y[10]), float(noise.force_N[k]))
        end = start + control.tick_s
        self.plant.modulation = (start, end, float(noise.effort_ratio[k]), float(noise.effort_ratio[k + 1]))
        if control.compute_s > 0:
            self.solve(start, start, start + control.compute_s, seen, recorded)
        self.plant.drive = self.firmware.drive(seen[2])
        self.solve(start, start + control.compute_s, end, seen, recorded)

    def solve(self, start: float, a: float, b: float, seen: tuple[float, ...], recorded: bool) -> None:
        """Solve from a to b within the tick that began at start; collect rows and reads on the way."""
        from scipy.integrate import solve_ivp

        solution = solve_ivp(
            self.plant.rates,
            (a, b),
            self.y,
            self.method,
            dense_output=True,
            rtol=self.rtol,
            atol=1e-11,
            max_step=LONGEST_STEP_s,
        )
        rig, state_at = self.plant.rig, solution.sol
        assert state_at is not None  # asked for by dense_output
        rows = start + ROW_s * np.arange(round(rig.controller.tick_s / ROW_s))
        for t in rows[(rows >= a - TINY_s) & (rows < b - TINY_s)] if recorded else ():
            y = state_at(t)
            self.rows.append((t, y[6], self.plant.touch(y), *seen))
        spacing = rig.position_sensor.burst_s / self.lvdt_m.size
        reads = start + rig.controller.tick_s - spacing * np.arange(self.lvdt_m.size)[::-1]
        inside = (reads > a + TINY_s) & (reads <= b + TINY_s)
        if inside.any():
            self.lvdt_m[inside] = state_at(reads[inside])[9]
        self.y = solution.y[:, -1]


def reference_simulate(
    rig: Rig,
    finger: Finger,
    gesture: Gesture,
    surface: ForceSurface,
    travel_mm: float,
    noise: Noise,
    announced_mm_s: float,
    method: Literal["DOP853", "Radau"] = "DOP853",
    rtol: float = 1e-8,
) -> ReferenceTrace:
    """Simulate one press as simulate() does, with SciPy's solve_ivp between the controller's events.

    method : DOP853 or Radau, whose agreement tells how far either can be trusted. Takes seconds.
    """
    y = np.zeros(STATES)
    y[0] = y[4] = min(gesture.start_m, 0.0)
    plant = _Plant(rig, finger, gesture, float(m_from_mm(travel_mm)))
    firmware = Firmware(rig, surface, announced_mm_s)
    run = _Run(plant, firmware, noise, method, rtol, y, np.zeros(reads_of(rig)))
    settle = settle_ticks(rig)
    for k in range(settle + count_ticks(rig, gesture)):
        run.tick(k, (k - settle) * rig.controller.tick_s, k >= settle)
    t, cap, force, sensed, felt, command = np.array(run.rows).T
    forces_cN = [cN_from_N(column) for column in (felt, command)]
    return ReferenceTrace(t, mm_from_m(cap), cN_from_N(force), mm_from_m(sensed), *forces_cN)
