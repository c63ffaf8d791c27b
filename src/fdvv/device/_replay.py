"""A recorded session as a device."""

from __future__ import annotations

import base64
import dataclasses
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.device._contract import DeviceInfo, FaultReport
from fdvv.device._limits import check_speed, check_table
from fdvv.device._recording import read_session, unpack_press, unpack_surface
from fdvv.errors import DeviceError
from fdvv.model import ForceSurface, Press
from fdvv.protocol import Fault, Settings


class ReplayDevice:
    """Gives the presses of a recording to whoever asks what was asked then, in the same order.

    Parameters
    ----------
    path : a file that `Recorder` wrote; its last session is replayed. InputError.
    """

    def __init__(self, path: Path) -> None:
        head, *self._lines = read_session(path)
        self._path, self._place, self._active = Path(path), 0, False
        self._info = DeviceInfo(**head["info"])
        # a recording from before settings were written down: the default ones, at its tick
        self._settings = Settings(**head.get("settings", {"tick_us": round(1e6 * self._info.tick_s)}))

    def info(self) -> DeviceInfo:
        """Tell whose session this was."""
        return self._info

    def settings(self) -> Settings:
        """Give what the recorded device held at this place of its session."""
        return self._settings

    def configure(self, settings: Settings) -> None:
        """Find these settings in what follows; DeviceError if they were not written then."""
        self._find(
            "settings", lambda found: found == dataclasses.asdict(settings), "a device with such settings"
        )
        self._settings, self._active = settings, False

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        """Find this table in what follows; DeviceError if it was not uploaded then."""
        check_table(self._info, surface, travel_mm)
        self._find("upload", lambda found: _same(found, surface, travel_mm, paced), "this table")

    def upload_program(self, image: bytes) -> None:
        """Find this program in what follows; DeviceError if it was not uploaded then."""
        self._find("program", lambda found: base64.b64decode(found) == image, "this program")

    def _find(self, kind: str, same: Any, told: str) -> None:
        for place in range(self._place, len(self._lines)):
            if kind in self._lines[place] and same(self._lines[place][kind]):
                self._place, self._active = place + 1, True
                return
        raise DeviceError(f"{self._path}: {told} is not in the rest of the recording; press it on a device")

    def press(self, velocity_mm_s: float) -> Press:
        """Give the next press of this upload; DeviceError if another speed was asked for, or none is left."""
        if not self._active:
            raise DeviceError(f"{self._path}: press before upload; upload a surface first")
        check_speed(str(self._path), velocity_mm_s)
        if self._place >= len(self._lines):
            raise DeviceError(f"{self._path}: the recording ends here")
        line = self._lines[self._place]
        self._place += 1
        if "error" in line and "press" in line["error"]:
            raise DeviceError(str(line["error"]["reason"]))
        if "press" not in line:
            raise DeviceError(f"{self._path}: no further press was recorded with this upload")
        press = unpack_press(line["press"])
        if press.velocity_mm_s != velocity_mm_s:
            raise DeviceError(
                f"{self._path}: the next press was asked at {press.velocity_mm_s:g} mm/s, "
                f"not at {velocity_mm_s:g}"
            )
        return press

    def stop(self) -> None:
        """Do nothing: a recording exerts no force."""

    def fault(self) -> FaultReport:
        """Tell that there is none."""
        return FaultReport(Fault.NONE, 0, 0, 0.0, 0.0, 0.0, 0)

    def clear_fault(self) -> None:
        """Refuse: there is none."""
        raise DeviceError(f"{self._path}: a recording has no fault to clear")

    def close(self) -> None:
        """Do nothing."""


def _same(found: dict[str, Any], surface: ForceSurface, travel_mm: float, paced: bool) -> bool:
    then = unpack_surface(found["surface"])
    names = ("displacement_mm", "velocity_mm_s", "press_cN", "release_cN")
    pairs = [(getattr(then, name), getattr(surface, name)) for name in names]
    same = found["travel_mm"] == travel_mm and found.get("paced", False) == paced
    return bool(same and all(np.array_equal(a, b) for a, b in pairs))
