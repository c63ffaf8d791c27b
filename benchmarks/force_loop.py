"""What does the force loop at the finger bring? Rigs, people and cells drawn at random. Simulated; an hour.

Run as ``python -m benchmarks.force_loop [rigs per button]``. Every rig is identified from four presses, its
loop is closed with gains chosen for it, and each table is learned in three presses per speed; then four fresh
presses per speed are judged, both strokes, in true displacement at the finger, from 0.3 mm to 0.1 mm before
the stop, against the model at the speed asked for.
"""

from __future__ import annotations

import sys
from dataclasses import replace

import numpy as np

from benchmarks.drawn_rigs import (
    BUTTONS,
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
)
from fdvv.compensation.paper import tuned_paper_law
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.rendering.compensate import compensate
from fdvv.rendering.probe import probe
from fdvv.twin.draw import draw_section
from fdvv.twin.finger import Finger
from fdvv.twin.rig import LoadCell, Rig
from fdvv.units import FloatArray

RIGS = 50
CURRENT: Options = {"coil": {"drive": "current", "current_loop_s": 1e-4}}
TURN: Options = {"controller": {"reversal_m": 1e-4}}
BARE: Options = {"exciter": {"fitted": "no"}}
FAST = (LOOP_4_kHz, LOOP_10_kHz, FAST_COIL, TURN)
DESIGNS: dict[str, tuple[Options, ...]] = {
    "4 kHz, current drive, cell, 12 g": (LOOP_4_kHz, CURRENT, TURN, LIGHT_12_g, BARE),
    "10 kHz, current drive, cell": FAST,
    "10 kHz, current drive, cell, 12 g": (*FAST, LIGHT_12_g, BARE),
    "10 kHz, current drive, cell, 6 g, encoder": (*FAST, LIGHT_6_g, SENSOR),
}
SHARES = ("force", "force_at_achieved_speed", "force_to_entry", "force_beyond_entry")
"""Of what a probe finds noticeable; fdvv.model.noticeable has the JND and its sources."""
RECOMMENDED = "10 kHz, current drive, cell, 12 g"


def parts(case: Case, cell: bool) -> tuple[Rig, Finger]:
    """Draw rig and person, and a cell of this rig's own."""
    rig, finger = case.parts()
    if not cell:
        return rig, finger
    drawn = draw_section(LoadCell(fitted="yes"), np.random.default_rng(10_000 + case.seed))
    return replace(rig, load_cell=drawn), finger


def _judged(case: Case, law: str) -> FloatArray:
    """Judge a law on the rig, person and cell of a case, as `judged`."""
    return judged(case, *parts(case, law == "loop"), law)


def judged(case: Case, rig: Rig, finger: Finger, law: str) -> FloatArray:
    """Return mean, largest, mean at the achieved speed, and shares of the stroke above one JND.

    Of the speed asked for, of the speed achieved, up to 0.6 mm, and beyond: (strokes and speeds, 7).
    """
    model = case.model
    device, fresh = TwinDevice(rig, finger, case.seed), TwinDevice(rig, finger, case.seed + JUDGE)
    method = RigAware() if law != "paper" else tuned_paper_law(20, rig.controller.tick_s, hold_cN=80.0)
    learned = compensate(device, model, SPEEDS_mm_s, method)
    probed = probe(fresh, model, learned.surface, SPEEDS_mm_s, 4, tuning=learned.outcome.tuning)
    rows = []
    for curve in probed.curves:
        found = curve.to_dict()
        means = found["mean_error_cN"], found["max_error_cN"], found["mean_error_at_achieved_speed_cN"]
        rows.append((*means, *(found["noticeable"][key]["above_ratio"] for key in SHARES)))
    return np.array(rows)


def loop(case: Case) -> FloatArray:
    return _judged(case, "loop")


def rig_aware(case: Case) -> FloatArray:
    return _judged(case, "rig-aware")


def paper_law(case: Case) -> FloatArray:
    return _judged(case, "paper")


def main() -> None:
    rigs = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    works = [(name, loop, options) for name, options in DESIGNS.items()]
    works += [
        ("the recommended electronics without the cell, rig-aware", rig_aware, DESIGNS[RECOMMENDED]),
        (
            "the recommended electronics without the cell, the paper's law tuned",
            paper_law,
            DESIGNS[RECOMMENDED],
        ),
    ]
    print(f"cN over {len(BUTTONS)} buttons on {rigs} rigs and people each; simulated")
    for name, work, options in works:
        cases = [Case(FIRST_SEED + i, button, options) for button in BUTTONS for i in range(rigs)]
        found = [result for _, result in run_all(work, cases)]
        table = np.array([result for result in found if not isinstance(result, str)])
        print(f"\n{name}: {len(table)} of {len(found)} finished")
        print(
            "| stroke | mm/s | mean | its 90th percentile | largest | at achieved speed | above one JND |",
            end="",
        )
        print(" at achieved speed | to 0.6 mm | beyond |")
        for at in range(table.shape[1]):
            stroke = "press" if at < len(SPEEDS_mm_s) else "release"
            mean, largest, achieved, *shares = np.median(table[:, at], 0)
            high = np.quantile(table[:, at, 0], 0.9)
            cells = f"{mean:.2f} | {high:.2f} | {largest:.1f} | {achieved:.2f}"
            cells += "".join(f" | {100 * share:.0f} %" for share in shares)
            print(f"| {stroke} | {SPEEDS_mm_s[at % len(SPEEDS_mm_s)]:g} | {cells} |", flush=True)
        for reason in sorted({result[:90] for result in found if isinstance(result, str)})[:6]:
            print(f"  not finished: {reason}")


if __name__ == "__main__":
    main()
