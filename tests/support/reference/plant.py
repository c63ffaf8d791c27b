"""The reference's equations of motion, written apart from the compiled ones."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray

RELAX_s = 1e-5
STATES = 15
"""Finger x, v; fast and slow arm; cone x, v; cap x, v; current; position filter; force filter; stretch of the
friction's bristle; magnet x in the cap, v; warmth of the coil."""


def _smooth_step(s: float) -> tuple[float, float]:
    """Return minimum jerk (position, rate) on the unit interval."""
    s = min(max(s, 0.0), 1.0)
    return 10 * s**3 - 15 * s**4 + 6 * s**5, 30 * s**2 - 60 * s**3 + 30 * s**4


def referent(g: Gesture, t: float) -> tuple[float, float]:
    """Return the intended position and velocity of the finger."""
    down, rate_down = _smooth_step((t - g.onset_s) / g.press_s)
    up, rate_up = _smooth_step((t - g.onset_s - g.press_s - g.dwell_s) / g.release_s)
    reach = g.end_m - g.start_m
    return g.start_m + reach * (down - up), reach * (rate_down / g.press_s - rate_up / g.release_s)


def _hunt_crossley(k: float, alpha: float, depth: float, rate: float) -> float:
    return max(0.0, k * max(depth, 0.0) * (1 + 1.5 * alpha * rate))


@dataclass
class ReferencePlant:
    """The equations of motion, with the duty and the muscle's modulation of the present moment."""

    rig: Rig
    finger: Finger
    gesture: Gesture
    travel_m: float
    ratio: float = 0.0
    enabled: bool = False
    modulation: tuple[float, float, float, float] = (0.0, 1.0, 0.0, 0.0)

    def touch(self, y: FloatArray) -> float:
        """Return the force between cone and cap."""
        sensor = self.rig.force_sensor
        depth, rate = float(y[4] - y[6]), float(y[5] - y[7])
        return _hunt_crossley(sensor.contact_stiffness_N_m, sensor.contact_loss_s_m, depth, rate)

    def pulp(self, y: FloatArray) -> tuple[float, float, float]:
        """Return the force beyond the strap's, and the rates of the two arms."""
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
        """Return the pull of the referent, with the noise of its effort."""
        t0, t1, u0, u1 = self.modulation
        x, v = referent(self.gesture, t)
        pull = self.gesture.stiffness_N_m * (x - y[0]) + self.gesture.damping_N_s_m * (v - y[1])
        return float(pull * (1 + u0 + (u1 - u0) * (t - t0) / (t1 - t0)))

    def set_duty(self, duty_q15: int) -> None:
        """Set the bridge to what its converter makes of a duty."""
        c, ratio = self.rig.coil, duty_q15 / 32768
        self.enabled = True
        if c.command_bits:
            ratio = math.floor(ratio * 2**c.command_bits + 0.5) / 2**c.command_bits
        self.ratio = ratio if c.bipolar == "yes" else max(ratio, 0.0)

    def supply_V(self, y: FloatArray) -> float:
        """Return the supply voltage, which sags under the bridge's current."""
        c = self.rig.coil
        return c.supply_V - (c.source_ohm * self.ratio * float(y[8]) if c.drive == "voltage" else 0.0)

    def coil(self, y: FloatArray) -> tuple[float, float, float]:
        """Return the upward force, the rate of the current and the rate of warming."""
        c, amps, v = self.rig.coil, float(y[8]), float(y[7])
        off = float(y[6]) - c.centre_m
        constant = c.force_constant_N_A * (1 - c.droop_ratio * (2 * off / c.stroke_m) ** 2)
        henry = c.inductance_H + c.reluctance_H_m * off
        copper = c.resistance_ohm * (1 + c.copper_1_K * float(y[14]))
        lost = (copper + c.bridge_ohm) * amps + c.reluctance_H_m * v * amps - constant * v
        if c.drive == "voltage":
            volts = self.ratio * self.supply_V(y)
        else:
            lost += c.source_ohm * self.ratio**2 * amps
            wanted = self.ratio * c.supply_V / c.resistance_ohm
            volts = lost + henry * (wanted - amps) / c.current_loop_s
            volts = min(max(volts, -c.supply_V), c.supply_V)
        warming = (c.heat_K_W * copper * amps**2 - float(y[14])) / c.heat_s
        return (
            constant * amps - c.reluctance_H_m * amps**2 / 2,
            (volts - lost) / henry * self.enabled,
            warming,
        )

    def exciter(self, y: FloatArray, slip_rate: float = 0.0) -> tuple[float, float]:
        """Return the force on the cap and the magnet's acceleration, undriven.

        The lag of the current, microseconds, is that of a line: slip_rate is the rate of its cause.
        """
        e = self.rig.exciter
        if e.fitted == "no":
            return 0.0, 0.0
        omega, slip = 2 * math.pi * e.resonance_Hz, float(y[13] - y[7])
        force = e.mass_kg * omega**2 * float(y[12]) + e.mass_kg * omega / e.quality * slip
        lag_s = e.inductance_H / e.resistance_ohm
        force += e.motor_N_A**2 / e.resistance_ohm * (slip - lag_s * slip_rate)
        return force, -force / e.mass_kg

    def cap(self, y: FloatArray, touch: float, up: float, shake: float) -> tuple[float, float]:
        """Return the acceleration of the cap and the rate of the bristle's stretch."""
        mover, stops, v, bristle = self.rig.mover, self.rig.stops, float(y[7]), float(y[11])
        held = min(max(bristle, -mover.presliding_m), mover.presliding_m)
        rub = mover.coulomb_N * held / mover.presliding_m + mover.viscous_N_s_m * v
        slips = abs(bristle) >= mover.presliding_m and bristle * v > 0
        deep = float(y[6]) - self.travel_m
        bottom = _hunt_crossley(stops.bottom_stiffness_N_m, stops.bottom_loss_s_m, deep, v)
        top = _hunt_crossley(stops.top_stiffness_N_m, stops.top_loss_s_m, -float(y[6]), -v)
        force = touch - up - rub - bottom + top + shake + mover.mass_kg * mover.gravity_m_s2
        # a solver oversteps the edge of slipping: what is too much is let go of at once
        return force / self.rig.frame_kg, (held - bristle) / RELAX_s if slips else v

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """Return the time derivative of the state."""
        rig, touch = self.rig, self.touch(y)
        (pulp, fast, slow), (up, amps, warm) = self.pulp(y), self.coil(y)
        shake, magnet = self.exciter(y)
        finger = (self.muscle(t, y) - pulp) / self.finger.impedance.mass_kg
        cone = (pulp - touch) / rig.force_sensor.mass_kg
        lvdt = 2 * math.pi * rig.position_sensor.bandwidth_Hz * (y[6] - y[9])
        felt = (pulp - y[10]) / rig.force_sensor.filter_s
        cap, _ = self.cap(y, touch, up, shake)
        shake, magnet = self.exciter(y, magnet - cap)
        cap, bristle = self.cap(y, touch, up, shake)
        first = [y[1], finger, fast, slow, y[5], cone, y[7], cap, amps, lvdt, felt, bristle]
        return np.array([*first, y[13] - y[7], magnet, warm])
