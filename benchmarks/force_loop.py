"""What does the force loop at the finger bring? Rigs, people and cells drawn at random. Simulated.

Run as ``python -m benchmarks.force_loop [rigs per button] [words of a row's name]``: five minutes a row with
50 rigs, on two cores. Every rig is identified from four presses, its loop is closed with gains chosen for it,
and each table is learned in at most three presses per speed. Then four fresh presses per speed are judged,
both strokes, in true displacement at the finger, from 0.3 mm to 0.1 mm before the stop, against the model at
the speed asked for. The same is done for the model's own force, without compensation. A known rig was
identified on another button, and nothing is pressed.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
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
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.rendering.compensate import CompensationResult, compensate, start_surface
from fdvv.rendering.probe import probe
from fdvv.twin.draw import draw_section
from fdvv.twin.finger import Finger, stage_finger
from fdvv.twin.rig import LoadCell, Rig
from fdvv.units import FloatArray

RIGS = 50
Work = Callable[[Case], FloatArray]
CURRENT: Options = {"coil": {"drive": "current", "current_loop_s": 1e-4}}
TURN: Options = {"controller": {"reversal_m": 1e-4}}
BARE: Options = {"exciter": {"fitted": "no"}}
FAST = (LOOP_4_kHz, LOOP_10_kHz, FAST_COIL, TURN)
DESIGNS: dict[str, tuple[Options, ...]] = {
    "4 kHz, current drive, cell, 12 g": (LOOP_4_kHz, CURRENT, TURN, LIGHT_12_g, BARE),
    "10 kHz, current drive, cell": FAST,
    "10 kHz, current drive, cell, 12 g": (*FAST, LIGHT_12_g, BARE),
    "10 kHz, current drive, cell, 6 g, encoder": (*FAST, LIGHT_6_g, SENSOR),
    "the paper's parts, cell": (LOOP_4_kHz, TURN),
}
BEST: tuple[Options, ...] = (*FAST, LIGHT_12_g, BARE, SENSOR)
TO_300_mm_s = (*SPEEDS_mm_s, 300.0)
STATIC_mm_s = (0.5,)
IDENTIFIED_ON = "mx-clear"
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


def judged(
    case: Case, rig: Rig, finger: Finger, law: str, speeds_mm_s: tuple[float, ...] = SPEEDS_mm_s
) -> FloatArray:
    """Return what a law leaves on a rig, (strokes and speeds, 8).

    Mean, largest, mean at the achieved speed; shares of the stroke above one JND, of the speed asked for, of
    the speed achieved, up to 0.6 mm, and beyond; mean without compensation.
    """
    model = case.model
    device, fresh = TwinDevice(rig, finger, case.seed), TwinDevice(rig, finger, case.seed + JUDGE)
    plain = TwinDevice(rig, finger, case.seed + JUDGE)
    method = RigAware() if law != "paper" else tuned_paper_law(20, rig.controller.tick_s, hold_cN=80.0)
    if law == "known":
        before = compensate(device, load_builtin(IDENTIFIED_ON), speeds_mm_s, RigAware(rounds=0))
        method = RigAware(0, before.learned_rig)
    learned = compensate(device, model, speeds_mm_s, method)
    return _rows(fresh, plain, model, learned, speeds_mm_s, 4)


def _rows(
    fresh: TwinDevice,
    plain: TwinDevice,
    model: FDVVModel,
    learned: CompensationResult,
    speeds_mm_s: tuple[float, ...],
    presses: int,
) -> FloatArray:
    probed = probe(fresh, model, learned.surface, speeds_mm_s, presses, tuning=learned.outcome.tuning)
    without = probe(plain, model, start_surface(plain, model, speeds_mm_s), speeds_mm_s, presses)
    rows = []
    for curve, bare in zip(probed.curves, without.curves, strict=True):
        found = curve.to_dict()
        means = found["mean_error_cN"], found["max_error_cN"], found["mean_error_at_achieved_speed_cN"]
        shares = (found["noticeable"][key]["above_ratio"] for key in SHARES)
        rows.append((*means, *shares, float(np.median(bare.mean_errors_cN))))
    return np.array(rows)


def loop(case: Case) -> FloatArray:
    return judged(case, *parts(case, True), "loop")


def known(case: Case) -> FloatArray:
    return judged(case, *parts(case, True), "known")


def to_300_mm_s(case: Case) -> FloatArray:
    return judged(case, *parts(case, True), "loop", TO_300_mm_s)


def static(case: Case) -> FloatArray:
    """The slow curve, which no press taught, under a stage: of the rig that a person's presses identified."""
    (rig, finger), model = parts(case, True), case.model
    known = compensate(TwinDevice(rig, finger, case.seed), model, SPEEDS_mm_s, RigAware(rounds=0)).learned_rig
    stages = [TwinDevice(rig, stage_finger(), case.seed + JUDGE) for _ in range(3)]
    learned = compensate(stages[0], model, STATIC_mm_s, RigAware(0, known))
    return _rows(stages[1], stages[2], model, learned, STATIC_mm_s, 1)


def rig_aware(case: Case) -> FloatArray:
    return judged(case, *parts(case, False), "rig-aware")


def paper_law(case: Case) -> FloatArray:
    return judged(case, *parts(case, False), "paper")


ROWS: dict[str, tuple[Work, tuple[Options, ...]]] = {
    **{name: (loop, options) for name, options in DESIGNS.items()},
    "10 kHz, current drive, cell, 12 g, encoder, to 300 mm/s": (to_300_mm_s, BEST),
    "a known rig, no press: 10 kHz, current drive, cell, 12 g": (known, DESIGNS[RECOMMENDED]),
    "static, a stage: 10 kHz, current drive, cell, 12 g": (static, DESIGNS[RECOMMENDED]),
    "without the cell, rig-aware: 10 kHz, current drive, 12 g": (rig_aware, DESIGNS[RECOMMENDED]),
    "without the cell, the paper's law tuned: 10 kHz, current drive, 12 g": (paper_law, DESIGNS[RECOMMENDED]),
    "the paper's parts, rig-aware": (rig_aware, (LOOP_4_kHz, TURN)),
    "the paper's parts, the paper's law tuned": (paper_law, (LOOP_4_kHz, TURN)),
}
HEAD = "| stroke | mm/s | mean | its 90th percentile | largest | at achieved speed | above one JND |"


def main() -> None:
    rigs = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    words = " ".join(sys.argv[2:])
    print(f"cN over {len(BUTTONS)} buttons on {rigs} rigs and people each; simulated")
    for name, (work, options) in ROWS.items():
        if words in name:
            cases = [Case(FIRST_SEED + i, button, options) for button in BUTTONS for i in range(rigs)]
            found = list(run_all(work, cases))
            _print(name, [result for _, result in found], STATIC_mm_s if work is static else TO_300_mm_s)
            if work is static:
                _print_buttons(found)


def _print(name: str, found: list[FloatArray | str], speeds_mm_s: tuple[float, ...]) -> None:
    table = np.array([result for result in found if not isinstance(result, str)])
    worse = int((table[..., 0] > table[..., 7]).sum())
    print(
        f"\n{name}: {len(table)} of {len(found)} finished; {worse} of {table[..., 0].size} curves worse than",
        end="",
    )
    print(f" uncompensated\n{HEAD} at achieved speed | to 0.6 mm | beyond | uncompensated |")
    speeds = speeds_mm_s[: table.shape[1] // 2]
    for at in range(table.shape[1]):
        stroke = "press" if at < len(speeds) else "release"
        mean, largest, achieved, *shares, without = np.median(table[:, at], 0)
        high = np.quantile(table[:, at, 0], 0.9)
        cells = f"{mean:.2f} | {high:.2f} | {largest:.1f} | {achieved:.2f}"
        cells += "".join(f" | {100 * share:.0f} %" for share in shares)
        print(f"| {stroke} | {speeds[at % len(speeds)]:g} | {cells} | {without:.1f} |", flush=True)
    for reason in sorted({result[:90] for result in found if isinstance(result, str)})[:6]:
        print(f"  not finished: {reason}")


def _print_buttons(found: list[tuple[Case, FloatArray | str]]) -> None:
    for button in BUTTONS:
        rows = np.array([row for case, row in found if case.button == button and not isinstance(row, str)])
        means, most = np.median(rows[..., 0], 0), rows[..., 0].max(0)
        print(f"  {button}: press {means[0]:.2f}, at most {most[0]:.2f}; ", end="")
        print(f"release {means[1]:.2f}, at most {most[1]:.2f} cN")


if __name__ == "__main__":
    main()
