"""Do the first presses on a known rig say whether it is the one in the file? Simulated; a quarter of an hour.

Run as ``python -m benchmarks.known_rig [rigs]`` (56 by default). Rigs like the recommended one, with and
without the load cell, are drawn with people and cells and identified from four presses on MX Clear. Then
another button is rendered at once, without a press, and pressed at 50 and 100 mm/s: on the same rig by the
same person, and on the next rig drawn, by its own.
"""

from __future__ import annotations

import sys

from benchmarks.drawn_rigs import BUTTONS, Case, SPEEDS_mm_s
from benchmarks.force_loop import DESIGNS, IDENTIFIED_ON, RECOMMENDED, parts
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.errors import FdvvError
from fdvv.model.file import load_builtin
from fdvv.rendering.compensate import compensate
from fdvv.rendering.known_rig import CHECKED_presses, RigCheck
from fdvv.rendering.tuning import tune

RIGS, JUDGE = 56, 9000
FIRST = {True: 500, False: 800}
"""Seeds with a cell and without; on 500 to 755 without one it was decided that both presses must agree."""


def case_of(seed: int) -> Case:
    return Case(seed, BUTTONS[seed % 100 % len(BUTTONS)], DESIGNS[RECOMMENDED])


def is_noticed(known: LearnedRig, case: Case, seed: int, cell: bool) -> bool:
    """Return whether the first presses on the rig of a seed differ from what is known."""
    device = TwinDevice(*parts(case_of(seed), cell), case.seed + JUDGE)
    made = compensate(device, case.model, SPEEDS_mm_s, RigAware(0, known))
    tune(device, made.outcome.tuning)
    device.upload(made.surface, made.travel_mm, made.outcome.tuning.paced)
    check = RigCheck(known.rig, made.travel_mm, cell)
    return any(check.difference(device.press(speed)) for speed in SPEEDS_mm_s[:CHECKED_presses])


def noticed(seed: int, cell: bool) -> tuple[bool, bool] | None:
    """Return whether the same rig and another one are noticed; None where a rig or person cannot press."""
    case = case_of(seed)
    try:
        device = TwinDevice(*parts(case, cell), seed)
        known = compensate(device, load_builtin(IDENTIFIED_ON), SPEEDS_mm_s, RigAware(0)).learned_rig
        assert known is not None
        return is_noticed(known, case, seed, cell), is_noticed(known, case, seed + 1, cell)
    except FdvvError:
        return None


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else RIGS
    print("| rigs | drawn | false alarms, same rig | noticed, another rig |")
    print("|---|---|---|---|")
    for name, cell in (("with a cell", True), ("without", False)):
        found = [one for seed in range(FIRST[cell], FIRST[cell] + count) if (one := noticed(seed, cell))]
        same, other = (sum(pair[i] for pair in found) for i in (0, 1))
        print(f"| {name} | {len(found)} | {same} | {other} |", flush=True)


if __name__ == "__main__":
    main()
