"""How far the people of a timing study are, and who is due: nothing that a code hides.

It is read from plain files only, without a key, so that a screen cannot reveal more.
"""

from __future__ import annotations

from typing import Literal

from msgspec import Struct, structs

from fdvv.errors import InputError
from fdvv_people.study.files.layout import PEOPLE, SESSION_FILE
from fdvv_people.study.files.people import Person, PersonState
from fdvv_people.study.plan.sitting import utc_text
from fdvv_people.study.session.log import read_session
from fdvv_people.timing.files.study import TimingStudy
from fdvv_people.timing.plan.plan import DAY_s, TimingPlan
from fdvv_people.timing.plan.session import TimingState

PersonPhase = Literal["enrolled", "training", "waiting", "due", "overdue", "validation", "done", "out"]
"""Where a person is: due and overdue have finished the gap and not come back; out: declined or withdrew."""
DUE: tuple[PersonPhase, ...] = ("due", "overdue")


class PersonProgress(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The progress of a person.

    Attributes
    ----------
    person, language, simulated, state : see Person. phase : where they are.
    done, trials : trials that are over, and all. rounds : presses, or seconds of tapping, that are kept.
    due_at, overdue_at : UTC, once the training is over; else empty. reminder : to be sent, where one is due.
    resumptions : of the session. interruptions : of the device.
    problem : why the journal cannot be read; empty if it can.
    """

    person: str
    language: str
    simulated: bool
    state: PersonState
    phase: PersonPhase = "enrolled"
    done: int = 0
    trials: int = 0
    rounds: int = 0
    due_at: str = ""
    overdue_at: str = ""
    reminder: str = ""
    resumptions: int = 0
    interruptions: int = 0
    problem: str = ""


class TimingProgress(Struct, frozen=True, forbid_unknown_fields=True):
    """A study as its operator may see it. planned : how many people should take part."""

    name: str
    fingerprint: str
    planned: int
    people: tuple[PersonProgress, ...]


def timing_progress(study: TimingStudy, now_s: float) -> TimingProgress:
    """Return the progress of everybody, in the order of their enrolment. now_s : wall time.

    InputError on a study that was changed, OSError.
    """
    people = tuple(_progress(study, person, now_s) for person in study.people())
    return TimingProgress(study.plan.name, study.fingerprint, study.plan.people, people)


def _progress(study: TimingStudy, person: Person, now_s: float) -> PersonProgress:
    out = person.state in ("withdrawn", "deleted")
    about = PersonProgress(
        person=person.name,
        language=person.language,
        simulated=person.simulated,
        state=person.state,
        phase="out" if out else "enrolled",
    )
    if person.state == "deleted":
        return about
    try:
        state = read_session(study.folder / PEOPLE / person.name / SESSION_FILE, study.plan, TimingState)
    except (InputError, OSError) as error:
        return structs.replace(about, problem=str(error))
    return about if state is None else _known(about, study.plan, state, now_s)


def _known(about: PersonProgress, plan: TimingPlan, state: TimingState, now_s: float) -> PersonProgress:
    phase = about.phase if about.phase == "out" else standing_of(state, now_s)
    due_s = state.not_before_s
    overdue_s = None if state.trained_s is None else state.trained_s + DAY_s * plan.due_days
    return structs.replace(
        about,
        phase=phase,
        done=state.trials_over,
        trials=len(state.started.trials),
        rounds=state.count,
        due_at="" if due_s is None else utc_text(due_s),
        overdue_at="" if overdue_s is None else utc_text(overdue_s),
        reminder=reminder_of(plan, state) if phase in ("waiting", *DUE) else "",
        resumptions=state.resumptions,
        interruptions=state.interruptions,
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
