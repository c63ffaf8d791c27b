"""How long a job still takes: what its order lets expect, corrected by how long it has taken so far."""

from __future__ import annotations

from dataclasses import dataclass

from fdvv.device.open import is_manual
from fdvv_studio.studio.jobs.orders import CaptureOrder, CompensateOrder, Order, ProbeOrder, TuneOrder

START_s, DESIGN_s = 1.5, 3.0
"""A process starts, the parts it needs are imported; a rig is identified and its controller designed."""
IDENTIFY_presses = 6
STEP_s = {"twin": 0.05, "host": 0.5, "emulated": 20.0}
"""Of a press by a simulated person, by device."""
PERSON_s, ANSWER_s = 5.0, 8.0
"""Until a person has pressed, counted in; until one has answered."""
TRUST_s = 4.0
"""So much work counts for the expectation when it is corrected."""


@dataclass(frozen=True)
class Part:
    """A part of a job: its stage, and the time that it is expected to take."""

    stage: str
    time_s: float


def parts_of(order: Order) -> tuple[Part, ...]:
    """Return the parts of a job in their order, and how long each may take."""
    press_s = PERSON_s if is_manual(order.device) else STEP_s.get(order.device.partition(":")[0], 1.0)
    match order:
        case CompensateOrder(settings=settings):
            speeds = len(settings.velocities_mm_s)
            paper = settings.round_count * settings.press_count * speeds
            aware = settings.round_count * speeds + (0 if order.known_rig else IDENTIFY_presses)
            learned_s = paper * press_s if settings.method == "paper" else DESIGN_s + aware * press_s
            judged_s = order.probe_presses * speeds * press_s
            return (
                Part("baseline", START_s + judged_s),
                Part("compensate", learned_s),
                Part("probe", judged_s),
            )
        case ProbeOrder(settings=settings):
            judged_s = settings.presses * len(settings.velocities_mm_s) * press_s
            before = (Part("baseline", judged_s),) if order.actuation else ()
            return *before, Part("probe", START_s + judged_s)
        case CaptureOrder(settings=settings):
            take_s = PERSON_s if order.watch or is_manual(order.device) else STEP_s["twin"]
            takes = 1 + settings.probe + settings.presses * len(settings.paces_mm_s)
            return Part("capture", START_s + takes * take_s), Part("process", DESIGN_s)
        case TuneOrder(settings=settings):
            kinds = 1 + len(settings.frequency_ratios) * len(settings.gain_ratios)
            rated = settings.asking == "rate"
            asked = kinds * settings.repeats if rated else settings.comparisons or 3 * kinds
            answer_s = ANSWER_s if order.observer == "person" else 0.0
            asked_s = asked * len(settings.velocities_mm_s) * (answer_s + 2 * press_s)
            return (Part("tune", START_s + asked_s),)


def remaining_s(order: Order, stage: str, done_ratio: float, elapsed_s: float) -> float:
    """Return how long a job still takes.

    stage : that it is in; empty before the first. done_ratio : part of it that is done.
    elapsed_s : of this start.
    """
    parts = parts_of(order)
    at = next((i for i, part in enumerate(parts) if part.stage == stage), 0)
    spent_s = sum(part.time_s for part in parts[:at]) + done_ratio * parts[at].time_s
    slow_ratio = (elapsed_s + TRUST_s) / (spent_s + TRUST_s)
    return max(1.0, slow_ratio * (sum(part.time_s for part in parts) - spent_s))
