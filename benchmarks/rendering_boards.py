"""Does a learned table feel the same through the emulated board as in the twin? Emulated; a minute.

Run as ``python -m benchmarks.rendering_boards [rigs]`` after ``make firmware``. Tables are learned on the
twin, current drive and 12 g, 4 kHz, with a force sensor in the cap, without which a board tells no force. The
same person presses the twin, the firmware as a program of this machine, and its image in the emulated
microcontroller, 12 fresh presses at 50 and 200 mm/s; mean error, cN, in true displacement.
"""

from __future__ import annotations

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from benchmarks.drawn_rigs import CURRENT, FIRST_SEED, JUDGE, Case, LIGHT_12_g, LOOP_4_kHz, SPEEDS_mm_s
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.contract import Device
from fdvv.device.twin import TwinDevice
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.probe import probe
from fdvv.rendering.tuning import open_device
from fdvv.twin.files import finger_to_toml, rig_to_toml

OPTIONS = (LOOP_4_kHz, CURRENT, LIGHT_12_g, {"keycap_sensor": {"kind": "force"}})
RIGS, PRESSES, JUDGED_mm_s = 3, 12, (50.0, 200.0)


def opened(name: str, case: Case, folder: Path) -> Device:
    """Open a device with the case's rig and person."""
    (rig, finger), files = case.parts(), (folder / "rig.toml", folder / "finger.toml")
    for path, text in zip(files, (rig_to_toml(rig), finger_to_toml(finger)), strict=True):
        path.write_text(text)
    return open_device(name, *files, case.seed + JUDGE)


def errors_cN(name: str, case: Case, learned: CompensationResult) -> list[float]:
    """Return the mean error of every stroke and speed."""
    with TemporaryDirectory() as folder:
        device = opened(name, case, Path(folder))
        probed = probe(
            device, case.model, learned.surface, JUDGED_mm_s, PRESSES, tuning=learned.outcome.tuning
        )
        if hasattr(device, "close"):
            device.close()
    return [float(np.median(curve.mean_errors_cN)) for curve in probed.curves]


def main() -> None:
    rigs = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    print("mean error, cN, press 50, press 200, release 50, release 200 mm/s; simulated, emulated")
    print("| seed | device | errors | against the twin, mean over curves |")
    for seed in range(FIRST_SEED, FIRST_SEED + rigs):
        case = Case(seed, "mx-clear", OPTIONS)
        learned = compensate(TwinDevice(*case.parts(), seed), case.model, SPEEDS_mm_s, RigAware())
        twin = 0.0
        for name in ("twin", "host", "emulated"):
            found = errors_cN(name, case, learned)
            twin = twin or float(np.mean(found))
            cells = ", ".join(f"{error:.2f}" for error in found)
            print(f"| {seed} | {name} | {cells} | {np.mean(found) / twin - 1:+.0%} |", flush=True)


if __name__ == "__main__":
    main()
