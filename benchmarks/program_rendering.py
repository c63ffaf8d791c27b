"""How are programs felt on an identified rig, in every state, and as they are? Drawn rigs, people. Simulated.

Run as ``python -m benchmarks.program_rendering [rigs]``; 2 minutes. Every rig is identified on MX Clear, by
four presses where it has a cell, else by those and three per speed; then each shipped program is pressed
three times per speed as it is and as it is rendered, by a hand that keeps the pace of the start state. Errors
are at the finger, in true displacement, against what the active state intends. returning-later waits for
60 ms only, so that it returns within the press.
"""

from __future__ import annotations

import sys
from functools import partial

import numpy as np

from benchmarks.drawn_rigs import FIRST_SEED, JUDGE, Case, LOOP_4_kHz, Options, SPEEDS_mm_s, run_all
from benchmarks.force_loop import DESIGNS, RECOMMENDED, parts
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.program.library import make, programs
from fdvv.program.program import Program
from fdvv.rendering.compensate import compensate
from fdvv.rendering.evaluation.program_probe import StateError, all_errors_cN
from fdvv.rendering.program_render import ProgramReport, render_program

RIGS = 10
PRESSED_mm_s = (50.0, 100.0, 200.0)
JUDGED_mm_s = 100.0
TAUGHT = "mx-clear"
Reports = dict[str, ProgramReport]
DESIGN: dict[str, tuple[tuple[Options, ...], bool]] = {
    "recommended, its loop closed": (DESIGNS[RECOMMENDED], True),
    "the recommended electronics without the cell": (DESIGNS[RECOMMENDED], False),
    "the paper's parts at 4 kHz": ((LOOP_4_kHz,), False),
}


def shipped() -> dict[str, Program]:
    """Return every shipped program by its name."""
    waits = {"returning-later": {"cooldown_ms": 60}}
    return {p.name: make(p.name, **waits.get(p.name, {})) for p in programs()}


def rendered(case: Case, cell: bool) -> Reports:
    """Identify a rig, and render every program on it."""
    rig, finger = parts(case, cell)
    teacher = TwinDevice(rig, finger, case.seed)
    known = compensate(teacher, case.model, SPEEDS_mm_s, RigAware(rounds=0 if cell else 3)).learned_rig
    assert known is not None  # the method keeps one
    device = TwinDevice(rig, finger, case.seed + JUDGE)
    return {n: render_program(device, p, known, PRESSED_mm_s) for n, p in shipped().items()}


def _errors(reports: list[ProgramReport], speed_mm_s: float, rendering: bool) -> str:
    each = [all_errors_cN(report.at(speed_mm_s, rendering)) for report in reports]
    median, mean, largest = (float(np.median([f(e) for e in each])) for f in (np.median, np.mean, np.max))
    return f"{median:.1f} / {mean:.1f} / {largest:.0f}"


def _print_programs(found: list[Reports]) -> None:
    cells = " | ".join(f"{v:g} mm/s as it is | rendered" for v in PRESSED_mm_s)
    print(f"| program | {cells} |\n|{'---|' * (1 + 2 * len(PRESSED_mm_s))}")
    for name in found[0]:
        reports = [one[name] for one in found]
        row = [_errors(reports, v, rendering) for v in PRESSED_mm_s for rendering in (False, True)]
        print(f"| {name} | {' | '.join(row)} |", flush=True)


def _state_means_cN(found: list[Reports], rendering: bool) -> dict[str, list[StateError]]:
    """Return every state and stroke at the judged speed, of all rigs on which it was felt."""
    kept: dict[str, list[StateError]] = {}
    for name in found[0]:
        for row in (row for one in found for row in one[name].at(JUDGED_mm_s, rendering) if row.bins):
            kept.setdefault(f"{name}: {row.state}, {row.stroke}", []).append(row)
    return kept


def _print_states(found: list[Reports]) -> None:
    print(
        f"\n| state at {JUDGED_mm_s:g} mm/s | as it is, mean | rendered | largest impact |\n|---|---|---|---|"
    )
    before, after = (_state_means_cN(found, rendering) for rendering in (False, True))
    worse = 0
    for key, rows in after.items():
        was = float(np.median([row.mean_cN for row in before.get(key, [])] or [np.nan]))
        now = float(np.median([row.mean_cN for row in rows]))
        worse += now > was
        print(f"| {key} | {was:.1f} | {now:.1f} | {max(row.impact_cN for row in rows):.0f} |")
    print(f"{worse} of {len(after)} states are rendered worse than as they are (medians over rigs)")


def main() -> None:
    rigs = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    print(f"cN, median / mean / largest over bins, medians over {rigs} rigs; simulated")
    for title, (options, cell) in DESIGN.items():
        cases = [Case(FIRST_SEED + i, TAUGHT, options) for i in range(rigs)]
        results = [result for _, result in run_all(partial(rendered, cell=cell), cases)]
        found = [result for result in results if not isinstance(result, str)]
        print(f"\n{title}: {len(found)} of {rigs} finished")
        _print_programs(found)
        _print_states(found)
        for reason in sorted({result[:100] for result in results if isinstance(result, str)}):
            print(f"  not finished: {reason}")


if __name__ == "__main__":
    main()
