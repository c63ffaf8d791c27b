"""How good is the paper's law, tuned, on rigs that nobody tuned it on? Simulated; a quarter of an hour.

Run as ``python -m benchmarks.baseline``. Rigs and fingers drawn with seeds 120 to 131 (the tuning used 100 to
119), each with one of the six built-in buttons, four speeds, 1 kHz and 4 kHz. Learned, then judged on fresh
presses in true displacement, 0.3 mm to 0.1 mm before the stop, both strokes.
"""

from __future__ import annotations

from dataclasses import replace
from typing import Literal

import numpy as np

from fdvv.compensation.paper import HOLDS_cN, PaperLaw, tuned_paper_law
from fdvv.device.twin import TwinDevice
from fdvv.errors import FdvvError
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.twin.draw import draw_finger, draw_rig
from fdvv.twin.finger import Finger
from fdvv.twin.rig import Rig

SPEEDS_mm_s = (50.0, 100.0, 150.0, 200.0)
SEEDS, PRESSES, JUDGE = range(120, 132), 5, 5000
BUDGETS: tuple[Literal[20, 240], ...] = (20, 240)
TICKS_s = (0.001, 0.00025)


def drawn(seed: int, tick_s: float) -> tuple[Rig, Finger]:
    """Draw a rig and a person; a faster loop also computes and reads its sensor faster."""
    random = np.random.default_rng(seed)
    rig, finger = draw_rig(random), draw_finger(random)
    if tick_s < rig.controller.tick_s:
        control = replace(rig.controller, tick_s=tick_s, compute_s=1e-4)
        rig = replace(rig, controller=control, position_sensor=replace(rig.position_sensor, burst_s=1e-4))
    return rig, finger


def laws(presses: Literal[20, 240], tick_s: float, additions: bool) -> list[PaperLaw]:
    """Return the laws that are all run; only the presses of the one that is kept count."""
    holds = HOLDS_cN if additions else HOLDS_cN[:1]
    return [tuned_paper_law(presses, tick_s, additions, hold) for hold in holds]


def error_cN(tried: list[PaperLaw], seed: int, tick_s: float) -> tuple[float, float]:
    """Return mean and largest error over strokes and speeds; infinite where no law can finish."""
    (rig, finger), names = drawn(seed, tick_s), builtin_names()
    model = load_builtin(names[seed % len(names)])
    try:
        surface = best(tried, model, rig, finger, seed)
        curves = probe(TwinDevice(rig, finger, seed + JUDGE), model, surface, SPEEDS_mm_s, PRESSES).curves
    except FdvvError:
        return float("inf"), float("inf")
    means, most = zip(*((c.mean_errors_cN, c.max_errors_cN) for c in curves), strict=True)
    return float(np.median(means, axis=1).mean()), float(np.median(most, axis=1).mean())


def best(tried: list[PaperLaw], model: FDVVModel, rig: Rig, finger: Finger, seed: int) -> ForceSurface:
    """Learn with every law and keep what ends with the least error as the rig measures it."""
    kept: list[tuple[float, ForceSurface]] = []
    for law in tried:
        try:
            learned = compensate(TwinDevice(rig, finger, seed), model, SPEEDS_mm_s, law)
        except FdvvError as error:
            failure = error
            continue
        kept.append((sum(c.mean_error_cN for c in learned.outcome.curves), learned.surface))
    if not kept:
        raise failure
    return min(kept, key=lambda one: one[0])[1]


def main() -> None:
    print(
        "error in true displacement, cN, median over random rigs, largest, quartiles of the mean; simulated"
    )
    print("| loop | presses | law | mean | largest | quartiles | not finished |")
    for tick_s in TICKS_s:
        for presses in BUDGETS:
            for additions in (False, True):
                tried = laws(presses, tick_s, additions)
                found = np.array([error_cN(tried, seed, tick_s) for seed in SEEDS])
                done = np.isfinite(found[:, 0])
                mid, low, high = np.percentile(found[done, 0], [50, 25, 75])
                name = "with additions" if additions else "as printed"
                most = np.median(found[done, 1])
                cells = f"{mid:.1f} | {most:.0f} | {low:.1f}-{high:.1f} | {np.sum(~done)} of {done.size}"
                print(f"| {1e-3 / tick_s:g} kHz | {presses} | {name} | {cells} |", flush=True)


if __name__ == "__main__":
    main()
