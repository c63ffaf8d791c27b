"""The LED strip's board by name."""

from __future__ import annotations

from fdvv.device._port import Port
from fdvv.device._serial import SerialPort
from fdvv.device._strip import StripTask
from fdvv.device._strip_library import LibraryStrip
from fdvv.errors import InputError

STRIPS = {
    "host": "the firmware's core in this process; nothing is seen, and no key is pressed",
    "serial:PORT": "a strip's board on a serial port, its key line on the rig's controller",
}
"""LED strips that a word opens, and what each is."""


def strip_port(spec: str) -> Port:
    """Open the line to the strip that spec names (STRIPS). Raises InputError, DeviceError."""
    kind, _, where = spec.partition(":")
    if kind == "serial" and where:
        return SerialPort(where)
    if spec == "host":
        return LibraryStrip()
    raise InputError("--strip", spec, "names no LED strip", f"use one of {', '.join(STRIPS)}")


def open_strip(spec: str) -> StripTask:
    """Open the strip that spec names (STRIPS). Raises InputError, DeviceError."""
    return StripTask(strip_port(spec))
