"""A far end as a process: ``python -m fdvv_drives.testing.serve moteus FOLDER``; simulated.

Writes FOLDER/stage.toml, prints its path, and takes lines of JSON: {"press": [travel_mm, mm_s]}, {"fault":
kind}, {"state": 1}; each is answered by one. With --press-every a hand presses by itself, for a first try.
"""

from __future__ import annotations

import argparse
import json
import os
import sys
import time
from pathlib import Path
from typing import Any

from fdvv_drives.testing.far_end import FarDrive, FarEnd
from fdvv_drives.testing.moteus_end import CELL_SPAN_N, CELL_ZERO, FarMoteus
from fdvv_drives.testing.odrive_end import FarODrive
from fdvv_drives.testing.simplefoc_end import FarSimpleFOC

LEAD_mm_rev, N_Nm, N_A = 10.0, 500.0, 4.0
TRAVEL_mm = 6.0
DRIVES: dict[str, tuple[type, str, float, float]] = {
    "moteus": (
        FarMoteus,
        'port = "{port}"\nwatchdog_ms = {watchdog_ms}\n'
        f'force_input = "aux1.2"\nforce_zero = {CELL_ZERO}\nforce_span_N = {CELL_SPAN_N}',
        LEAD_mm_rev,
        N_Nm,
    ),
    "odrive": (
        FarODrive,
        'channel = "{port}"\ninterface = "slcan"\nnode = 3\nwatchdog_ms = {watchdog_ms}',
        LEAD_mm_rev,
        N_Nm,
    ),
    "simplefoc": (
        FarSimpleFOC,
        'port = "{port}"\nwatchdog_ms = {watchdog_ms}',
        LEAD_mm_rev / 6.283185307179586,
        N_A,
    ),
}
STAGE = """[{kind}]
{part}

[stage]
name = "simulated guide"
simulated = true
lead_mm_rev = {lead}
{force}
travel_mm = {travel}
{zero} = 0.0

[limits]
force_N = 3.0
answer_ms = {answer_ms}
late_ms = {late_ms}

[loop]
rate_Hz = {rate_Hz}
patience_s = 10.0
"""


def stage_text(kind: str, port: str, asked: argparse.Namespace) -> str:
    """Return the stage file of a far end."""
    in_rad = kind == "simplefoc"
    return STAGE.format(
        kind=kind,
        part=DRIVES[kind][1].format(port=port, watchdog_ms=asked.watchdog_ms),
        lead=LEAD_mm_rev,
        force=f"force_N_A = {N_A}" if in_rad else f"force_N_Nm = {N_Nm}",
        zero="zero_rad" if in_rad else "zero_rev",
        travel=TRAVEL_mm,
        rate_Hz=asked.rate_Hz,
        answer_ms=asked.answer_ms,
        late_ms=asked.late_ms,
    )


def make(kind: str, watchdog_s: float) -> FarEnd:
    factory, _, mm_unit, N_unit = DRIVES[kind]
    drive: FarDrive = factory(watchdog_s)
    return FarEnd(drive, mm_unit, N_unit, TRAVEL_mm)


def carry_out(end: FarEnd, order: dict[str, Any]) -> dict[str, Any]:
    """Do what a line of JSON asks for, and return the answer to it."""
    if "press" in order:
        end.plant.press(*order["press"])
    if "fault" in order:
        end.fault(order["fault"])
    if "watchdog" in order:  # what the drive is really set to, s
        drive: Any = end.drive
        drive.watchdog_s = order["watchdog"]
    return {"force_N": end.force_N, "x_mm": end.plant.x_mm, "motor_N": end.plant.motor_N}


def is_up(end: FarEnd) -> bool:
    """Return whether the cap is up by a force, and can be pressed."""
    return end.force_N > 0.0 and end.plant.x_mm < 0.1


def run(end: FarEnd, every_s: float | None) -> None:
    """Serve until standard input ends."""
    orders, press_s = b"", time.monotonic()
    while True:
        if every_s is not None and time.monotonic() > press_s + every_s and is_up(end):
            press_s = time.monotonic()
            end.plant.press(TRAVEL_mm - 1.0, 100.0)
        if not end.step([0]):
            continue
        data = os.read(0, 4096)
        if not data:
            return
        *lines, orders = (orders + data).split(b"\n")
        for line in lines:
            os.write(1, json.dumps(carry_out(end, json.loads(line))).encode() + b"\n")


def main() -> None:
    parser = argparse.ArgumentParser(prog="python -m fdvv_drives.testing.serve")
    parser.add_argument("kind", choices=tuple(DRIVES))
    parser.add_argument("folder", type=Path)
    parser.add_argument("--rate-Hz", type=float, default=500.0)
    parser.add_argument("--answer-ms", type=float, default=5.0)
    parser.add_argument("--late-ms", type=float, default=20.0)
    parser.add_argument("--watchdog-ms", type=float, default=50.0)
    parser.add_argument("--press-every", type=float, default=None, metavar="SECONDS")
    asked = parser.parse_args()
    end = make(asked.kind, asked.watchdog_ms / 1000)
    path = asked.folder / "stage.toml"
    path.write_text(stage_text(asked.kind, end.port, asked), encoding="utf-8")
    sys.stdout.write(f"{path}\n")
    sys.stdout.flush()
    run(end, asked.press_every)


if __name__ == "__main__":
    main()
