"""What does compensation give, beside no learning, the law as printed and FD only? Simulated; some minutes.

Run as ``python -m benchmarks.compensation``. MX Clear on the rig `voltage`, learned with seeds 11 to 13,
judged with seeds 2001 to 2003 and 20 fresh presses per speed, in true displacement against the full model.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np

from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.per_curve import PerCurve
from fdvv.compensation.tables import GainSchedule
from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import compensate, start_surface
from fdvv.rendering.probe import fd_only, probe

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
SEEDS = ((11, 2001), (12, 2002), (13, 2003))
PRESSES = 20
PRINTED = PerCurve(PaperLaw.literal(gain=replace(GainSchedule(), most=0.2), rounds=4, presses_per_round=15))

Learn = Callable[[FDVVModel, int], ForceSurface]


def plain(model: FDVVModel, _seed: int) -> ForceSurface:
    return ForceSurface.of_model(model, SPEEDS_mm_s, 0.05)


def held(model: FDVVModel, seed: int) -> ForceSurface:
    return start_surface(TwinDevice(seed=seed), model, SPEEDS_mm_s)


def learned(law: PaperLaw | PerCurve) -> Learn:
    return lambda model, seed: compensate(TwinDevice(seed=seed), model, SPEEDS_mm_s, law).surface


def without_velocity(model: FDVVModel, seed: int) -> ForceSurface:
    return learned(PaperLaw())(fd_only(model), seed)


ROWS: dict[str, Learn] = {
    "the model uploaded as it is": plain,
    "the same with the cap held up": held,
    "the law as printed, tuned, 240 presses": learned(PRINTED),
    "with the additions, 192 presses": learned(PaperLaw()),
    "the same, 40 presses": learned(PaperLaw(rounds=1, presses_per_round=10)),
    "the same, 12 presses": learned(PaperLaw(rounds=1, presses_per_round=3)),
    "FD only, with the additions, 192 presses": without_velocity,
}


def main() -> None:
    button = load_builtin("mx-clear")
    print("mean / maximum of |error|, cN, press then release at", *SPEEDS_mm_s, "mm/s, then all; simulated")
    for name, learn in ROWS.items():
        found = []
        for seed, judge in SEEDS:
            surface = learn(button, seed)
            probed = probe(TwinDevice(seed=judge), button, surface, SPEEDS_mm_s, PRESSES).curves
            found.append([(c.to_dict()["mean_error_cN"], c.to_dict()["max_error_cN"]) for c in probed])
        table = np.mean(found, axis=0)
        cells = [f"{mean:.1f} / {most:.0f}" for mean, most in (*table, table.mean(axis=0))]
        print(f"| {name} | {' | '.join(cells)} |", flush=True)


if __name__ == "__main__":
    main()
