"""Does a faster loop render better after learning? Simulated; some minutes.

Run as ``python -m benchmarks.loop_rate``. Learns MX Clear and judges it on fresh presses of another
seed, as the demo does; mean over strokes, velocities and seeds of the mean error in true displacement.
"""

from __future__ import annotations

import numpy as np

from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.twin.rig import Controller, Rig

VELOCITIES_mm_s = (50.0, 100.0, 150.0, 200.0)
SEEDS, PRESSES = range(1, 7), 30
RIGS = {"1 kHz": Rig(), "4 kHz": Rig(controller=Controller(tick_s=2.5e-4, compute_s=1e-4))}


def error_cN(rig: Rig, seed: int) -> float:
    """Learn and judge once."""
    button = load_builtin("mx-clear")
    learned = compensate(TwinDevice(rig, seed=seed), button, VELOCITIES_mm_s)
    judged = probe(TwinDevice(rig, seed=seed + 1000), button, learned.surface, VELOCITIES_mm_s, PRESSES)
    return float(np.mean([curve.to_dict()["mean_error_cN"] for curve in judged.curves]))


def main() -> None:
    print("mean error after learning MX Clear, cN, mean and spread over seeds, simulated")
    for name, rig in RIGS.items():
        errors = [error_cN(rig, seed) for seed in SEEDS]
        print(f"  {name}: {np.mean(errors):.2f} +- {np.std(errors, ddof=1):.2f}")


if __name__ == "__main__":
    main()
