"""A study in a folder: declared, frozen, run, unsealed."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from fdvv.errors import InputError
from fdvv_people.study.admin.kept import KeptStudy
from fdvv_people.study.admin.planned import UNFIT
from fdvv_people.study.admin.review import review_plan, twin_problems
from fdvv_people.study.analysis.unseal import unseal_folder
from fdvv_people.study.files.people import Person, Schedule
from fdvv_people.study.plan.answers import Answers
from fdvv_people.study.plan.events import SessionStarted, face_of
from fdvv_people.study.plan.plan import StudyPlan
from fdvv_people.study.plan.plan_file import STUDY_FILE, check_plan, read_plan_text
from fdvv_people.study.plan.schedule import draw_schedule
from fdvv_people.study.plan.trial import StudyTrial


class Study(KeptStudy[StudyPlan]):
    """A study that lies in a folder; no file is held open between two calls. Made by `declare` or `open`.

    Attributes
    ----------
    folder : of the study. run_key : in memory while sessions are open, see `open_sessions`; else None.
    """

    @staticmethod
    def read_plan(text: str | bytes, source: object) -> StudyPlan:
        return read_plan_text(text, source)

    def check(self) -> None:
        """Raise InputError on a plan that could not be run or analysed as it says, its buttons among it."""
        folder, plan = self.folder, self.plan
        check_plan(plan, folder / STUDY_FILE)
        review = review_plan(plan, folder)
        for problem in (*review.problems, *twin_problems(plan, folder, opened=review.models)):
            raise InputError(folder / STUDY_FILE, "plan", problem, UNFIT)

    def draw(self, place: int, simulated: bool) -> tuple[StudyTrial, ...]:
        """Draw the trials of a person. **Secret.** Simulated people's are drawn as those of people."""
        # seeded by the operating system, anew for everybody: one schedule must not predict the next
        return draw_schedule(self.plan, place, np.random.default_rng())

    def start(self, person: Person, schedule: Schedule, at_s: float) -> SessionStarted:
        """Return the event with which a person's session begins: what may be seen of their trials."""
        faces = tuple(face_of(self.plan, trial) for trial in schedule.trials)
        return SessionStarted(at_s, person.name, person.language, faces, person.simulated)

    def unseal(
        self, passphrase: str, who: str, why: str, keeper: Path | None = None, despite: bool = False
    ) -> Answers:
        """Return the answers with what their labels hid, and write them to unsealed/; recorded first.

        Trials that are still to be answered stay sealed. who, why : recorded for good. despite : go on where
        people's files were changed: nothing of theirs counts, and the record says so.
        InputError on a wrong passphrase, an empty name or reason, a study that is not whole. OSError.
        """
        holder, about = self.require_unsealable(passphrase, who, why, keeper, despite)
        with self.log() as log:
            return unseal_folder(self.folder, self.plan, log, holder, about)
