"""The studies in which labels are felt and answered: what they are, of what `StudyKind` asks."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar

import numpy as np
from msgspec import structs

from fdvv_people.study.kind import Account, StudyKind
from fdvv_people.study.plan.events import SessionStarted, face_of
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.plan_check import plan_problems
from fdvv_people.study.plan.plan_file import read_plan_text
from fdvv_people.study.plan.schedule import draw_schedule
from fdvv_people.study.plan.session import SessionState
from fdvv_people.study.plan.sitting import SittingState

if TYPE_CHECKING:
    from fdvv_people.study.admin.progress import PersonProgress
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.files.opened import OpenedPerson
    from fdvv_people.study.files.people import Person, Schedule
    from fdvv_people.study.plan.answers import Answers
    from fdvv_people.study.plan.trial import StudyTrial
    from fdvv_people.study.simulation.participant import SimulatedParticipant
    from fdvv_people.study.simulation.sessions import SimulatedSession, Simulation


class LabelledStudies(StudyKind[StudyPlan]):
    """Studies that ask about what is rendered."""

    format: ClassVar[str] = "fdvv-study"
    plan = StudyPlan
    described: ClassVar[str] = "no timing study"
    gave: ClassVar[str] = "what they said"
    proxy_data: ClassVar[str] = "answers of the proxies"
    feels: ClassVar[bool] = True
    state: ClassVar[type[SittingState[Any]]] = SessionState

    def read_plan(self, text: str | bytes, source: object) -> StudyPlan:
        return read_plan_text(text, source)

    def problems(self, plan: StudyPlan) -> tuple[str, ...]:
        return plan_problems(plan)

    def unfit(self, plan: StudyPlan, folder: Path) -> Iterable[str]:
        from fdvv_people.study.admin.review import review_plan, twin_problems

        review = review_plan(plan, folder)
        return (*review.problems, *twin_problems(plan, folder, opened=review.models))

    def account(self, plan: StudyPlan, folder: Path) -> Account:
        from fdvv_people.study.admin.preview import account_of
        from fdvv_people.study.admin.review import review_plan

        return account_of(review_plan(plan, folder))

    def device_problems(self, plan: StudyPlan, folder: Path, device: str) -> Iterable[str]:
        from fdvv_people.study.admin.review import device_problems

        del device  # all of them keep the labels of a trial side by side
        return device_problems(plan, folder)

    def draw(self, study: Study, place: int, simulated: bool) -> tuple[StudyTrial, ...]:
        del simulated  # their trials are drawn as those of people
        # seeded by the operating system, anew for everybody: one schedule must not predict the next
        return draw_schedule(study.plan, place, np.random.default_rng())

    def start(self, study: Study, person: Person, schedule: Schedule, at_s: float) -> SessionStarted:
        faces = tuple(face_of(study.plan, trial) for trial in schedule.trials)
        return SessionStarted(at_s, person.name, person.language, faces, person.simulated)

    def progress(self, about: PersonProgress, state: SessionState | None, now_s: float) -> PersonProgress:
        del now_s
        if state is None:
            return about
        counted = [trial.number for trial in state.started.trials if not trial.practice]
        done = sum(number in state.answers for number in counted)
        return structs.replace(about, done=done, trials=len(counted))

    def promise(self, plan: StudyPlan) -> str:
        from fdvv_people.study.admin.preview import SHARE, planned_power

        power = planned_power(plan)
        if power is None:
            return ""
        return f", power {power:.2f} if {100 * SHARE:.0f} % of the answers favour the claim"

    def at_it(self, people: Sequence[PersonProgress], done: int) -> str:
        now = sum(one.state not in ("withdrawn", "deleted") for one in people) - done
        return f"; {now} at it" if now > 0 else ""

    def verdict(self, study: Study) -> tuple[str, bool | None] | None:
        from fdvv_people.study.analysis.analyse import analyse
        from fdvv_people.study.analysis.read_answers import read_answers
        from fdvv_people.study.analysis.sentences import claim_sentence
        from fdvv_people.study.files.layout import UNSEALED

        claim = analyse(read_answers(study.folder / UNSEALED), study.plan).claim
        return None if claim is None else (claim_sentence(claim), claim.supported)

    def unseal(self, plan: StudyPlan, people: Sequence[OpenedPerson], folder: Path) -> Answers:
        from fdvv_people.study.analysis.unseal import unseal_labels

        return unseal_labels(plan, people, folder)

    def draw_simulated(self, study: Study, number: int, simulation: Simulation) -> SimulatedParticipant:
        from fdvv_people.study.simulation.participant import NullRenderer, SimulatedParticipant
        from fdvv_people.study.stimulus.finger import SimulatedFingerRenderer

        seed = simulation.seed
        renderer = (
            SimulatedFingerRenderer(study.folder, seed=seed + number)
            if simulation.pressed
            else NullRenderer()
        )
        return SimulatedParticipant(study.plan, study.folder, renderer, number, seed, simulation.settings)

    def session_row(self, session: SimulatedSession) -> Mapping[str, object]:
        one = session
        return {"person": one.person, "trials": one.count, "breaks": one.breaks, "minutes": one.time_s / 60}

    def report(self, study: Study, origin: str) -> str:
        from fdvv_people.study.analysis.analyse import analyse
        from fdvv_people.study.analysis.jnds import standards_of
        from fdvv_people.study.analysis.read_answers import read_answers
        from fdvv_people.study.analysis.report import study_html
        from fdvv_people.study.files.layout import UNSEALED

        answers, plan = read_answers(study.folder / UNSEALED), study.plan
        return study_html(analyse(answers, plan, standards=standards_of(plan, study.folder)), plan, origin)


KIND = LabelledStudies()
