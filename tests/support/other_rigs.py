"""Rigs of other physics than the twin's: a solver, finger and force laws of their own, in SI units.

Springs of flexures, cables, detents, LuGre friction with a Stribeck curve, a force constant that is no
parabola, and a cap that rocks under a finger beside its middle, whose side load rubs. x is positive into
the button, forces positive against the finger. Presses of many rigs are solved together, one row each.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, fields
from typing import Any

import numpy as np

from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

STEP_s = 2.5e-5
TRAVEL_m = 4e-3
STOP_N_m, STOP_N_s_m = 2e5, 40.0
REVERSAL_m = 1e-4
START_m, REST_s, DWELL_s = -5e-4, 0.03, 0.04
DEEP_N = 2.2
"""How hard the finger means to push at the stop."""
LIMIT_N = 4.4


@dataclass(frozen=True)
class OtherRig:
    """One rig and its finger, SI units.

    Attributes
    ----------
    tick_s, compute_s, coil_s : of the loop and of the coil's force.
    gain, gain_slope_1_m, gain_fall_1_m, gain_power, gain_middle_m : force per commanded force
        gain (1 + slope y - (fall |y|) ** power) at y = x - middle.
    brake_N_s_m : of a coil driven by a voltage, where the gain is 1.
    mass_kg, cone_kg : of the mover, and of the cone in front of the sensor.
    spring_N_m, spring_N_m3, spring_free_m : flexure.
    cable_N, cable_m : a cable's force cable_N (1 - exp(-x / cable_m)).
    detent_N, detent_m, detent_rad : amplitude, period and phase.
    friction_N, stick_ratio, stribeck_m_s, bristle_m : LuGre; static over sliding friction, speed, bend.
    binding_N, binding_m : friction more around one displacement, within 0.4 mm.
    side_friction : friction per side load. bushing_m : length that bears it.
    tilt_kg_m2, tilt_Hz, tilt_damping : of the cap's rocking. beside_m : finger from the middle;
        sensor_m : position sensor from the middle.
    position_s, position_noise_m, filter_s, play_N, force_noise_N : sensors; play is the whole loop.
    finger_kg, joint_N_m, joint_N_s_m, pulp_N, pulp_1_m, pulp_N_s_m : finger and its pad.
    """

    tick_s: float = 2.5e-4
    compute_s: float = 1e-4
    coil_s: float = 4e-4
    gain: float = 0.95
    gain_slope_1_m: float = 0.0
    gain_fall_1_m: float = 0.0
    gain_power: float = 2.0
    gain_middle_m: float = 2e-3
    brake_N_s_m: float = 0.0
    viscous_N_s_m: float = 0.5
    weight_N: float = 0.15
    mass_kg: float = 0.02
    cone_kg: float = 0.002
    spring_N_m: float = 0.0
    spring_N_m3: float = 0.0
    spring_free_m: float = 2e-3
    cable_N: float = 0.0
    cable_m: float = 2e-3
    detent_N: float = 0.0
    detent_m: float = 1.5e-3
    detent_rad: float = 0.0
    friction_N: float = 0.03
    stick_ratio: float = 1.0
    stribeck_m_s: float = 0.02
    bristle_m: float = 2e-6
    binding_N: float = 0.0
    binding_m: float = 2e-3
    side_friction: float = 0.0
    bushing_m: float = 0.015
    tilt_kg_m2: float = 5e-7
    tilt_Hz: float = 200.0
    tilt_damping: float = 0.08
    beside_m: float = 0.0
    sensor_m: float = 0.0
    position_s: float = 7e-4
    position_noise_m: float = 5e-6
    filter_s: float = 3.33e-4
    play_N: float = 0.03
    force_noise_N: float = 0.004
    finger_kg: float = 0.006
    joint_N_m: float = 600.0
    joint_N_s_m: float = 5.0
    pulp_N: float = 0.11
    pulp_1_m: float = 3000.0
    pulp_N_s_m: float = 1.5

    def gain_at(self, x_m: FloatArray) -> FloatArray:
        return gain_of(self, x_m)

    def own_cN(self, x_mm: FloatArray) -> FloatArray:
        """Return the rig's own force over displacement, with the weight, against the finger."""
        return np.asarray(100.0 * (own_N(self, 1e-3 * np.asarray(x_mm)) - self.weight_N))

    @property
    def delay_s(self) -> float:
        return self.compute_s + 0.5 * self.tick_s + self.coil_s


def gain_of(r: OtherRig, x: FloatArray) -> FloatArray:
    y = x - r.gain_middle_m
    return np.asarray(r.gain * (1 + r.gain_slope_1_m * y - (r.gain_fall_1_m * np.abs(y)) ** r.gain_power))


def own_N(r: OtherRig, x: FloatArray) -> FloatArray:
    y = x - r.spring_free_m
    cable = r.cable_N * (1 - np.exp(-np.maximum(x, 0.0) / r.cable_m))
    detent = r.detent_N * np.sin(2 * np.pi * x / r.detent_m + r.detent_rad)
    return np.asarray(r.spring_N_m * y + r.spring_N_m3 * y**3 + cable + detent)


KINDS = ("spring", "cable", "detent", "friction", "gain", "rocking")


def draw_other_rig(random: np.random.Generator, kinds: Sequence[str] = KINDS) -> OtherRig:
    """Draw a rig that has these kinds of other physics, the rest as plain as the model assumes."""
    u = random.uniform
    voltage = random.random() < 0.5
    drawn = {
        "coil_s": u(2e-4, 8e-4) if voltage else u(5e-5, 2e-4),
        "compute_s": u(0.5e-4, 1.5e-4),
        "gain": u(0.75, 1.15),
        "gain_fall_1_m": u(20.0, 100.0),
        "gain_middle_m": u(1e-3, 3.5e-3),
        "brake_N_s_m": u(1.0, 5.0) if voltage else 0.0,
        "viscous_N_s_m": u(0.1, 1.0),
        "weight_N": u(0.0, 0.3),
        "mass_kg": u(0.012, 0.035),
        "friction_N": u(0.01, 0.06),
        "position_s": u(4e-4, 1.4e-3),
        "position_noise_m": u(2e-6, 1e-5),
        "play_N": u(0.0, 0.05),
        "force_noise_N": u(0.002, 0.006),
        "finger_kg": u(0.0045, 0.0085),
        "joint_N_m": u(350.0, 1100.0),
        "joint_N_s_m": u(4.0, 7.0),
        "pulp_1_m": u(2000.0, 4000.0),
        "pulp_N_s_m": u(0.8, 2.5),
    }
    other = {
        "spring": {
            "spring_N_m": u(10.0, 80.0),
            "spring_N_m3": random.choice([0.0, 1.0]) * u(0.5e6, 5e6),
            "spring_free_m": u(-1e-3, 4e-3),
        },
        "cable": {"cable_N": u(-0.15, 0.15), "cable_m": u(0.7e-3, 4e-3)},
        "detent": {"detent_N": u(0.01, 0.06), "detent_m": u(0.8e-3, 3.0e-3), "detent_rad": u(0.0, 6.28)},
        "friction": {
            "stick_ratio": u(1.1, 1.9),
            "stribeck_m_s": u(0.005, 0.06),
            "bristle_m": 10 ** u(-5.7, -4.3),
        },
        "gain": {
            "gain_fall_1_m": u(150.0, 280.0),
            "gain_power": u(2.5, 5.0),
            "gain_slope_1_m": u(-15.0, 15.0),
        },
        "rocking": {
            "beside_m": random.choice([-1.0, 1.0]) * u(1e-3, 4e-3),
            "sensor_m": u(-1.5e-3, 1.5e-3),
            "tilt_Hz": u(100.0, 300.0),
            "tilt_kg_m2": u(3e-7, 1e-6),
            "tilt_damping": u(0.03, 0.15),
            "side_friction": u(0.05, 0.25),
            "bushing_m": u(0.01, 0.02),
        },
    }
    for kind in KINDS:
        drawn |= other[kind] if kind in kinds else {}
    return OtherRig(**{name: float(value) for name, value in drawn.items()})


def stacked(rigs: Sequence[OtherRig]) -> OtherRig:
    """Return rigs as one record of columns."""
    columns: dict[str, Any] = {f.name: np.array([getattr(r, f.name) for r in rigs]) for f in fields(OtherRig)}
    return OtherRig(**columns)


def minimum_jerk(part: FloatArray) -> FloatArray:
    s = np.clip(part, 0.0, 1.0)
    return np.asarray(s**3 * (10 - 15 * s + 6 * s**2))


def presses_of(
    rigs: Sequence[OtherRig], surfaces: Sequence[ForceSurface], velocity_mm_s: float, seed: int = 0
) -> list[Press]:
    """Press every rig once at a speed, each on its own table; all need one tick."""
    solver = _Solver(stacked(rigs), surfaces, velocity_mm_s, np.random.default_rng((seed, 77)))
    return solver.presses()


class _Solver:
    """Fixed steps, semi-implicit; columns are rigs."""

    def __init__(
        self,
        rig: OtherRig,
        surfaces: Sequence[ForceSurface],
        velocity_mm_s: float,
        random: np.random.Generator,
    ) -> None:
        self.r, self.speed, self.random = rig, velocity_mm_s, random
        self.count = len(surfaces)
        self.each = round(float(np.ravel(rig.tick_s)[0]) / STEP_s)
        self.grid_m = np.linspace(0.0, TRAVEL_m, 81)
        rows = [_rows(s, velocity_mm_s, 1e3 * self.grid_m) for s in surfaces]
        self.press_N = 0.01 * np.stack([a for a, _ in rows])
        self.release_N = 0.01 * np.stack([b for _, b in rows])
        self.reach_m = TRAVEL_m + DEEP_N / rig.joint_N_m - START_m
        self.lasts_s = self.reach_m / (1e-3 * velocity_mm_s) * random.uniform(0.9, 1.15, self.count)
        self.steps = round(float(2 * REST_s + DWELL_s + 2 * self.lasts_s.max()) / STEP_s)
        self.tremor = random.uniform(0.0, 6.28, self.count), random.uniform(8.0, 12.0, self.count)

    def wanted_m(self, t: float) -> FloatArray:
        """Return where the finger means to be."""
        down = minimum_jerk((t - REST_s) / self.lasts_s)
        up = minimum_jerk((t - REST_s - self.lasts_s - DWELL_s) / self.lasts_s)
        phase, rate = self.tremor
        return np.asarray(START_m + self.reach_m * (down - up) + 2e-5 * np.sin(phase + 2 * np.pi * rate * t))

    def table_N(self, x: FloatArray, releasing: np.ndarray) -> FloatArray:
        at = np.clip(x / (self.grid_m[1] - self.grid_m[0]), 0.0, self.grid_m.size - 1.000001)
        low = at.astype(int)
        part, n = at - low, np.arange(self.count)
        table = np.where(releasing[:, None], self.release_N, self.press_N)
        return np.asarray((1 - part) * table[n, low] + part * table[n, low + 1])

    def presses(self) -> list[Press]:
        r, n, h = self.r, self.count, STEP_s
        x, v, xf, vf = np.zeros(n), np.zeros(n), np.full(n, START_m), np.zeros(n)
        touch_N = np.zeros(n)
        tilt, turn, bristle = np.zeros(n), np.zeros(n), np.zeros(n)
        amps, read_x, read_f, held = np.zeros(n), np.zeros(n), np.zeros(n), np.zeros(n)
        command, before, deepest = np.zeros(n), np.zeros(n), np.zeros(n)
        releasing = np.zeros(n, bool)
        tilt_N_m = r.tilt_kg_m2 * (2 * np.pi * r.tilt_Hz) ** 2
        tilt_N_s = 2 * r.tilt_damping * np.sqrt(tilt_N_m * r.tilt_kg_m2)
        moving = r.mass_kg + r.cone_kg
        late = np.round(r.compute_s / h).astype(int)
        records = []
        amps[:] = self.table_N(x, releasing)
        command[:] = before[:] = amps
        for k in range(self.steps):
            t = k * h
            phase = k % self.each
            if phase == 0:
                sensed = read_x + r.position_noise_m * self.random.standard_normal(n)
                force = held + r.force_noise_N * self.random.standard_normal(n)
                deepest = np.where(releasing, np.minimum(deepest, sensed), np.maximum(deepest, sensed))
                turned = np.where(releasing, sensed - deepest, deepest - sensed) > REVERSAL_m
                releasing = releasing ^ turned
                deepest = np.where(turned, sensed, deepest)
                before, command = command, np.clip(self.table_N(sensed, releasing), -LIMIT_N, LIMIT_N)
                records.append((t, x.copy(), touch_N.copy(), sensed, force, command))
            drive = np.where(phase < late, before, command)
            gain = gain_of(r, x)
            amps = amps + h * (drive + r.brake_N_s_m * gain * v - amps) / r.coil_s
            # finger on the pad, beside the middle
            deep, closing = xf - x - r.beside_m * tilt, vf - v - r.beside_m * turn
            pad = r.pulp_N * np.expm1(np.minimum(r.pulp_1_m * deep, 6.0))
            stiff = r.pulp_N_s_m * np.minimum(1.0, np.maximum(pad, 0.0) / 0.1)
            touch_N = np.where(deep > 0, np.maximum(pad + stiff * closing, 0.0), 0.0)
            side_N = np.abs(tilt_N_m * tilt) / r.bushing_m
            # LuGre, the bristle exact over the step
            slip = np.abs(v)
            stick = 1 + (r.stick_ratio - 1) * np.exp(-((slip / r.stribeck_m_s) ** 2))
            bind_N = r.binding_N * np.exp(-(((x - r.binding_m) / 4e-4) ** 2))
            level = r.friction_N * stick + r.side_friction * side_N + bind_N
            stretch = r.bristle_m * level / r.friction_N
            bristle = bristle + (np.sign(v) * stretch - bristle) * -np.expm1(-slip * h / stretch)
            rub = r.friction_N * bristle / r.bristle_m
            stop = np.where(x > TRAVEL_m, STOP_N_m * (x - TRAVEL_m) + STOP_N_s_m * v, 0.0)
            stop = stop + np.where(x < 0, STOP_N_m * x + STOP_N_s_m * v, 0.0)
            own = own_N(r, x) - r.weight_N + r.viscous_N_s_m * v + rub + stop
            a = (touch_N - gain * amps - own) / moving
            turn = turn + h * (touch_N * r.beside_m - tilt_N_s * turn - tilt_N_m * tilt) / r.tilt_kg_m2
            tilt = tilt + h * turn
            want = self.wanted_m(t)
            pull = r.joint_N_m * (want - xf) + r.joint_N_s_m * (-vf)
            vf = vf + h * (pull - touch_N) / r.finger_kg
            xf = xf + h * vf
            v = v + h * a
            x = x + h * v
            read_x = read_x + h / r.position_s * (x + r.sensor_m * tilt - read_x)
            read_f = read_f + h / r.filter_s * (touch_N - read_f)
            held = np.clip(held, read_f - 0.5 * r.play_N, read_f + 0.5 * r.play_N)
        return self._records(records)

    def _records(self, records: list[tuple[Any, ...]]) -> list[Press]:
        t = np.array([row[0] for row in records])
        x, touch, sensed, force, command = (np.stack([row[i] for row in records]) for i in range(1, 6))
        return [
            Press(
                t,
                1e3 * x[:, i],
                100 * touch[:, i],
                self.speed,
                np.round(1e3 * sensed[:, i], 4),
                np.round(100 * force[:, i] / 0.25) * 0.25,
                np.round(100 * command[:, i] * 64) / 64,
            )
            for i in range(self.count)
        ]


def _rows(surface: ForceSurface, velocity_mm_s: float, x_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    at = int(np.argmin(np.abs(surface.velocity_mm_s - velocity_mm_s)))
    press, release = (
        np.interp(x_mm, surface.displacement_mm, rows[at]) for rows in (surface.press_cN, surface.release_cN)
    )
    return press, release
