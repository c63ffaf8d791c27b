"""A slow press for checking the fast one: SciPy's adaptive solvers between the ticks of the firmware's core.

The plant shares no code with the compiled one and reads rig and finger directly, so that a slip in either
shows; the controller is the same C, called tick by tick.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from fdvv.firmware.core import INPUTS, Core
from fdvv.model.surface import ForceSurface
from fdvv.protocol.messages import UM16_PER_mm
from fdvv.protocol.tables import TickFlag
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.image import image_of
from fdvv.twin.noise import Noise, count_ticks, settle_ticks
from fdvv.twin.rig import Rig
from fdvv.twin.settings import settings_of
from fdvv.units import FloatArray, cN_from_N, m_from_mm, mm_from_m
from tests.support.reference.plant import STATES, ReferencePlant

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
    release: FloatArray


def _round_to(value: float, step: float) -> float:
    return math.floor(value / step + 0.5) * step


@dataclass
class _Run:
    """A press under way: the plant's state, the core, and the rows so far."""

    plant: ReferencePlant
    core: Core
    noise: Noise
    method: Literal["DOP853", "Radau"]
    rtol: float
    y: FloatArray
    lvdt_m: FloatArray
    played_N: float = 0.0
    felt_N: float = 0.0
    rows: list[tuple[float, ...]] = field(default_factory=list)

    def tick(self, k: int, start: float, recorded: bool) -> None:
        """Sense, decide, and solve up to the next tick; the new drive comes after the compute delay."""
        rig, noise = self.plant.rig, self.noise
        control = rig.controller
        out = self.core.tick(self.readings(k))
        sensed = out["displacement_um16"] / (1000 * UM16_PER_mm)
        release = float(out["flags"] & TickFlag.RELEASE)
        seen = (sensed, self.felt_N, out["commanded_cN64"] / 6400, release)
        end, before = start + control.tick_s, float(noise.effort_ratio[k - 1]) if k else 0.0
        self.plant.modulation = (start, end, before, float(noise.effort_ratio[k]))
        if control.compute_s > 0:
            self.solve(start, start, start + control.compute_s, seen, recorded)
        self.plant.set_duty(int(out["duty_q15"]))
        self.solve(start, start + control.compute_s, end, seen, recorded)
        self.felt_N = self.force(float(self.y[10]), float(noise.force_N[k]))

    def readings(self, k: int) -> np.void:
        """Return the converters' readings at tick k."""
        sensor, control = self.plant.rig.position_sensor, self.plant.rig.controller
        u = self.lvdt_m / (sensor.range_m / 2)
        reads = self.lvdt_m + 1.5 * math.sqrt(3) * (u - u**3) * sensor.linearity_ratio * sensor.range_m / 2
        if k:
            reads = reads + self.noise.position_m[k - 1]
        top = 2**sensor.converter_bits
        counts = np.clip(np.floor((reads / sensor.range_m + 0.5) * top + 0.5), 0, top - 1)
        inputs = np.zeros(1, INPUTS)
        inputs["time_us"] = round(1e6 * k * control.tick_s)
        inputs["sum"], inputs["lowest"], inputs["highest"] = counts.sum(), counts.min(), counts.max()
        inputs["elapsed_ticks"] = 1
        inputs["supply_mV"] = math.floor(1000 * self.plant.supply_V(self.y) + 0.5)
        one: np.void = inputs[0]
        return one

    def force(self, felt_N: float, noise_N: float) -> float:
        """Apply play, gain, range and converter of the finger's force sensor."""
        s = self.plant.rig.force_sensor
        if abs(felt_N - self.played_N) > s.hysteresis_N / 2:
            self.played_N = felt_N - math.copysign(s.hysteresis_N / 2, felt_N - self.played_N)
        value = (1 + s.gain_error_ratio) * self.played_N + noise_N
        value = min(max(value, -s.full_scale_N), s.full_scale_N)
        return _round_to(value, s.full_scale_N / 2**s.converter_bits) if s.converter_bits else value

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
    plant = ReferencePlant(rig, finger, gesture, float(m_from_mm(travel_mm)))
    core = Core(settings_of(rig), image_of(surface, travel_mm).image)
    core.announce(round(16 * announced_mm_s))
    core.arm()
    run = _Run(plant, core, noise, method, rtol, y, np.zeros(rig.position_sensor.reads))
    settle = settle_ticks(rig)
    for k in range(settle + count_ticks(rig, gesture)):
        run.tick(k, (k - settle) * rig.controller.tick_s, k >= settle)
    t, cap, force, sensed, felt, command, release = np.array(run.rows).T
    return ReferenceTrace(
        t_s=t,
        displacement_mm=mm_from_m(cap),
        force_cN=cN_from_N(force),
        sensed_mm=mm_from_m(sensed),
        sensed_cN=cN_from_N(felt),
        commanded_cN=cN_from_N(command),
        release=release,
    )
