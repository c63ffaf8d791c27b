"""What does a study render, and does the time of a change tell what it changed to? Simulated rigs.

Run as ``python -m benchmarks.study_stages [changes]`` (60 by default). Felt: rms of felt against intended
force over both strokes, median of 8 presses of a simulated finger at each pace, on the rig of perfect parts.
Changes: from asked to done, on the clock of the machine, of a person's stage, to FD and to FDVV in turn, and
of making a trial ready with FD behind A or behind B; how often one took longer than the other (0.5: nothing
is discriminated by it).
"""

from __future__ import annotations

import sys
import time
from pathlib import Path

import numpy as np

from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.stimulus.evidence import RenderingEvidence
from fdvv_people.study.stimulus.renderer import stimulus_model
from fdvv_people.study.stimulus.twin import TwinRenderer
from fdvv_studio.live.binary_finger import BinaryFinger
from fdvv_studio.live.press import LivePress
from fdvv_studio.live.press_subject import model_subject

BUTTONS, PACES_mm_s, PRESSES = ("mx-clear", "rubber-dome"), (15, 40, 120, 300, 450, 600), 8
SWITCH_s = 0.1


def stimuli(button: str) -> tuple[Stimulus, Stimulus]:
    """Return both renderings of a button."""
    return Stimulus(name="FD", button=button, rendered="FD"), Stimulus(name="FDVV", button=button)


def felt(stimulus: Stimulus, pace_mm_s: float) -> tuple[float, float]:
    """Return the median error (cN) and speed (mm/s) of presses at a pace."""
    model = stimulus_model(stimulus, Path())
    evidence, press = RenderingEvidence("A", stimulus.name, model), LivePress(model_subject(model), 1)
    hand = BinaryFinger(BinaryFinger.of(press.subject).bottom_mm, pace_mm_s)
    for _ in range(PRESSES):
        for lead in (hand.down, hand.up):
            lead(press)
            columns, _events = press.advance(0.2 + 30 / pace_mm_s)
            evidence.take(columns.t_s, columns.displacement_mm, columns.force_cN)
    found = evidence.rendered()
    errors = [error for error in found.error_cN if error is not None]
    return float(np.median(errors)), float(np.median([one for one in found.velocity_mm_s if one is not None]))


def longer(one_s: list[float], other_s: list[float]) -> float:
    """Return how often a time of the one is above one of the other."""
    a, b = np.array(one_s)[:, None], np.array(other_s)[None, :]
    return float(np.mean((a > b) + 0.5 * (a == b)))


def changes(count: int) -> tuple[list[float], list[float], list[float], list[float]]:
    """Time changes to FD and to FDVV, and making ready with FD behind A and behind B."""
    fd, fdvv = stimuli("mx-clear")
    stage = TwinRenderer(Path(), lambda _frame: None, switch_s=SWITCH_s)
    times: tuple[list[float], ...] = ([], [], [], [])
    to_fd, to_fdvv, ready_a, ready_b = times
    stage.prepare({"A": fd, "B": fdvv})
    for i in range(count):
        swapped = bool(i % 2)
        began = time.perf_counter()
        stage.prepare({"A": fdvv, "B": fd} if swapped else {"A": fd, "B": fdvv})
        (ready_b if swapped else ready_a).append(time.perf_counter() - began)
        for label in ("A", "B", "A"):
            began = time.perf_counter()
            stage.show(label)
            (to_fdvv if (label == "A") == swapped else to_fd).append(time.perf_counter() - began)
    stage.close()
    return to_fd, to_fdvv, ready_a, ready_b


def main() -> None:
    """Print both tables."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 60
    print("simulated, rig of perfect parts; cN at mm/s")
    for button in BUTTONS:
        for stimulus in stimuli(button):
            cells = [
                f"{error:.1f} at {speed:.0f}" for error, speed in (felt(stimulus, p) for p in PACES_mm_s)
            ]
            print(f"{button} {stimulus.name}: {', '.join(cells)}")
    to_fd, to_fdvv, ready_a, ready_b = changes(count)
    for label, one, other in (
        ("change to FDVV, to FD", to_fdvv, to_fd),
        ("ready with FD behind B, behind A", ready_b, ready_a),
    ):
        middle = " and ".join(f"{1e3 * np.median(times):.2f} ms" for times in (one, other))
        print(
            f"{label}: {middle}; the first is longer in {longer(one, other):.2f} of {len(one)} x {len(other)}"
        )


if __name__ == "__main__":
    main()
