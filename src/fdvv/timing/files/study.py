"""A timing study in a folder: declared, frozen, run, unsealed."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import ClassVar

from fdvv.errors import FdvvError, InputError
from fdvv.model.file import builtin_names
from fdvv.program.library import names_program
from fdvv.study.admin.kept import KeptStudy
from fdvv.study.admin.study import Study
from fdvv.study.files.people import Person, Schedule
from fdvv.study.files.person_check import SessionReading
from fdvv.study.files.seal import CODE_COST, PASSPHRASE_COST, Cost
from fdvv.study.plan.plan_file import STUDY_FILE
from fdvv.study.plan.trial import StudyTrial
from fdvv.timing.files.buttons import opened_button
from fdvv.timing.files.reading import READING
from fdvv.timing.plan.events import TimingStarted
from fdvv.timing.plan.plan import TimingPlan
from fdvv.timing.plan.plan_file import check_timing_plan, is_timing, read_timing_plan
from fdvv.timing.plan.schedule import SEED, draw_validation, drawn_seed, faces_of


class TimingStudy(KeptStudy):
    """A timing study that lies in a folder; no file is held open between two calls.

    Made by `declare` or `open`. What it shares with every study, as pauses and withdrawal, is `KeptStudy`.
    """

    reading: ClassVar[SessionReading] = READING

    def __init__(self, folder: Path) -> None:
        super().__init__(folder)
        self._plan: tuple[bytes, TimingPlan] | None = None

    @classmethod
    def files_named(cls, text: str, source: object) -> tuple[str, ...]:
        return named_files(read_timing_plan(text, source))

    @property
    def plan(self) -> TimingPlan:
        """The plan. InputError where it cannot be read, or is not what was frozen."""
        data = self.plan_text
        if self._plan is None or self._plan[0] != data:
            self._plan = data, read_timing_plan(data, self.folder / STUDY_FILE)
        return self._plan[1]

    def freeze(self, passphrase: str, cost: Cost = PASSPHRASE_COST) -> str:
        """Freeze the study, and return its fingerprint: from now on every change is noticed.

        passphrase : the key holder's; it is not stored. Sessions are open in this object from then on.
        InputError on a plan with problems, a study that was frozen before, a short passphrase. BuildError: no
        PyNaCl. OSError.
        """
        plan = self.plan
        check_timing_plan(plan, self.folder / STUDY_FILE)
        for problem in button_problems(plan, self.folder):
            remedy = "change it: it could not be run as it says"
            raise InputError(self.folder / STUDY_FILE, "plan", problem, remedy)
        self.require_unfrozen()
        builtins = sorted({one.button for one in plan.conditions} & set(builtin_names()))
        return self.freeze_files(named_files(plan), builtins, passphrase, cost)

    def enrol(
        self, language: str = "", consent: str = "", simulated: bool = False, cost: Cost = CODE_COST
    ) -> tuple[str, str]:
        """Enrol a person, see `enrol_person`. Return their name and their code. InputError, OSError."""

        def draw(place: int) -> tuple[StudyTrial, ...]:
            return draw_validation(self.plan, place, self._secret(simulated))

        return self.enrol_person(draw, self.plan.languages, language, consent, simulated, cost)

    def start(self, person: Person, schedule: Schedule, at_s: float) -> TimingStarted:
        """Return the event with which a person's session begins: what may be seen of their trials."""
        faces, seed = faces_of(self.plan, person.place, schedule.trials), drawn_seed(schedule.key, SEED)
        return TimingStarted(at_s, person.name, person.language, seed, faces, person.simulated)

    def _secret(self, simulated: bool) -> str:
        """Return what orders are drawn with. Simulated people have nothing to be blind to."""
        what = f"orders of conditions, {self.fingerprint}"
        return what if simulated or self.run_key is None else self.run_key.mark(what)


AnyStudy = Study | TimingStudy


def open_study(folder: Path) -> AnyStudy:
    """Open the study in a folder, of whichever kind. InputError where there is none."""
    return TimingStudy.open(folder) if is_timing(folder) else Study.open(folder)


def named_files(plan: TimingPlan) -> tuple[str, ...]:
    """Return the files that a plan names, as it names them."""
    named = {one.button for one in plan.conditions if one.button}
    shipped = {one for one in named if one in builtin_names() or (names_program(one) and "." not in one)}
    return tuple(sorted(named - shipped))


def button_problems(plan: TimingPlan, folder: Path) -> Iterator[str]:
    """List buttons and programs of a plan that cannot be opened."""
    for one in plan.conditions:
        try:
            if one.button:
                opened_button(folder, one)
        except (FdvvError, OSError) as error:
            yield f"conditions ({one.name!r}): {error}"
