"""A slow press of a real button for checking the fast one: SciPy's adaptive solvers, in plain Python.

Shares no code with the compiled kernel and reads button and finger directly, so that a slip in either shows;
the identified curves, which are data to both, are the same.
"""

from __future__ import annotations

import math
from bisect import bisect_right
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fdvv.twin.button import ButtonPhysics
from fdvv.twin.button_kernel import BARE, ROW_s, TICK_s
from fdvv.twin.cam import identify
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import Gesture
from fdvv.twin.rig import ForceSensor
from fdvv.twin.simulate_button import SETTLE_TICKS, ButtonNoise, button_ticks
from fdvv.units import FloatArray, cN_from_N, mm_from_m
from tests.support.reference.plant import _hunt_crossley, referent

LONGEST_STEP_s = 2e-4


@dataclass(frozen=True, eq=False)
class ButtonReference:
    """What the reference gives, simulated; columns (n,) at the times of a ButtonTrace."""

    t_s: FloatArray
    displacement_mm: FloatArray
    force_cN: FloatArray
    filtered_cN: FloatArray
    leaf_mm: FloatArray


class _Smooth:
    """A monotone cubic through points, with its slope, evaluated one number at a time."""

    def __init__(self, x: FloatArray, values: FloatArray) -> None:
        from scipy.interpolate import PchipInterpolator

        self.x: list[float] = x.tolist()
        self.pieces: list[list[float]] = PchipInterpolator(x, values).c.T.tolist()

    def __call__(self, x: float) -> tuple[float, float]:
        i = min(max(bisect_right(self.x, x) - 1, 0), len(self.pieces) - 1)
        a, b, c, d = self.pieces[i]
        s = min(max(x, self.x[0]), self.x[-1]) - self.x[i]
        return ((a * s + b) * s + c) * s + d, (3 * a * s + 2 * b) * s + c


class _Straight:
    """Straight lines through points, evaluated one number at a time."""

    def __init__(self, x: FloatArray, values: FloatArray) -> None:
        self.x: list[float] = x.tolist()
        self.values: list[float] = values.tolist()

    def __call__(self, x: float) -> float:
        i = min(max(bisect_right(self.x, x) - 1, 0), len(self.x) - 2)
        part = min(max((x - self.x[i]) / (self.x[i + 1] - self.x[i]), 0.0), 1.0)
        return self.values[i] + part * (self.values[i + 1] - self.values[i])

    def slope(self, x: float) -> float:
        i = min(max(bisect_right(self.x, x) - 1, 0), len(self.x) - 2)
        return (self.values[i + 1] - self.values[i]) / (self.x[i + 1] - self.x[i])


class _Plant:
    """The equations of motion.

    State: finger x, v; fast and slow arm; cone x, v; slider x, v; leaf x, v; friction; plate q, q' twice;
    filtered force.
    """

    def __init__(
        self,
        button: ButtonPhysics,
        finger: Finger,
        gesture: Gesture,
        noise: ButtonNoise,
        sensor: ForceSensor | None,
        detour_m: FloatArray | None,
    ) -> None:
        self.button, self.finger, self.gesture = button, finger, gesture
        self.sensor = sensor or BARE
        ticks = np.arange(noise.effort_ratio.size) - SETTLE_TICKS
        self.effort = _Straight(np.asarray(TICK_s * ticks), noise.effort_ratio)
        detour = np.zeros(ticks.size) if detour_m is None else detour_m
        self.detour = _Straight(np.asarray(TICK_s * ticks), detour)
        cam = identify(button)
        self.elastic, self.height = _Smooth(cam.x_m, cam.elastic_N), _Smooth(cam.x_m, cam.height_m)
        self.rail, self.ratio = _Straight(cam.x_m, cam.rail_N), _Straight(cam.x_m, cam.friction_ratio)
        self.preload_N = cam.preload_N

    def muscle(self, t: float, x: float, v: float) -> float:
        """Return the pull of the referent, with the noise of its effort."""
        g = self.gesture
        to, rate = referent(g, t)
        to, rate = to + self.detour(t), rate + self.detour.slope(t)
        return (1 + self.effort(t)) * (g.stiffness_N_m * (to - x) + g.damping_N_s_m * (rate - v))

    def pulp(self, depth: float, rate: float, arms: float) -> tuple[float, float]:
        """Return the force beyond the strap's, and the rates of the arms' stretch."""
        p = self.finger.pulp
        still_N = p.relaxed_ratio * p.scale_N
        grown = p.scale_N * math.exp(p.exponent_1_m * depth) * (1 + p.strap_N / still_N)
        return p.relaxed_ratio * (grown - p.scale_N) + arms - p.strap_N, p.exponent_1_m * grown * rate

    def touch(self, y: FloatArray) -> float:
        """Return the force between cone and cap."""
        s = self.sensor
        return _hunt_crossley(
            s.contact_stiffness_N_m, s.contact_loss_s_m, float(y[4] - y[6]), float(y[5] - y[7])
        )

    def leaf(self, x: float, v: float, y: float, vy: float, q: float, p: float) -> tuple[float, ...]:
        """Return the cam's force on the leaf, its slope, the contact's force, the leaf's acceleration."""
        leaf = self.button.leaf
        height, slope = self.height(x)
        normal = _hunt_crossley(leaf.cam_stiffness_N_m, leaf.cam_loss_s_m, height - y, slope * v - vy)
        fixed = _hunt_crossley(leaf.fixed_stiffness_N_m, leaf.fixed_loss_s_m, q - y, p - vy)
        damping = 2 * leaf.damping_ratio * math.sqrt(leaf.stiffness_N_m * leaf.mass_kg)
        pull = self.preload_N + leaf.stiffness_N_m * y + damping * vy
        return normal, slope, fixed, (normal + fixed - pull) / leaf.mass_kg

    def law(self, elastic_N: float, v: float) -> float:
        """Return the velocity-dependent part of a dome's force."""
        dome = self.button.dome
        if self.button.curve.kind == "leaf" or elastic_N < 0:
            return 0.0
        if dome.law == "linear":
            return elastic_N * dome.linear_s_m * v
        return elastic_N * dome.log_ratio * math.copysign(math.log(1 + abs(v) / dome.log_speed_m_s), v)

    def stops(self, x: float, v: float) -> float:
        """Return the force of the stops, upward."""
        h = self.button.housing
        bottom = _hunt_crossley(h.bottom_stiffness_N_m, h.bottom_loss_s_m, x - self.button.curve.travel_m, v)
        return bottom - _hunt_crossley(h.top_stiffness_N_m, h.top_loss_s_m, -x, -v)

    def rates(self, t: float, y: FloatArray) -> FloatArray:
        """Return the time derivative of the state."""
        xf, vf, fast, slow, xt, vt, xs, vs, yl, vl, z, q1, p1, q2, p2, felt = y.tolist()
        b, finger = self.button, self.finger
        snap, dome = b.housing.snap_ratio, b.curve.kind == "dome"
        q, p = q1 + q2, p1 + p2
        x, v = xs - q, vs - p
        pulp, growth = self.pulp(xf - xt, vf - vt, fast + slow)
        touch, elastic = self.touch(y), self.elastic(x)[0]
        normal, slope, fixed, leaf = (
            (0.0, 0.0, 0.0, 0.0) if dome else self.leaf(x, v, yl, vl, snap * q, snap * p)
        )
        friction = (self.rail(x) + self.ratio(x) * normal) * z + b.slider.viscous_N_s_m * v
        up = elastic + normal * slope + friction + self.law(elastic, v) + self.stops(x, v)
        way, rest = (b.dome.arm_m, 1 / b.dome.arm_s) if dome else (b.slider.bristle_m, 0.0)
        blow, relaxing = up - snap * fixed, 1 - finger.pulp.relaxed_ratio
        h, share = b.housing, finger.pulp.fast_share
        modes = (
            (q1, p1, h.first_kg, h.first_Hz, h.first_damping_ratio),
            (q2, p2, h.second_kg, h.second_Hz, h.second_damping_ratio),
        )
        ring = [
            blow / kg - 4 * math.pi * Hz * zeta * pk - (2 * math.pi * Hz) ** 2 * qk
            for qk, pk, kg, Hz, zeta in modes
        ]
        return np.array(
            [
                vf, (self.muscle(t, xf, vf) - pulp) / finger.impedance.mass_kg,
                relaxing * share * growth - fast / finger.pulp.fast_s,
                relaxing * (1 - share) * growth - slow / finger.pulp.slow_s,
                vt, (pulp - touch) / self.sensor.mass_kg, vs, (touch - up) / b.slider.mass_kg, vl, leaf,
                (v - abs(v) * z) / way - rest * z, p1, ring[0], p2, ring[1],
                (pulp - felt) / self.sensor.filter_s,
            ]
        )  # fmt: skip

    def _unbalanced_N(self, x: float) -> float:
        """Return the unbalanced force on a finger that rests at x on a cap at 0, its pad relaxed."""
        return self.gesture.stiffness_N_m * (self.gesture.start_m - x) - self.pulp(x, 0.0, 0.0)[0]

    def start(self) -> FloatArray:
        """Return the state before settling: finger on or above the cap, leaf at rest on the cam."""
        from scipy.optimize import brentq

        y = np.zeros(16)
        y[0] = y[4] = min(self.gesture.start_m, 0.0)
        if self.gesture.start_m > 0:
            y[0] = brentq(self._unbalanced_N, 0.0, self.gesture.start_m, xtol=1e-15)
        if self.button.curve.kind == "leaf":
            leaf = self.button.leaf
            pressed = leaf.cam_stiffness_N_m * self.height(0.0)[0] - self.preload_N
            y[8] = pressed / (leaf.cam_stiffness_N_m + leaf.stiffness_N_m)
        return y


def reference_button(
    button: ButtonPhysics,
    finger: Finger,
    gesture: Gesture,
    noise: ButtonNoise,
    sensor: ForceSensor | None = None,
    method: Literal["DOP853", "Radau"] = "DOP853",
    rtol: float = 1e-8,
    detour_m: FloatArray | None = None,
) -> ButtonReference:
    """Simulate one press as simulate_button() does, with SciPy's solve_ivp.

    method : DOP853 or Radau, whose agreement tells how far either can be trusted. Takes seconds.
    """
    from scipy.integrate import solve_ivp

    plant = _Plant(button, finger, gesture, noise, sensor, detour_m)
    rows = round(button_ticks(gesture) * TICK_s / ROW_s)
    t = np.asarray(ROW_s * np.arange(rows))
    solution = solve_ivp(
        plant.rates,
        (-SETTLE_TICKS * TICK_s, float(t[-1])),
        plant.start(),
        method,
        t_eval=t,
        rtol=rtol,
        atol=1e-11,
        max_step=LONGEST_STEP_s,
    )
    y = solution.y
    force = np.array([plant.touch(column) for column in y.T])
    filtered = cN_from_N(np.asarray(y[15]))
    return ButtonReference(t, mm_from_m(y[6]), cN_from_N(force), filtered, mm_from_m(y[8]))
