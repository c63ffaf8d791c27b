"""How far the people of a timing study are, and who is due: nothing that a code hides."""

from __future__ import annotations

from typing import Any, ClassVar, Literal

import msgspec

from fdvv_people.study.admin.progress import PersonProgress
from fdvv_people.study.plan.sitting import utc_text
from fdvv_people.study.timing.plan import DAY_s, TimingPlan
from fdvv_people.study.timing.state import TimingState

PersonPhase = Literal["enrolled", "training", "waiting", "due", "overdue", "validation", "done", "out"]
"""Where a person is: due and overdue have finished the gap and not come back; out: declined or withdrew."""
DUE: tuple[PersonPhase, ...] = ("due", "overdue")
DOCUMENT = (
    *(
        "person",
        "language",
        "simulated",
        "state",
        "phase",
        "done",
        "trials",
        "rounds",
        "due_at",
        "overdue_at",
    ),
    *("reminder", "resumptions", "interruptions", "problem"),
)
"""What programs get of a person."""


class TimedProgress(PersonProgress, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The progress of a person.

    Attributes
    ----------
    phase : where they are. done, trials : trials that are over, and all. rounds : presses, or seconds of
        tapping, that are kept.
    due_at, overdue_at : UTC, once the training is over; else empty. reminder : to be sent, where one is due.
    """

    left: ClassVar[int] = 4

    phase: PersonPhase = "enrolled"
    rounds: int = 0
    due_at: str = ""
    overdue_at: str = ""
    reminder: str = ""

    @property
    def place(self) -> str:
        if self.problem or self.state in ("withdrawn", "deleted"):
            return super().place
        return "declined" if self.phase == "out" else self.phase

    @property
    def call(self) -> str:
        if self.phase not in DUE:
            return ""
        late = f", overdue since {self.overdue_at[:10]}" if self.phase == "overdue" else ""
        return f"due: {self.person}{late}: {self.reminder}"

    def cells(self) -> dict[str, object]:
        who = {"person": self.person, "language": self.language, "phase": self.phase}
        trials = f"{self.done} of {self.trials}"
        return {**who, "trials": trials, "rounds": self.rounds, "not before": self.due_at[:10]}

    def document(self) -> dict[str, Any]:
        return {name: getattr(self, name) for name in DOCUMENT}


def timed_progress(about: PersonProgress, state: TimingState | None, now_s: float) -> TimedProgress:
    """Return how far a person is. about : what is known without their session's state."""
    known = msgspec.structs.asdict(about)
    out = about.state in ("withdrawn", "deleted")
    if state is None:
        return TimedProgress(**known, phase="out" if out else "enrolled")
    plan, due_s = state.plan, state.not_before_s
    phase = "out" if out else standing_of(state, now_s)
    overdue_s = None if state.trained_s is None else state.trained_s + DAY_s * plan.due_days
    return TimedProgress(
        **known | {"done": state.trials_over, "trials": len(state.started.trials)},
        phase=phase,
        rounds=state.count,
        due_at="" if due_s is None else utc_text(due_s),
        overdue_at="" if overdue_s is None else utc_text(overdue_s),
        reminder=reminder_of(plan, state) if phase in ("waiting", *DUE) else "",
    )


def standing_of(state: TimingState, now_s: float) -> PersonPhase:
    """Return where a person is at a wall time."""
    step, trial = state.step(now_s), state.next_trial
    if step.kind in ("declined", "withdrawn"):
        return "out"
    if step.kind == "wait":
        return "waiting"
    if trial is None:
        return "done" if step.kind == "done" else "validation"
    if trial.phase == "training":
        return "training"
    if state.trained_s is None or state.validated:
        return "validation"
    return "overdue" if now_s > state.trained_s + DAY_s * state.plan.due_days else "due"


def reminder_of(plan: TimingPlan, state: TimingState) -> str:
    """Return the words that call a person back, in their language."""
    words = plan.reminder.get(state.started.language) or next(iter(plan.reminder.values()), "")
    day = utc_text(state.not_before_s or 0.0)[:10]
    return words.format(date=day, person=state.started.person)
