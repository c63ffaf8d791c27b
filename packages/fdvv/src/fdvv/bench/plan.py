"""The steps of a guided capture, and the cues that lead a person through one take."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.bench.settings import CaptureSettings
from fdvv.recording.types import Stage

BETWEEN_s = 1.2
"""Time for a person to read the result of a press and to be ready again."""
COUNT_IN_s = 1.5
"""Before every press and probe."""
DWELL_s = 0.05
"""At the bottom, between down and up."""
REST_s = 1.0
"""Length of a take of the untouched bench."""
PROBE_mm_s = 0.5
"""Of the slow probe: the speed of force testers."""
CONTACT, BOTTOM = "cue contact", "cue bottom"
"""The moments of the beeps."""


@dataclass(frozen=True)
class Step:
    stage: Stage
    velocity_mm_s: float | None = None


def capture_steps(settings: CaptureSettings) -> tuple[Step, ...]:
    """Return the steps: rest, probe, and the presses pace by pace.

    Shuffled they come in blocks that hold each pace once, in an order drawn from the seed.
    """
    first = [Step(Stage.REST), *([Step(Stage.PROBE, PROBE_mm_s)] if settings.probe else [])]
    paces, presses = settings.paces_mm_s, settings.presses
    if not settings.shuffled:
        return (*first, *(Step(Stage.PRESS, v) for v in paces for _ in range(presses)))
    random = np.random.default_rng(settings.seed)
    blocks = [random.permutation(len(paces)) for _ in range(presses)]
    return (*first, *(Step(Stage.PRESS, paces[i]) for block in blocks for i in block))


def capture_duration_s(settings: CaptureSettings, travel_mm: float, repeated: int = 0) -> float:
    """Estimate how long a capture takes, with ``repeated`` presses again at the slowest pace."""
    steps = [*capture_steps(settings), *[Step(Stage.PRESS, min(settings.paces_mm_s))] * repeated]
    return sum(cue_length_s(step.velocity_mm_s, travel_mm) + BETWEEN_s for step in steps)


@dataclass(frozen=True)
class Outcome:
    """The takes of one step: how many were made, and whether the last was good or the repeats are used up."""

    step: Step
    tries: int = 0
    settled: bool = False


def settle(outcomes: Sequence[Outcome], step: Step, ok: bool, repeats: int) -> tuple[Outcome, ...]:
    """Count a take for the first open step of its kind; a take beyond the plan changes nothing."""
    settled = list(outcomes)
    first = next((i for i, o in enumerate(settled) if o.step == step and not o.settled), None)
    if first is not None:
        tries = settled[first].tries + 1
        settled[first] = Outcome(step, tries, ok or tries > repeats)
    return tuple(settled)


def cue_length_s(velocity_mm_s: float | None, travel_mm: float) -> float:
    """Return the time from the start of a take's cue to its end."""
    if velocity_mm_s is None:
        return COUNT_IN_s + REST_s
    return COUNT_IN_s + 2 * (travel_mm / velocity_mm_s) + DWELL_s


def cue_events(velocity_mm_s: float | None, travel_mm: float) -> tuple[tuple[str, float], ...]:
    """Return the moments of the beeps, as fdvv.device.bench.Cue takes them."""
    if velocity_mm_s is None:
        return ()
    return (CONTACT, COUNT_IN_s), (BOTTOM, COUNT_IN_s + travel_mm / velocity_mm_s)
