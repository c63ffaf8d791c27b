"""A device of one line of algebra, for tests of whatever drives a device."""

from __future__ import annotations

import numpy as np

from fdvv.device.contract import DeviceInfo
from fdvv.errors import DeviceError, ModelError
from fdvv.firmware.core import Core
from fdvv.force_text import force_text
from fdvv.model.curve import Stroke
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Settings
from fdvv.units import FloatArray

PERIOD_s = 1e-4
TICKS = 10
"""Rows of a record per control tick: a 10 kHz record of a 1 kHz loop."""


def _read(surface: ForceSurface, x_mm: FloatArray, velocity_mm_s: float, stroke: Stroke) -> FloatArray:
    table = surface.table_cN(stroke)
    row = np.array([np.interp(velocity_mm_s, surface.velocity_mm_s, column) for column in table.T])
    return np.asarray(np.interp(x_mm, surface.displacement_mm, row))


class ScriptedDevice:
    """A cap that moves at constant speed and feels gain * command + offset + drag * velocity + noise.

    Down at the asked speed, a dwell of 20 ms at the stop, up at the same speed. The table is read at the
    sensed displacement of the last tick and at the asked speed, paced or not. Settings are kept, but only
    the limits given here count.

    Parameters
    ----------
    gain : rendered force per commanded force.
    offset_cN, drag_cN_s_mm : constant force, and force per speed (positive against the motion).
    noise_cN, noise_mm : standard deviation of the rendered force, and of the sensed displacement.
    pace_spread_ratio : standard deviation of the speed of a press, as a part of the speed asked for.
    force_limit_cN, travel_limit_mm : limits of upload; commands beyond the force are cut and flagged.
    seed : of everything random.
    """

    def __init__(
        self,
        gain: float = 1.0,
        offset_cN: float = 0.0,
        drag_cN_s_mm: float = 0.0,
        noise_cN: float = 0.0,
        noise_mm: float = 0.0,
        pace_spread_ratio: float = 0.0,
        force_limit_cN: float = 440.0,
        travel_limit_mm: float = 6.2,
        seed: int = 0,
    ) -> None:
        self._gain, self._offset_cN, self._drag_cN_s_mm = gain, offset_cN, drag_cN_s_mm
        self._noise_cN, self._noise_mm, self._pace_spread_ratio = noise_cN, noise_mm, pace_spread_ratio
        self._info = DeviceInfo("scripted", True, force_limit_cN, travel_limit_mm, PERIOD_s * TICKS)
        self._settings = Settings(tick_us=round(1e6 * self._info.tick_s))
        self._random = np.random.default_rng(seed)
        self._active: tuple[ForceSurface, float] | None = None

    def info(self) -> DeviceInfo:
        return self._info

    def settings(self) -> Settings:
        return self._settings

    def configure(self, settings: Settings) -> None:
        """Keep settings; DeviceError if the tick is another, or a device would refuse them."""
        if settings.tick_us != self._settings.tick_us:
            raise DeviceError(f"scripted: ticks every {self._settings.tick_us} us, not {settings.tick_us} us")
        try:
            Core(settings)
        except ModelError as error:
            raise DeviceError(f"scripted: {error}") from error
        self._settings, self._active = settings, None

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        """Make surface the active command table; DeviceError beyond the limits."""
        limit = self._info.force_limit_cN
        largest = max(float(np.abs(t).max()) for t in (surface.press_cN, surface.release_cN))
        if largest > limit:
            raise DeviceError(f"scripted: table reaches {force_text(largest)}, limit {force_text(limit)}")
        if not 0 < travel_mm <= self._info.travel_limit_mm:
            raise DeviceError(f"scripted: travel {travel_mm:g} mm, limit {self._info.travel_limit_mm:g} mm")
        self._active = (surface, travel_mm)

    def press(self, velocity_mm_s: float) -> Press:
        if self._active is None:
            raise DeviceError("scripted: press before upload; upload a surface first")
        if not velocity_mm_s > 0:
            raise DeviceError(f"scripted: speed must be positive, got {velocity_mm_s:g} mm/s")
        surface, travel_mm = self._active
        speed = velocity_mm_s * max(0.2, 1 + self._pace_spread_ratio * self._random.standard_normal())
        t, x, v = _stroke_pair(travel_mm, speed)
        held = np.arange(t.size) // TICKS * TICKS
        sensed = (x + self._noise_mm * self._random.standard_normal(t.size))[held]
        down, up = (_read(surface, sensed, velocity_mm_s, stroke) for stroke in Stroke)
        wanted = np.where(v[held] >= 0, down, up)
        command = np.clip(wanted, -self._info.force_limit_cN, self._info.force_limit_cN)
        rendered = self._gain * command + self._offset_cN + self._drag_cN_s_mm * v
        rendered = rendered + self._noise_cN * self._random.standard_normal(t.size)
        sensed_cN, cut, tick = rendered[held], command != wanted, np.arange(t.size) % TICKS == 0
        return Press(t, x, rendered, velocity_mm_s, sensed, sensed_cN, command, cut, tick, simulated=True)


def _stroke_pair(travel_mm: float, speed_mm_s: float) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Make time, displacement and velocity of a ramp down, a dwell of 20 ms and a ramp up."""
    down = travel_mm / speed_mm_s
    t = np.arange(round((2 * down + 0.02) / PERIOD_s) + 1) * PERIOD_s
    corners = [0.0, down, down + 0.02, 2 * down + 0.02]
    x: FloatArray = np.interp(t, corners, [0.0, travel_mm, travel_mm, 0.0])
    v = np.where(t < down, speed_mm_s, np.where(t < down + 0.02, 0.0, -speed_mm_s))
    return np.asarray(t, dtype=np.float64), x, np.asarray(v)
