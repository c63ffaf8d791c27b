"""How soon do drives answer, and how even is the loop? Emulated, over a pseudo-terminal; half a minute.

Run as ``python -m benchmarks.drives``. Each adapter talks with its simulated far end in a process of its
own: what is measured is this machine, its Python and the vendors' libraries, no bus and no motor. Beside it
is the time that the bytes of a cycle take on the real line, computed from their number and the bit rate;
both together are the least that a cycle takes. With ``learn``, whether a drive with a load cell learns.
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

from fdvv.compensation.rig_aware import RigAware
from fdvv.device.boards import LibraryBoard
from fdvv.device.contract import Device
from fdvv.device.linked import LinkedDevice
from fdvv.device.own_rig import OwnRigPerson, RigNumbers
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.testing.conformance import plain_surface
from fdvv.units import FloatArray
from fdvv_drives.device import DriveDevice
from fdvv_drives.open import open_moteus, open_odrive, open_simplefoc
from fdvv_drives.testing.direct import direct_device
from fdvv_drives.testing.plant import CapOnGuide
from fdvv_drives.testing.process import FarProcess

OPEN: dict[str, Callable[[str], DriveDevice]] = {
    "moteus": open_moteus,
    "odrive": open_odrive,
    "simplefoc": open_simplefoc,
}
GENEROUS = ("--rate-Hz", "1000", "--answer-ms", "100", "--late-ms", "900", "--watchdog-ms", "300")
EXCHANGES, PRESSES = 3000, 3
VELOCITIES_mm_s = (50.0, 100.0)
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
    if kind == "moteus":  # 48 bytes and 22, with a load cell 50 and 26, in the next longer frames
        plain_s, cell_s = can_fd_s(48) + can_fd_s(24), can_fd_s(64) + can_fd_s(32)
        return {"CAN-FD 1/5 Mbit/s": plain_s, "CAN-FD 1/5 Mbit/s, load cell": cell_s}
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


class Guide(CapOnGuide):
    """The far ends' cap, for the firmware's own board at the same rate."""

    numbers = RigNumbers("guide", full_duty_N=6.0, force_limit_N=3.0, tick_us=1000, force_sensor_N=5.0)

    def __init__(self) -> None:
        super().__init__(6.0)


def errors_cN(device: Device, surface: ForceSurface, button: FDVVModel) -> str:
    """Return mean errors on fresh presses in true displacement."""
    judged = probe(device, button, surface, VELOCITIES_mm_s, 6)
    found = [curve.to_dict() for curve in judged.curves]
    return ", ".join(f"{c['stroke']} {c['velocity_mm_s']:g}: {c['mean_error_cN']:.1f}" for c in found)


def learn() -> None:
    """Learn with a load cell on a drive in simulated time, and with the firmware's own board beside it."""
    button = load_builtin("mx-clear")
    plain = ForceSurface.of_model(button, list(VELOCITIES_mm_s), 0.02)
    devices: dict[str, Device] = {
        "drive": direct_device(has_cell=True)[0],
        "board": LinkedDevice(LibraryBoard(), OwnRigPerson(Guide)),
    }
    print("MX Clear on a guide of 30 g with a load cell, mean error in cN at mm/s, 1 kHz, simulated")
    for name, device in devices.items():
        print(f"  {name}: not learned {errors_cN(device, plain, button)}")
        learned = compensate(device, button, VELOCITIES_mm_s, RigAware())
        found = f"looks {device.settings().lead_us} us ahead"
        print(f"  {name}: learned     {errors_cN(device, learned.surface, button)}; {found}")


def main() -> None:
    if sys.argv[1:] == ["learn"]:
        learn()
        return
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
