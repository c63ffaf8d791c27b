"""Which presses does the quick look of a capture ask for again? Simulated."""

from __future__ import annotations

import numpy as np

from fdvv.bench.take_check import quick_look
from fdvv.recording.types import Stage
from fdvv.twin.capture.bench import CaptureBench
from fdvv.twin.capture.participant import WILD, Participant
from fdvv.twin.capture.rig import CaptureRig
from fdvv.twin.files import load_button
from fdvv.twin.finger import Finger
from fdvv.twin.rig import ForceSensor
from fdvv.units import mm_from_m

BUTTONS = ("mx-clear", "mx-red", "macbook-pro-2011")
PACES_mm_s = (50.0, 100.0, 150.0, 200.0)
PRESSES = 40
PEOPLE = {
    "good": Participant(0.0, 0.0),
    "incomplete": Participant(1.0, 0.0),
    **{kind: Participant(0.0, 1.0, (kind,)) for kind in WILD},
}


def asked_again(name: str, person: Participant, velocity_mm_s: float) -> int:
    """Count the presses of one kind, button and pace that are not taken for good."""
    button, random = load_button(name), np.random.default_rng(21)
    bench = CaptureBench(button, CaptureRig(), Finger(), ForceSensor(), person, random)
    travel_mm = float(mm_from_m(button.curve.travel_m))
    takes = (bench.take(n, Stage.PRESS, velocity_mm_s).take for n in range(1, PRESSES + 1))
    return sum(not quick_look(take, travel_mm).ok for take in takes)


def main() -> None:
    whole = PRESSES * len(PACES_mm_s) * len(BUTTONS)
    print(f"presses asked for again, of {PRESSES} at each of 50, 100, 150, 200 mm/s (simulated)")
    for kind, person in PEOPLE.items():
        rows = {name: [asked_again(name, person, v) for v in PACES_mm_s] for name in BUTTONS}
        summary = "  ".join(f"{name} {row}" for name, row in rows.items())
        print(f"{kind:15s} {sum(map(sum, rows.values())):4d} of {whole}:  {summary}")


if __name__ == "__main__":
    main()
