"""The rig with a load cell as docs/explanation/twin.md describes it, solved as a hybrid automaton.

Written from that page, in other variables than the compiled twin: pulp and cell as compressions, the pulp's
arms as stretches of their dashpots, friction as sticking and slipping. Contacts, slips, saturations of the
drive and lifting fingers are events whose moment is found, not corners that a fixed step runs over.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from fdvv.firmware.core import INPUTS, RecordArray
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.noise import Noise
from fdvv.twin.rig import Rig
from fdvv.units import FloatArray
from tests.support.reference.hybrid import Guard, Method, Rates, solve_span

FINGER, FINGER_V, DASH_1, DASH_2, CELL, CELL_V, CAP, CAP_V, AMPS, PLACE, FILTERED, WARM = range(12)
"""State: finger, its velocity; stretch of the two dashpots as forces; compression of the cell, its rate;
cap, its velocity; current; demodulator; filter of the cell; warmth of the coil."""


@dataclass
class Mode:
    """Which piece of each piecewise equation holds."""

    touches: bool = True
    """The finger presses the plate."""
    slips: int = 0
    """-1, 0, 1: direction in which the friction slips, 0 where it sticks."""
    at_bottom: bool = False
    at_top: bool = False
    saturated: int = 0
    """-1, 0, 1: at which end of the supply the drive is."""


@dataclass
class CellRig:
    """Finger, cell, rig and converters between the outputs of a board and its readings. Simulated.

    A tick takes what step() receives compute_s after it began and returns the readings of the next.
    """

    rig: Rig
    finger: Finger
    gesture: Gesture
    stop_m: float
    noise: Noise
    method: Method = "DOP853"
    tick: int = 0
    mode: Mode = field(default_factory=Mode)

    def __post_init__(self) -> None:
        rig = self.rig
        assert (rig.has_cell, rig.coil.drive, rig.exciter.fitted) == (True, "current", "no")
        self.y = np.zeros(12)
        self.y[FINGER] = min(self.gesture.start_m, 0.0)
        # no arm of the pulp carries a force yet: each dashpot is stretched by all that its spring has
        self.y[DASH_1], self.y[DASH_2] = (share * self.elastic_N(self.y) for share in self.shares())
        self.mode.touches = self.pulp_N(self.y) >= 0
        self.stuck = (0.0, 0.0)  # stretch of the bristle, and cap, where it last began to stick
        self.amps_set = 0.0
        self.enabled = False
        self.effort = (0.0, 0.0)
        self.mover_kg = rig.mover.mass_kg - rig.load_cell.plate_kg

    # -- forces --

    def referent(self, t: float) -> tuple[float, float]:
        """Return position and velocity of the referent: minimum jerk down, dwell, minimum jerk back."""
        g = self.gesture
        down = (t - g.onset_s) / g.press_s
        up = (t - g.onset_s - g.press_s - g.dwell_s) / g.release_s
        s, sign, span_s = (down, 1, g.press_s) if up <= 0 else (1 - up, -1, g.release_s)
        s = min(max(s, 0.0), 1.0)
        reach = g.end_m - g.start_m
        part, rate = s**3 * (10 + s * (6 * s - 15)), 30 * (s * (1 - s)) ** 2
        return g.start_m + reach * part, sign * reach * rate / span_s

    def pulp_N(self, y: FloatArray) -> float:
        """Return the pulp's force on the plate, as if it could pull."""
        return self.elastic_N(y) - float(y[DASH_1] + y[DASH_2])

    def elastic_N(self, y: FloatArray) -> float:
        """Return the force of the pulp before it relaxes."""
        pulp = self.finger.pulp
        return pulp.scale_N * math.expm1(pulp.exponent_1_m * float(y[FINGER] - y[CELL] - y[CAP]))

    def shares(self) -> tuple[float, float]:
        """Return the fast and the slow arm's part of the pulp."""
        pulp = self.finger.pulp
        fast = (1 - pulp.relaxed_ratio) * pulp.fast_share
        return fast, 1 - pulp.relaxed_ratio - fast

    def finger_N(self) -> float:
        """Return the force at the finger."""
        return max(0.0, self.pulp_N(self.y))

    def cell_N(self, y: FloatArray) -> float:
        """Return the force of the cell."""
        cell = self.rig.load_cell
        return float(cell.stiffness_N_m * y[CELL] + cell.damping_N_s_m * y[CELL_V])

    def friction_N(self, y: FloatArray) -> float:
        mover = self.rig.mover
        ratio = self.mode.slips or self.stretch_m(y) / mover.presliding_m
        return mover.coulomb_N * ratio

    def stretch_m(self, y: FloatArray) -> float:
        """Return the stretch of the bristle where it sticks."""
        return self.stuck[0] + float(y[CAP]) - self.stuck[1]

    def volts(self, y: FloatArray) -> tuple[float, float, float]:
        """Return the voltage that the current loop asks for, what resistance and motion use up, and L."""
        c, amps, v = self.rig.coil, float(y[AMPS]), float(y[CAP_V])
        henry = c.inductance_H + c.reluctance_H_m * (y[CAP] - c.centre_m)
        ohm = c.resistance_ohm * (1 + c.copper_1_K * y[WARM]) + c.bridge_ohm
        used = (ohm + c.reluctance_H_m * v) * amps - self.force_constant(y) * v
        return used + henry * (self.amps_set - amps) / c.current_loop_s, used, henry

    def force_constant(self, y: FloatArray) -> float:
        c = self.rig.coil
        return float(
            c.force_constant_N_A * (1 - c.droop_ratio * (2 * (y[CAP] - c.centre_m) / c.stroke_m) ** 2)
        )

    # -- motion --

    def rates(self) -> Rates:
        """Return the right-hand side of the present mode."""
        rig, mode, g, pulp = self.rig, self.mode, self.gesture, self.finger.pulp
        coil, mover, stops, cell = rig.coil, rig.mover, rig.stops, rig.load_cell
        (u0, u1), tick_s, start = self.effort, rig.controller.tick_s, self.tick * rig.controller.tick_s
        fast, slow = self.shares()
        place_1_s, cell_1_s = (2 * math.pi * b.bandwidth_Hz for b in (rig.position_sensor, cell))

        def right(t: float, y: FloatArray) -> FloatArray:
            goal, goal_1_s = self.referent(t)
            muscle = g.stiffness_N_m * (goal - y[FINGER]) + g.damping_N_s_m * (goal_1_s - y[FINGER_V])
            muscle *= 1 + u0 + (u1 - u0) * (t - start) / tick_s
            elastic, force = self.elastic_N(y), self.cell_N(y)
            push = self.pulp_N(y) if mode.touches else 0.0
            v, amps = y[CAP_V], y[AMPS]
            down = force - self.friction_N(y) - mover.viscous_N_s_m * v + mover.mass_kg * mover.gravity_m_s2
            down -= self.force_constant(y) * amps - coil.reluctance_H_m * amps**2 / 2
            if mode.at_bottom:
                deep = y[CAP] - self.stop_m
                down -= stops.bottom_stiffness_N_m * deep * (1 + 1.5 * stops.bottom_loss_s_m * v)
            if mode.at_top:
                down += stops.top_stiffness_N_m * -y[CAP] * (1 - 1.5 * stops.top_loss_s_m * v)
            cap = down / self.mover_kg
            if mode.saturated:
                _, used, henry = self.volts(y)
                amps_1_s = (mode.saturated * coil.supply_V - used) / henry
            else:
                amps_1_s = (self.amps_set - amps) / coil.current_loop_s
            warm = coil.heat_K_W * coil.resistance_ohm * (1 + coil.copper_1_K * y[WARM]) * amps**2
            return np.array(
                [
                    y[FINGER_V],
                    (muscle - push) / self.finger.impedance.mass_kg,
                    (fast * elastic - y[DASH_1]) / pulp.fast_s,
                    (slow * elastic - y[DASH_2]) / pulp.slow_s,
                    y[CELL_V],
                    (push - force) / cell.plate_kg - cap,
                    v,
                    cap,
                    amps_1_s if self.enabled else 0.0,
                    place_1_s * (y[CAP] - y[PLACE]),
                    cell_1_s * (force - y[FILTERED]),
                    (warm - y[WARM]) / coil.heat_s,
                ]
            )

        return right

    def guards(self) -> Sequence[Guard]:
        """Return what stays positive as long as the present mode holds, in the order of switch()."""
        mode, stops, volt = self.mode, self.rig.stops, self.rig.coil.supply_V
        return (
            lambda y: self.pulp_N(y) * (1 if mode.touches else -1),
            self._friction_guard,
            lambda y: self._holds(y[CAP] - self.stop_m, y[CAP_V], stops.bottom_loss_s_m, mode.at_bottom),
            lambda y: self._holds(-y[CAP], -y[CAP_V], stops.top_loss_s_m, mode.at_top),
            lambda y: (
                mode.saturated * self.volts(y)[0] - volt if mode.saturated else volt - abs(self.volts(y)[0])
            ),
        )

    def _friction_guard(self, y: FloatArray) -> float:
        if self.mode.slips:
            return float(self.mode.slips * y[CAP_V])
        return self.rig.mover.presliding_m - abs(self.stretch_m(y))

    @staticmethod
    def _holds(depth: float, rate: float, loss: float, touches: bool) -> float:
        """Return what is positive while a stop touches, or while it does not."""
        pressed = min(float(depth), float(depth * (1 + 1.5 * loss * rate)))
        return pressed if touches else -pressed

    def switch(self, guard: int, y: FloatArray) -> None:
        """Go to the mode behind a guard."""
        mode = self.mode
        if guard == 0:
            mode.touches = not mode.touches
        elif guard == 1 and mode.slips:
            self.stuck = mode.slips * self.rig.mover.presliding_m, float(y[CAP])
            mode.slips = 0
        elif guard == 1:
            mode.slips = 1 if self.stretch_m(y) > 0 else -1
        elif guard == 2:
            mode.at_bottom = not mode.at_bottom
        elif guard == 3:
            mode.at_top = not mode.at_top
        else:
            mode.saturated = 0 if mode.saturated else int(math.copysign(1, self.volts(y)[0]))

    # -- a tick --

    def step(self, duty_q15: int, enable: bool) -> np.void:
        """Let one tick pass under these outputs; return the readings at its end."""
        rig, k = self.rig, self.tick
        tick_s = rig.controller.tick_s
        start, end = k * tick_s, (k + 1) * tick_s
        self.effort = (float(self.noise.effort_ratio[k - 1]) if k else 0.0, float(self.noise.effort_ratio[k]))
        sensor = rig.position_sensor
        ago_s = sensor.burst_s / sensor.reads * np.arange(sensor.reads)
        reads: FloatArray = np.asarray(end - ago_s)
        places = np.zeros(reads.size)
        for a, b in self._spans(start, start + rig.controller.compute_s):
            self._solve(a, b, reads, places)
        self.set_drive(duty_q15, enable)
        for a, b in self._spans(start + rig.controller.compute_s, end):
            self._solve(a, b, reads, places)
        self.tick += 1
        return self._readings(places[::-1], self.noise.position_m[k], float(self.noise.keycap[k]))

    def first_readings(self) -> np.void:
        """Return what the board reads before the first tick: the cap at rest, without noise."""
        reads = np.zeros(self.rig.position_sensor.reads)
        return self._readings(reads, reads, 0.0)

    def set_drive(self, duty_q15: int, enable: bool) -> None:
        """Set the commanded current: the duty, rounded to the drive's bits, of what the coil alone draws."""
        c, ratio = self.rig.coil, duty_q15 / 32768
        if c.command_bits:
            ratio = math.floor(ratio * 2**c.command_bits + 0.5) / 2**c.command_bits
        if c.bipolar == "no":
            ratio = max(ratio, 0.0)
        self.amps_set, self.enabled = ratio * c.supply_V / c.resistance_ohm, bool(enable)
        if not enable:
            self.y[AMPS] = 0.0
        asked = self.volts(self.y)[0]
        self.mode.saturated = int(math.copysign(1, asked)) if enable and abs(asked) > c.supply_V else 0

    def _spans(self, start: float, end: float) -> list[tuple[float, float]]:
        """Divide a span at the corners of the gesture."""
        g = self.gesture
        corners = np.cumsum([g.onset_s, g.press_s, g.dwell_s, g.release_s])
        times = [start, *(float(t) for t in corners if start < t < end), end]
        return [(a, b) for a, b in pairwise(times) if b > a]

    def _solve(self, a: float, b: float, reads: FloatArray, places: FloatArray) -> None:
        inside = (reads > a + 1e-12) & (reads <= b + 1e-12)
        wanted = np.minimum(reads[inside], b)[::-1]
        self.y, seen = solve_span(self.rates, self.guards, self.switch, (a, b), self.y, wanted, self.method)
        places[inside] = seen[::-1, PLACE]

    def _readings(self, places: FloatArray, noise_m: FloatArray, noise_ratio: float) -> np.void:
        """Return what the converters, which round to the nearest step, read at the end of a tick."""
        sensor, cell = self.rig.position_sensor, self.rig.load_cell
        u = places / (sensor.range_m / 2)
        bend = sensor.linearity_ratio * sensor.range_m / 2 * 1.5 * math.sqrt(3) * (u - u**3)
        counts = _converted(0.5 + (places + bend + noise_m) / sensor.range_m, sensor.converter_bits)
        force = (1 + cell.gain_error_ratio) * float(self.y[FILTERED]) + cell.offset_N
        ratio = force / cell.full_scale_N + noise_ratio
        inputs: RecordArray = np.zeros(1, INPUTS)
        inputs["time_us"] = round(1e6 * self.tick * self.rig.controller.tick_s)
        inputs["sum"], inputs["lowest"], inputs["highest"] = counts.sum(), counts.min(), counts.max()
        inputs["elapsed_ticks"] = 1
        inputs["supply_mV"] = round(1000 * self.rig.coil.supply_V)
        inputs["force_counts"] = _converted(np.array([0.5 + 0.5 * ratio]), cell.converter_bits)[0]
        one: np.void = inputs[0]
        return one


def _converted(ratio: FloatArray, bits: int) -> FloatArray:
    """Return the counts of a converter, of the range it covers."""
    return np.asarray(np.clip(np.floor(ratio * 2**bits + 0.5), 0, 2**bits - 1))
