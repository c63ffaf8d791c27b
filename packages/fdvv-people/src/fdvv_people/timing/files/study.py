"""A timing study in a folder: declared, frozen, run, unsealed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

from fdvv.errors import FdvvError, InputError
from fdvv_people.study.admin.kept import KeptStudy
from fdvv_people.study.admin.planned import UNFIT
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import Person, Schedule
from fdvv_people.study.files.person_check import SessionReading
from fdvv_people.study.plan.plan_file import STUDY_FILE
from fdvv_people.study.plan.trial import StudyTrial
from fdvv_people.timing.files.buttons import opened_button
from fdvv_people.timing.files.reading import READING
from fdvv_people.timing.plan.events import TimingStarted
from fdvv_people.timing.plan.plan import TimingPlan
from fdvv_people.timing.plan.plan_file import check_timing_plan, is_timing, read_timing_plan
from fdvv_people.timing.plan.schedule import SEED, draw_validation, drawn_seed, faces_of


class TimingStudy(KeptStudy[TimingPlan]):
    """A timing study that lies in a folder; no file is held open between two calls.

    Made by `declare` or `open`. What it shares with every study, as pauses and withdrawal, is `KeptStudy`.
    """

    reading: ClassVar[SessionReading] = READING

    @staticmethod
    def read_plan(text: str | bytes, source: object) -> TimingPlan:
        return read_timing_plan(text, source)

    def check(self) -> None:
        """Raise InputError on a plan that could not be run or analysed as it says, its buttons among it."""
        check_timing_plan(self.plan, self.folder / STUDY_FILE)
        for problem in button_problems(self.plan, self.folder):
            raise InputError(self.folder / STUDY_FILE, "plan", problem, UNFIT)

    def draw(self, place: int, simulated: bool) -> tuple[StudyTrial, ...]:
        """Draw the validation of a person. **Secret.**"""
        what = f"orders of conditions, {self.fingerprint}"
        # simulated people have nothing to be blind to
        secret = what if simulated or self.run_key is None else self.run_key.mark(what)
        return draw_validation(self.plan, place, secret)

    def start(self, person: Person, schedule: Schedule, at_s: float) -> TimingStarted:
        """Return the event with which a person's session begins: what may be seen of their trials."""
        faces, seed = faces_of(self.plan, person.place, schedule.trials), drawn_seed(schedule.key, SEED)
        return TimingStarted(at_s, person.name, person.language, seed, faces, person.simulated)


AnyStudy = Study | TimingStudy


def open_study(folder: Path) -> AnyStudy:
    """Open the study in a folder, of whichever kind. InputError where there is none."""
    return TimingStudy.open(folder) if is_timing(folder) else Study.open(folder)


def button_problems(plan: TimingPlan, folder: Path) -> Iterator[str]:
    """List buttons and programs of a plan that cannot be opened."""
    for one in plan.conditions:
        try:
            if one.button:
                opened_button(folder, one)
        except (FdvvError, OSError) as error:
            yield f"conditions ({one.name!r}): {error}"
