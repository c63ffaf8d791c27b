"""The twin as a device: a simulated person presses a simulated rig."""

from __future__ import annotations

import numpy as np

from fdvv.device._contract import DeviceInfo
from fdvv.errors import DeviceError
from fdvv.model import ForceSurface, Press
from fdvv.twin import Finger, Rig, draw_noise, simulate, solve_pace, vary
from fdvv.units import cN_from_N, m_from_mm, mm_from_m

SPEED_LIMITS_mm_s = (5.0, 500.0)


class TwinDevice:
    """A rig and a person, both simulated; every press is drawn afresh, and seed repeats the session.

    Parameters
    ----------
    rig, finger : the default ones if None.
    seed : of everything random.

    The person holds the asked pace on whatever is uploaded, as someone does who follows a pace indicator,
    within the spread of the finger's habit. The controller is told the asked pace and uses it until it
    has measured its own.
    """

    def __init__(self, rig: Rig | None = None, finger: Finger | None = None, seed: int = 0) -> None:
        self._rig, self._finger = rig or Rig(), finger or Finger()
        self._random = np.random.default_rng(seed)
        self._active: tuple[ForceSurface, float] | None = None
        self._paces: dict[float, float] = {}
        self._fresh: set[float] = set()

    def info(self) -> DeviceInfo:
        """Tell who this is."""
        control, stops = self._rig.controller, self._rig.stops
        limits = cN_from_N(control.force_limit_N), mm_from_m(stops.travel_limit_m)
        return DeviceInfo("twin", True, *limits, control.tick_s)

    def upload(self, surface: ForceSurface, travel_mm: float) -> None:
        """Make surface the active command table and set the stop; DeviceError beyond the limits."""
        info = self.info()
        largest = max(float(np.abs(table).max()) for table in (surface.press_cN, surface.release_cN))
        if largest > info.force_limit_cN:
            raise DeviceError(
                f"twin: the table reaches {largest:.4g} cN, the limit is {info.force_limit_cN:g} cN; "
                "clip the table before uploading it"
            )
        if not 0 < travel_mm <= info.travel_limit_mm:
            raise DeviceError(
                f"twin: travel {travel_mm:g} mm is not within 0 to {info.travel_limit_mm:g} mm; "
                "choose a travel that the stop can set"
            )
        self._active = (surface, travel_mm)
        self._fresh.clear()

    def press(self, velocity_mm_s: float) -> Press:
        """Have the simulated person press once; DeviceError before an upload or at an absurd speed."""
        if self._active is None:
            raise DeviceError("twin: press before upload; upload a surface first")
        low, high = SPEED_LIMITS_mm_s
        if not low <= velocity_mm_s <= high:
            raise DeviceError(f"twin: speed {velocity_mm_s:g} mm/s is not within {low:g} to {high:g} mm/s")
        surface, travel_mm = self._active
        press_s = self._pace_s(velocity_mm_s, surface, travel_mm)
        travel_m, speed_m_s = m_from_mm(travel_mm), m_from_mm(velocity_mm_s)
        gesture = vary(self._finger, travel_m, press_s, speed_m_s, self._random)
        noise = draw_noise(self._rig, self._finger, gesture, self._random)
        trace = simulate(self._rig, self._finger, gesture, surface, travel_mm, noise, velocity_mm_s)
        return trace.press(velocity_mm_s)

    def _pace_s(self, velocity_mm_s: float, surface: ForceSurface, travel_mm: float) -> float:
        """Give the stroke's duration, found once per upload and speed, from the last one found."""
        if velocity_mm_s not in self._fresh:
            guess = self._paces.get(velocity_mm_s)
            self._paces[velocity_mm_s] = solve_pace(
                self._rig, self._finger, surface, travel_mm, velocity_mm_s, guess
            )
            self._fresh.add(velocity_mm_s)
        return self._paces[velocity_mm_s]
