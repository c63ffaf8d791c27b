"""How well does a rig render buttons once it knows itself? Beside the paper's law. Simulated; half an hour.

Run as ``python -m benchmarks.rendering [rigs per button]``. The paper's parts with a loop of 4 kHz, drawn
anew for every row; learned from an unknown rig, judged on four fresh presses per speed, both strokes, in true
displacement, 0.3 mm to 0.1 mm before the stop, against the model at the speed asked for.
"""

from __future__ import annotations

import sys

import numpy as np

from benchmarks.drawn_rigs import (
    BUTTONS,
    CURRENT,
    FAST_COIL,
    FIRST_SEED,
    JUDGE,
    SENSOR,
    Case,
    LIGHT_6_g,
    LIGHT_12_g,
    LOOP_4_kHz,
    LOOP_10_kHz,
    Options,
    SPEEDS_mm_s,
    run_all,
    spread,
)
from fdvv.compensation.paper import tuned_paper_law
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.rendering.compensate import compensate, start_surface
from fdvv.rendering.probe import probe
from fdvv.units import FloatArray

RIGS = 50
PAPER: tuple[Options, ...] = (LOOP_4_kHz,)
BEST: tuple[Options, ...] = (LOOP_4_kHz, LOOP_10_kHz, FAST_COIL, SENSOR, LIGHT_6_g)
BEST_SPEEDS_mm_s = (50.0, 100.0, 200.0, 300.0)


def _judged(case: Case, method: str, speeds: tuple[float, ...]) -> tuple[FloatArray, int]:
    """Return mean, largest and mean at the achieved speed, (strokes and speeds, 3), and presses used."""
    (rig, finger), model = case.parts(), case.model
    device, fresh = TwinDevice(rig, finger, case.seed), TwinDevice(rig, finger, case.seed + JUDGE)
    if method == "none":
        probed = probe(fresh, model, start_surface(device, model, speeds), speeds, 4)
        presses = 0
    else:
        law = (
            RigAware() if method == "rig-aware" else tuned_paper_law(20, rig.controller.tick_s, hold_cN=80.0)
        )
        learned = compensate(device, model, speeds, law)
        probed = probe(fresh, model, learned.surface, speeds, 4, tuning=learned.outcome.tuning)
        presses = learned.outcome.presses
    rows = [(c["mean_error_cN"], c["max_error_cN"], c["mean_error_at_achieved_speed_cN"])
            for c in (curve.to_dict() for curve in probed.curves)]  # fmt: skip
    return np.array(rows), presses


def rig_aware(case: Case) -> tuple[FloatArray, int]:
    return _judged(case, "rig-aware", SPEEDS_mm_s)


def paper_law(case: Case) -> tuple[FloatArray, int]:
    return _judged(case, "paper", SPEEDS_mm_s)


def nothing(case: Case) -> tuple[FloatArray, int]:
    return _judged(case, "none", SPEEDS_mm_s)


def best_rig(case: Case) -> tuple[FloatArray, int]:
    return _judged(case, "rig-aware", BEST_SPEEDS_mm_s)


ROWS = (
    ("paper's parts, not compensated", nothing, PAPER, SPEEDS_mm_s),
    ("paper's parts, the paper's law tuned, 20 presses", paper_law, PAPER, SPEEDS_mm_s),
    ("paper's parts, rig-aware", rig_aware, PAPER, SPEEDS_mm_s),
    ("current drive, rig-aware", rig_aware, (*PAPER, CURRENT), SPEEDS_mm_s),
    ("12 g mover, rig-aware", rig_aware, (*PAPER, LIGHT_12_g), SPEEDS_mm_s),
    ("loop of 10 kHz, rig-aware", rig_aware, (*PAPER, LOOP_10_kHz), SPEEDS_mm_s),
    ("position sensor of 4 kHz and 1 um, rig-aware", rig_aware, (*PAPER, SENSOR), SPEEDS_mm_s),
    ("current drive and 12 g, rig-aware", rig_aware, (*PAPER, CURRENT, LIGHT_12_g), SPEEDS_mm_s),
    ("the best rig, rig-aware", best_rig, BEST, BEST_SPEEDS_mm_s),
)


def main() -> None:
    rigs = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    print(f"error, cN, median (5-95 %) over {len(BUTTONS)} buttons on {rigs} rigs and people each; simulated")
    began: dict[tuple[int, str], FloatArray] = {}
    for name, work, options, speeds in ROWS:
        cases = [Case(FIRST_SEED + i, button, options) for button in BUTTONS for i in range(rigs)]
        results = list(run_all(work, cases))
        found = [result for _, result in results]
        done = [result for result in found if not isinstance(result, str)]
        table = np.array([rows for rows, _ in done])
        presses = np.median([made for _, made in done])
        print(f"\n{name}: {len(done)} of {len(found)} finished, {presses:g} presses", flush=True)
        ended = {(c.seed, c.button): r[0][:, 0] for c, r in results if not isinstance(r, str)}
        if work is nothing:
            began = ended
        elif options == PAPER:
            both = [(ended[key], began[key]) for key in ended.keys() & began.keys()]
            worse = sum(int((after > before).sum()) for after, before in both)
            print(f"{worse} of {sum(after.size for after, _ in both)} curves worse than not compensated")
        print("| stroke | mm/s | mean | largest | mean, against the model at the achieved speed |")
        for at in range(table.shape[1]):
            stroke = "press" if at < len(speeds) else "release"
            cells = " | ".join(spread(table[:, at, column].tolist()) for column in range(3))
            print(f"| {stroke} | {speeds[at % len(speeds)]:g} | {cells} |", flush=True)
        for reason in sorted({result[:90] for result in found if isinstance(result, str)})[:6]:
            print(f"  not finished: {reason}")


if __name__ == "__main__":
    main()
