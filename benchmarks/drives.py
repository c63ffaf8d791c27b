"""How soon do drives answer, and how even is the loop? Emulated, over a pseudo-terminal; half a minute.

Run as ``python -m benchmarks.drives``. Each adapter talks with its simulated far end in a process of its
own: what is measured is this machine, its Python and the vendors' libraries, no bus and no motor. Beside it
is the time that the bytes of a cycle take on the real line, computed from their number and the bit rate;
both together are the least that a cycle takes.
"""

from __future__ import annotations

import os
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.testing.conformance import plain_surface
from fdvv.units import FloatArray
from fdvv_drives.device import DriveDevice
from fdvv_drives.open import open_moteus, open_odrive, open_simplefoc
from fdvv_drives.testing.process import FarProcess

OPEN: dict[str, Callable[[str], DriveDevice]] = {
    "moteus": open_moteus,
    "odrive": open_odrive,
    "simplefoc": open_simplefoc,
}
GENEROUS = ("--rate-Hz", "1000", "--answer-ms", "100", "--late-ms", "900", "--watchdog-ms", "300")
EXCHANGES, PRESSES = 3000, 3
NOMINAL_bit_s, DATA_bit_s = 1e6, 5e6
UART_bit_s = (115_200, 1_000_000)
STUFF_RATIO = 1.2
"""At most one stuff bit follows four bits of their own kind; random data need fewer."""


def can_s(data_bytes: int) -> float:
    """Return how long a classic CAN frame with 11-bit identifier occupies the bus."""
    return (STUFF_RATIO * (34 + 8 * data_bytes) + 13) / NOMINAL_bit_s


def can_fd_s(data_bytes: int) -> float:
    """Return the same of a CAN-FD frame with 29-bit identifier and bit-rate switch."""
    checked = 21 if data_bytes > 16 else 17
    slow, fast = STUFF_RATIO * 36 + 13, STUFF_RATIO * (5 + 8 * data_bytes) + 1.25 * checked + 5
    return slow / NOMINAL_bit_s + fast / DATA_bit_s


def answers_s(device: DriveDevice) -> FloatArray:
    """Return how long each of many commands waits for its position, at zero torque, one after the other."""
    drive = device.drive
    drive.enable()
    times_s = [time.perf_counter()]
    for _ in range(EXCHANGES):
        drive.exchange(0.0)
        times_s.append(time.perf_counter())
    drive.stop()
    return np.diff(times_s)


def line_s(kind: str, device: DriveDevice) -> dict[str, float]:
    """Return what the bytes of a cycle take on each line."""
    if kind == "moteus":  # 48 bytes, and 22 in a frame that holds 24
        return {"CAN-FD 1/5 Mbit/s": can_fd_s(48) + can_fd_s(24)}
    if kind == "odrive":
        return {"CAN 1 Mbit/s": can_s(4) + 2 * can_s(0) + 2 * can_s(8)}
    drive: Any = device.drive
    line = drive.line
    device.drive.enable()
    device.drive.exchange(-0.25)
    sent = line.sent_bytes + line.received_bytes
    device.drive.exchange(-0.25)
    device.drive.stop()
    cycle_bytes = line.sent_bytes + line.received_bytes - sent
    return {f"{rate / 1000:g} kbit/s": 10 * cycle_bytes / rate for rate in UART_bit_s}


def cycles_s(device: DriveDevice) -> FloatArray:
    """Return the time from cycle to cycle in presses of the simulated hand."""
    device.upload(plain_surface(), 4.0)
    found = []
    for _ in range(PRESSES):
        device.press(100.0)
        found.append(np.diff(device.log.sent_s))
    return np.concatenate(found)


def spread(times_s: FloatArray) -> str:
    low, middle, high, worst = 1e3 * np.percentile(times_s, [5, 50, 95, 100])
    return f"{middle:5.2f} ({low:.2f} to {high:.2f}, worst {worst:.1f})"


def main() -> None:
    if sys.platform == "win32":
        raise SystemExit("needs pseudo-terminals")
    print(f"emulated over a pseudo-terminal, without bus and motor; load average {os.getloadavg()[0]:.1f}")
    print("ms: median (5 % to 95 %, worst)")
    for kind, opened in OPEN.items():
        with (
            tempfile.TemporaryDirectory() as folder,
            FarProcess(kind, Path(folder), *GENEROUS) as far,
            opened(str(far.stage)) as device,
        ):
            device.armed = far.press
            answer = answers_s(device)
            print(f"  {kind:9} answer {spread(answer)}; cycle of 1 ms {spread(cycles_s(device))}")
            for line, took_s in line_s(kind, device).items():
                best_Hz = 1 / (np.median(answer) + took_s)
                print(f"            line {1e3 * took_s:.2f} computed, {line}: at best {best_Hz:.0f} Hz")


if __name__ == "__main__":
    main()
