"""The travel limiter: a spiral on the servo's horn under the yoke's round foot; its angle sets the stop."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from fdvv.errors import InputError
from fdvv.units import FloatArray
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.layout import Layout

STEP_DEG = 2.0
RETURN_DEG = 60.0
PULSE_US_PER_DEG = 1900.0 / 180.0
"""Of a micro servo, 500 to 2400 µs over 180 degrees; assumed, measure yours."""

DEG_PER_RAD = 180.0 / np.pi
N_MM_PER_KGF_CM = 98.0665
HOLD_RATIO = 0.5
"""Share of the stall torque that a servo may be asked to hold."""


@dataclass(frozen=True)
class Limiter:
    """The limiter as numbers: what height of stop an angle gives, how finely, with what play and torque.

    The angle is 0 where the stop is deepest and rises as the stop rises.
    """

    d: Dimensions

    @cached_property
    def profile(self) -> FloatArray:
        """Get the arm's outline, (n, 2): y and z in mm about the servo's axis, at angle 0, counter-clockwise.

        The spiral's radius grows by the same amount per degree, so travel is linear in the angle; beyond it
        the outline returns to the smallest radius. At angle 0 the spiral's small end points up; the servo
        turns the large end there, so the spiral lies clockwise from the top.
        """
        return self.outline(np.arange(0.0, 360.0, STEP_DEG))[::-1]

    def outline(self, at_deg: FloatArray) -> FloatArray:
        """Return points of the arm's outline, (n, 2), at angles from its small end on, clockwise."""
        sweep_deg = self.d.servo_sweep_deg
        rise = np.interp(at_deg, [0.0, sweep_deg, sweep_deg + RETURN_DEG, 360.0], [0.0, 1.0, 0.0, 0.0])
        radius = self.d.limiter_small_mm + rise * (self.d.limiter_large_mm - self.d.limiter_small_mm)
        angle = np.radians(90.0 - at_deg)
        return np.stack([radius * np.cos(angle), radius * np.sin(angle)], axis=1)

    def foot_mm(self, angle_deg: float) -> float:
        """Return the height of the foot's lowest line above the servo's axis when it rests on the arm."""
        y, z = _turned(_dense(self.profile), angle_deg).T
        under = np.abs(y) < self.d.foot_radius_mm
        rests = z[under] + np.sqrt(self.d.foot_radius_mm**2 - y[under] ** 2)
        return float(rests.max()) - self.d.foot_radius_mm

    @cached_property
    def _table(self) -> tuple[FloatArray, FloatArray]:
        """Return angles and the travel that each allows."""
        layout = Layout(self.d)
        deg = np.linspace(0.0, self.d.servo_sweep_deg, 151)
        foot = np.array([self.foot_mm(angle) for angle in deg])
        return deg, layout.foot_low_mm - layout.servo_axis_mm - foot

    def travel_mm(self, angle_deg: float) -> float:
        """Return the travel at which an angle within the sweep stops the slider; below 0 it cannot sink."""
        deg, travel = self._table
        return float(np.interp(angle_deg, deg, travel))

    def angle_deg(self, travel_mm: float) -> float:
        """Return the angle that stops the slider at a travel. Raises InputError outside the range."""
        deg, travel = self._table
        if not self.range_mm[0] <= travel_mm <= self.range_mm[1]:
            low_mm, high_mm = self.range_mm
            reason = f"{travel_mm:g} mm is outside {low_mm:.2f} to {high_mm:.2f} mm"
            raise InputError("limiter", "travel", reason, "choose a travel inside")
        return float(np.interp(-travel_mm, -travel, deg))

    @cached_property
    def range_mm(self) -> tuple[float, float]:
        """Get the least and the largest travel that it can stop at."""
        travel = self._table[1]
        return float(travel.min()), float(travel.max())

    @property
    def mm_per_deg(self) -> float:
        """Get how far the stop moves per degree."""
        return (self.d.limiter_large_mm - self.d.limiter_small_mm) / self.d.servo_sweep_deg

    @property
    def play_mm(self) -> float:
        """Get how far the stop may move within the servo's play and dead band."""
        return self.mm_per_deg * self.d.servo_play_deg

    @property
    def torque_N_mm(self) -> float:
        """Get the torque of a hard press on the servo, without friction: force times rise per radian."""
        return self.d.finger_force_N * self.mm_per_deg * DEG_PER_RAD

    @property
    def torque_ratio(self) -> float:
        """Get that torque as a share of the servo's stall torque."""
        return self.torque_N_mm / (self.d.servo_torque_kgf_cm * N_MM_PER_KGF_CM)


def _dense(profile: FloatArray) -> FloatArray:
    after = np.roll(profile, -1, axis=0)
    share = np.linspace(0.0, 1.0, 5)[:-1, None, None]
    points: FloatArray = (profile + share * (after - profile)).reshape(-1, 2)
    return points


def _turned(points: FloatArray, angle_deg: float) -> FloatArray:
    c, s = np.cos(np.radians(angle_deg)), np.sin(np.radians(angle_deg))
    turned: FloatArray = points @ np.array([[c, s], [-s, c]])
    return turned
