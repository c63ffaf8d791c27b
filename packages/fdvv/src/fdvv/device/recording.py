"""Sessions on file: a line of JSON for everything sent to or received from a device.

The first line is ``{"fdvv": "session", "format": 1, "info": {…}, "settings": {…}}``; then, in order,
``{"settings": {…}}``, ``{"upload": {…}}``, ``{"program": "base64"}``, ``{"press": {…}}`` and
``{"error": {…}}``. An upload holds ``"paced": true`` where it was. Columns are 64-bit floats or flags,
packed as in `fdvv.io.columns`. Every line is on the disk before the next begins; a last line that was cut
short is left out when the file is read.
"""

from __future__ import annotations

import base64
import dataclasses
import json
import os
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any, Self, TypeVar

import numpy as np

from fdvv.device.contract import Device, DeviceInfo, FaultReport, ProgramDevice, check_speed, check_table
from fdvv.errors import DeviceError, InputError
from fdvv.io.columns import pack_column, unpack_column
from fdvv.io.files import open_plain
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Fault, Settings

FORMAT = 1  # the first; any other is refused
T = TypeVar("T")


def pack_record(record: Press | ForceSurface) -> dict[str, Any]:
    """Write a record of columns and numbers."""
    fields = {f.name: getattr(record, f.name) for f in dataclasses.fields(record)}
    return {k: _flat(v) if isinstance(v, np.ndarray) else v for k, v in fields.items()}


def _flat(column: np.ndarray[Any, Any]) -> str:
    """Write a column as flags or floats; a table row after row, as unpack_surface expects it."""
    return pack_column(column.ravel().astype("?" if column.dtype == np.bool_ else "<f8", copy=False))


def unpack_press(body: dict[str, Any]) -> Press:
    fields: dict[str, Any] = {k: unpack_column(v) if isinstance(v, str) else v for k, v in body.items()}
    return Press(**fields)


def unpack_surface(body: dict[str, Any]) -> ForceSurface:
    columns: dict[str, Any] = {k: unpack_column(v) for k, v in body.items()}
    shape = columns["velocity_mm_s"].size, columns["displacement_mm"].size
    tables = {k: columns[k].reshape(shape) for k in ("press_cN", "release_cN")}
    return ForceSurface(**{**columns, **tables})


class Recorder:
    """A device whose session is appended to a file while it lasts; it is used like the device itself."""

    def __init__(self, device: Device, path: Path) -> None:
        self._device, self._path = device, Path(path)
        self._path.parent.mkdir(parents=True, exist_ok=True)
        self._file = self._path.open("a", encoding="ascii")
        if self._path.stat().st_size and not self._path.read_bytes().endswith(b"\n"):
            self._file.write("\n")  # of a session that was cut short
        head = {"info": dataclasses.asdict(device.info()), "settings": dataclasses.asdict(device.settings())}
        self._write({"fdvv": "session", "format": FORMAT, **head})

    def _write(self, line: dict[str, Any]) -> None:
        self._file.write(json.dumps(line) + "\n")
        self._file.flush()
        os.fsync(self._file.fileno())

    def _log_call(self, call: Callable[[], T], line: dict[str, Any]) -> T:
        """Call, and write what was asked; a refusal or failure is part of the session."""
        try:
            result = call()
        except DeviceError as error:
            self._write({"error": {**line, "reason": str(error)}})
            raise
        if not isinstance(result, Press):
            self._write(line)
        return result

    def info(self) -> DeviceInfo:
        return self._device.info()

    def settings(self) -> Settings:
        return self._device.settings()

    @property
    def has_exciter(self) -> bool:
        return bool(getattr(self._device, "has_exciter", False))

    def configure(self, settings: Settings) -> None:
        self._log_call(lambda: self._device.configure(settings), {"settings": dataclasses.asdict(settings)})

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        upload = {"surface": pack_record(surface), "travel_mm": travel_mm}
        upload |= {"paced": True} if paced else {}
        self._log_call(lambda: self._device.upload(surface, travel_mm, paced), {"upload": upload})

    def upload_program(self, image: bytes) -> None:
        line = {"program": base64.b64encode(image).decode()}
        self._log_call(lambda: self._programs().upload_program(image), line)

    def press(self, velocity_mm_s: float) -> Press:
        press = self._log_call(lambda: self._device.press(velocity_mm_s), {"press": {"asked": velocity_mm_s}})
        self._write({"press": pack_record(press)})
        return press

    def stop(self) -> None:
        self._programs("stop").stop()

    def fault(self) -> FaultReport:
        return self._programs("fault").fault()

    def clear_fault(self) -> None:
        self._programs("clear_fault").clear_fault()

    def _programs(self, needed: str = "upload_program") -> ProgramDevice:
        """Return the device as one that runs programs; DeviceError if it lacks what is needed of one."""
        if not hasattr(self._device, needed):
            lacks = "no programs" if needed == "upload_program" else f"has no {needed.replace('_', ' ')}"
            raise DeviceError(f"{self.info().name}: runs tables of force only, {lacks}")
        return self._device  # type: ignore[return-value] # it has what is needed

    def close(self) -> None:
        if hasattr(self._device, "close"):
            self._device.close()
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def read_session(path: Path) -> list[dict[str, Any]]:
    """Read the lines of the last session of a file; a cut last line is left out. InputError."""
    try:
        with open_plain(path) as stream:
            text = stream.read().decode("ascii")
    except UnicodeDecodeError:
        raise InputError(path, "whole file", "is no text", "name a file that --record wrote") from None
    lines: list[dict[str, Any]] = []
    for number, line in enumerate(text.split("\n"), 1):
        record = _line(path, number, line) if line else None
        if record is None:
            continue
        if record.get("fdvv") == "session":
            lines = []
        lines.append(record)
    if not lines or lines[0].get("fdvv") != "session":
        raise InputError(path, "line 1", "begins no session", "name a file that --record wrote")
    if lines[0].get("format") != FORMAT:
        raise InputError(path, "line 1", f"format {lines[0].get('format')} is unknown", "update fdvv")
    return lines


def _line(path: Path, number: int, line: str) -> dict[str, Any] | None:
    """Read a line; None if it was cut short, as the last line of a killed session is."""
    record = None
    with suppress(json.JSONDecodeError):
        record = json.loads(line)
    if isinstance(record, dict) or (record is None and line.startswith("{")):
        return record
    raise InputError(path, f"line {number}", "is no record", "name a file that --record wrote")


class ReplayDevice:
    """Replays the last session that `Recorder` wrote, to the same requests in the same order. InputError."""

    def __init__(self, path: Path) -> None:
        head, *self._lines = read_session(path)
        self._path, self._place, self._active = Path(path), 0, False
        self._info = DeviceInfo(**head["info"])
        # a recording from before settings were written down: the default ones, at its tick
        self._settings = Settings(**head.get("settings", {"tick_us": round(1e6 * self._info.tick_s)}))

    def info(self) -> DeviceInfo:
        return self._info

    def settings(self) -> Settings:
        """Return what the recorded device held at this place of its session."""
        return self._settings

    @property
    def has_exciter(self) -> bool:
        """Whether programs were recorded, which alone play vibrations."""
        return any("program" in line for line in self._lines)

    def configure(self, settings: Settings) -> None:
        wanted = dataclasses.asdict(settings)
        self._find("settings", lambda recorded: recorded == wanted, "a device with such settings")
        self._settings, self._active = settings, False

    def upload(self, surface: ForceSurface, travel_mm: float, paced: bool = False) -> None:
        check_table(self._info, surface, travel_mm)
        self._find("upload", lambda recorded: _same(recorded, surface, travel_mm, paced), "this table")

    def upload_program(self, image: bytes) -> None:
        self._find("program", lambda recorded: base64.b64decode(recorded) == image, "this program")

    def _find(self, kind: str, same: Any, what: str) -> None:
        """Go to the next such line of the recording; DeviceError if none follows."""
        for place in range(self._place, len(self._lines)):
            if kind in self._lines[place] and same(self._lines[place][kind]):
                self._place, self._active = place + 1, True
                return
        raise DeviceError(f"{self._path}: {what} is not in the rest of the recording; press it on a device")

    def press(self, velocity_mm_s: float) -> Press:
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
        return FaultReport(Fault.NONE, 0, 0, 0.0, 0.0, 0.0, 0)

    def clear_fault(self) -> None:
        """Refuse: there is none."""
        raise DeviceError(f"{self._path}: a recording has no fault to clear")

    def close(self) -> None:
        """Do nothing."""


def _same(recorded: dict[str, Any], surface: ForceSurface, travel_mm: float, paced: bool) -> bool:
    if recorded["travel_mm"] != travel_mm or recorded.get("paced", False) != paced:
        return False
    then = vars(unpack_surface(recorded["surface"]))
    return all(np.array_equal(then[name], column) for name, column in vars(surface).items())
