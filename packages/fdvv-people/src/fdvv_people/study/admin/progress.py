"""What the operator may see of a running study: how far everybody is, and nothing that a label or code hides.

It is read from plain files only, without a key, so that a screen cannot reveal more.
"""

from __future__ import annotations

import time
from collections.abc import Sequence
from typing import Any, ClassVar, Literal

from msgspec import Struct, structs

from fdvv.errors import InputError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.folder import StudyFolder
from fdvv_people.study.files.layout import PEOPLE, SESSION_FILE
from fdvv_people.study.files.people import Person, PersonState
from fdvv_people.study.plan.plan import DeclaredPlan
from fdvv_people.study.plan.sitting import StepKind
from fdvv_people.study.session.log import read_session

Kind = Literal["", "good", "warning"]


class PersonProgress(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """The progress of a person.

    Attributes
    ----------
    person, language, simulated, state : see Person. kind, page : of the step that is due; None and "" where
        that is unknown: the session has not started, or was deleted.
    done, trials : of those that count; of a staircase trials is the most there can be.
    interruptions : of the device. resumptions : of the session.
    problem : why the journal cannot be read; empty if it can.
    left : how many of the first columns of a table of people are words.
    """

    left: ClassVar[int] = 3

    person: str
    language: str
    simulated: bool
    state: PersonState
    kind: StepKind | None = None
    page: str = ""
    done: int = 0
    trials: int = 0
    interruptions: int = 0
    resumptions: int = 0
    problem: str = ""

    @property
    def place(self) -> str:
        """Where they are, in a word or two."""
        if self.problem:
            return "not to be read"
        if self.state in ("withdrawn", "deleted"):
            return self.state
        return f"page {self.page}" if self.kind == "page" else (self.kind or self.state)

    @property
    def call(self) -> str:
        """The line that says that they are to be called back, or nothing."""
        return ""

    def cells(self) -> dict[str, object]:
        """Return their row of a table of people, by column."""
        who = {"person": self.person, "language": self.language, "state": self.state}
        return {**who, "answered": f"{self.done} of {self.trials}", "resumed": self.resumptions}

    def document(self) -> dict[str, Any]:
        """Return them for programs."""
        who = {"person": self.person, "language": self.language, "state": self.state}
        trials = {"simulated": self.simulated, "answered": self.done, "trials": self.trials}
        events = {"resumed": self.resumptions, "interrupted": self.interruptions}
        return {**who, **trials, **events, "problem": self.problem}


def study_progress(study: StudyFolder, now_s: float) -> tuple[PersonProgress, ...]:
    """Return the progress of everybody, in the order of their enrolment. now_s : wall time.

    InputError on a study that was changed, OSError.
    """
    return tuple(_progress(study, person, now_s) for person in study.people())


def _progress(study: StudyFolder, person: Person, now_s: float) -> PersonProgress:
    about = PersonProgress(
        person=person.name, language=person.language, simulated=person.simulated, state=person.state
    )
    if person.state == "deleted":
        return study.kind.progress(about, None, now_s)
    path = study.folder / PEOPLE / person.name / SESSION_FILE
    try:
        state = read_session(path, study.plan, study.kind.state)
    except (InputError, OSError) as error:
        return study.kind.progress(structs.replace(about, problem=str(error)), None, now_s)
    if state is None:
        return study.kind.progress(about, None, now_s)
    step = state.step(now_s)
    about = structs.replace(
        about,
        kind=step.kind,
        page=step.page,
        interruptions=state.interruptions,
        resumptions=state.resumptions,
    )
    return study.kind.progress(about, state, now_s)


def standing(study: Study) -> tuple[str, Kind]:
    """Return how far a study is, or what an unsealed one found. InputError, OSError."""
    plan, kind = study.plan, study.kind
    if study.frozen is None:
        problems = kind.account(plan, study.folder).problems
        return draft_sentence(plan, problems, "" if problems else kind.promise(plan))
    if any("unsealed" in record for record in study.history()):
        found = kind.verdict(study)
        if found is None:
            return "The study is open; it claims nothing, so read its report.", ""
        return found[0], "good" if found[1] else "warning"
    people = study_progress(study, time.time())
    done = sum(one.state == "finished" for one in people)
    if done >= plan.people:
        return f"All {plan.people} participants are done: unseal the study to see {kind.gave}.", "good"
    return f"{done} of {plan.people} participants done{kind.at_it(people, done)}.", ""


def draft_sentence(plan: DeclaredPlan, problems: Sequence[str], promise: str = "") -> tuple[str, Kind]:
    """Return what a plan comes to, or what is missing before it can be frozen. promise : see `StudyKind`."""
    if problems:
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        return f"Not ready to freeze: {problems[0]}{more}.", "warning"
    people = f"{plan.people} participant{'s' * (plan.people != 1)}"
    return f"Ready to freeze: {people} × {plan.trials} trial{'s' * (plan.trials != 1)}{promise}.", "good"
