"""A rig of one's own as a newcomer writes it: a mass on a spring, with a slide that rubs."""

from __future__ import annotations

import math

from fdvv.device.own_rig import RigNumbers


class PlainRig:
    """A cap of 25 g on a weak spring; its sensor falls as the cap goes down."""

    numbers = RigNumbers("plain", 8.0, 4.4, supply_V=24.0, sensor_mm=(9.0, -3.0), force_sensor_N=5.0)

    def __init__(self) -> None:
        self.x_mm = self.v_mm_s = 0.0

    def step(self, motor_N: float, finger_N: float, stop_mm: float, dt_s: float) -> float:
        beyond_mm = max(0.0, self.x_mm - stop_mm) + min(0.0, self.x_mm)
        stop_N = 80.0 * beyond_mm + (0.04 * self.v_mm_s if beyond_mm else 0.0)
        rubbing_N = 0.02 * math.tanh(self.v_mm_s / 2.0)
        up_N = motor_N + 0.04 * self.x_mm + stop_N + rubbing_N
        self.v_mm_s += 1000.0 * (finger_N - up_N) / 0.025 * dt_s
        self.x_mm += self.v_mm_s * dt_s
        return self.x_mm
