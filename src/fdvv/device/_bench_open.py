"""Capture benches by name."""

from __future__ import annotations

from fdvv.device._bench import CaptureDevice
from fdvv.device._bench_serial import SerialBench
from fdvv.device._bench_twin import Pacing, TwinBench
from fdvv.device._serial import SerialPort
from fdvv.errors import InputError
from fdvv.twin import load_button

BENCHES = {
    "twin": "a simulated bench with a simulated participant at a simulated button",
    "serial:PORT": "a bench on a serial port, with a person at it",
}
"""Benches that a word opens, and what each is."""


def open_bench(
    spec: str, button: str, participant: str = "typical", seed: int = 0, paced: bool = False
) -> CaptureDevice:
    """Open the capture bench that spec names (BENCHES).

    button : a shipped real button or a TOML file of one, participant, seed, paced : of the simulated bench.
    Raises InputError on an unknown name, DeviceError if the bench cannot be opened.
    """
    kind, _, where = spec.partition(":")
    if kind == "serial" and where:
        return SerialBench(SerialPort(where))
    if spec == "twin":
        return TwinBench(load_button(button), participant, seed, Pacing() if paced else None)
    raise InputError("--device", spec, "names no capture bench", f"use one of {', '.join(BENCHES)}")
