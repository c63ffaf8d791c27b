"""The rig's controller in plain Python, one tick at a time: the oracle of the compiled one."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, field

import numpy as np

from fdvv.model import ForceSurface, Stroke
from fdvv.twin._rig import Rig
from fdvv.units import FloatArray, N_from_cN, mm_from_m


def round_to(value: float, span: float, bits: int) -> float:
    """Quantise to one step of a converter over a span; 0 bits leave the value."""
    return math.floor(value / span * 2**bits + 0.5) * span / 2**bits if bits else value


@dataclass
class Firmware:
    """What the controller knows, and what it does each tick."""

    rig: Rig
    surface: ForceSurface
    announced_mm_s: float
    average: deque[float] = field(default_factory=deque)
    samples: list[tuple[float, float]] = field(default_factory=list)
    speed_mm_s: float = 0.0
    stroke: Stroke = Stroke.PRESS
    extreme_m: float = 0.0
    decided: bool = False
    played_N: float = 0.0

    def __post_init__(self) -> None:
        self.speed_mm_s = self.announced_mm_s

    def tick(
        self, t: float, reads_m: FloatArray, felt_N: float, noise_N: float
    ) -> tuple[float, float, float]:
        """Give sensed displacement (m), sensed force (N) and commanded force (N)."""
        x = self.position(reads_m)
        self.direction(x)
        self.speed(t, x)
        table, places = self.surface.table_cN(self.stroke), self.surface.displacement_mm
        rows = [float(np.interp(mm_from_m(x), places, row)) for row in table]
        wanted = N_from_cN(float(np.interp(self.speed_mm_s, self.surface.velocity_mm_s, rows)))
        limit = self.rig.controller.force_limit_N
        return x, self.force(felt_N, noise_N), min(max(wanted, -limit), limit)

    def position(self, reads_m: FloatArray) -> float:
        """Average what the converter makes of the reads."""
        p, control = self.rig.position_sensor, self.rig.controller
        values = [round_to(float(read), p.range_m, p.converter_bits) for read in reads_m]
        self.average.append(sum(values) / len(values))
        keep = control.average_ticks if control.averaging == "sliding" else 1
        while len(self.average) > keep:
            self.average.popleft()
        return sum(self.average) / len(self.average)

    def force(self, felt_N: float, noise_N: float) -> float:
        """Apply play, gain, range and converter of the force sensor."""
        s = self.rig.force_sensor
        if abs(felt_N - self.played_N) > s.hysteresis_N / 2:
            self.played_N = felt_N - math.copysign(s.hysteresis_N / 2, felt_N - self.played_N)
        value = (1 + s.gain_error_ratio) * self.played_N + noise_N
        return round_to(min(max(value, -s.full_scale_N), s.full_scale_N), s.full_scale_N, s.converter_bits)

    def direction(self, x: float) -> None:
        """Turn round after reversal_m of way back, rearm at the top."""
        c = self.rig.controller
        if self.stroke is Stroke.PRESS:
            self.extreme_m = max(self.extreme_m, x)
            if x < self.extreme_m - c.reversal_m:
                self.stroke, self.extreme_m = Stroke.RELEASE, x
        else:
            self.extreme_m = min(self.extreme_m, x)
            if x > self.extreme_m + c.reversal_m or x < c.rearm_m:
                self.stroke, self.extreme_m = Stroke.PRESS, x
        if x < c.rearm_m:
            self.decided, self.speed_mm_s = False, self.announced_mm_s
            self.samples = self.samples[-c.fewest_samples :]

    def speed(self, t: float, x: float) -> None:
        """Decide the speed once per press, from the window or from the newest few samples."""
        c = self.rig.controller
        self.samples.append((t, x))
        if self.decided or self.stroke is Stroke.RELEASE or x <= c.window_end_m:
            return
        used = [pair for pair in self.samples if c.window_start_m <= pair[1] <= c.window_end_m]
        if len(used) < c.fewest_samples:
            used = self.samples[-c.fewest_samples :]
        if len(used) < c.fewest_samples:
            return
        times, places = np.transpose(used)
        slope = float(np.polyfit(times - times[0], places, 1)[0])
        self.speed_mm_s, self.decided = mm_from_m(c.velocity_scale * slope), True

    def drive(self, command_N: float) -> float:
        """Scale, limit and quantise a force into volts or amperes."""
        c = self.rig.coil
        full = c.supply_V if c.drive == "voltage" else c.supply_V / c.resistance_ohm
        raw = command_N / c.force_constant_N_A * (1 + self.rig.controller.gain_error_ratio)
        raw *= c.resistance_ohm if c.drive == "voltage" else 1.0
        low = -full if c.bipolar == "yes" else 0.0
        return round_to(min(max(raw, low), full), full, c.command_bits)
