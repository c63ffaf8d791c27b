"""A whole frozen study with simulated participants, from enrolment to the last page. Simulated."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from fdvv.errors import InputError, ModelError
from fdvv_people.study.admin.kept import KeptStudy
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.events import TrialFace
from fdvv_people.study.plan.sitting import ENDS, Step
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.simulation.participant import NullRenderer, SimulatedParticipant
from fdvv_people.study.simulation.people import ProxySettings
from fdvv_people.study.stimulus.finger import SimulatedFingerRenderer

Progress = Callable[[int, int], None]
Done = TypeVar("Done")
PAGE_s = 30.0
"""Time that a page takes."""


class SimulatedClock:
    """Wall time that passes only by skip()."""

    def __init__(self, begin_s: float) -> None:
        self._now_s = begin_s

    def __call__(self) -> float:
        return self._now_s

    def skip(self, by_s: float) -> None:
        self._now_s += max(0.0, by_s)


@dataclass(frozen=True)
class SimulatedSession:
    """What one simulated participant did. person : as the study names it. minutes : of simulated time."""

    person: str
    trials: int
    breaks: int
    minutes: float


@dataclass(frozen=True)
class SimulatedStudy:
    """What a simulation added to a study.

    Attributes
    ----------
    sessions : of the people that it added. finished : simulated people of the study that are done, by name.
    pressed : a simulated finger pressed the twin; False: nothing was rendered.
    """

    sessions: tuple[SimulatedSession, ...]
    finished: tuple[str, ...]
    pressed: bool
    simulated: bool = True


def simulate_study(
    study: Study,
    people: int | None = None,
    seed: int = 0,
    pressed: bool = True,
    settings: ProxySettings | None = None,
    progress: Progress = lambda _done, _total: None,
) -> SimulatedStudy:
    """Have simulated participants take part until so many are done.

    people : as many as are planned if None; those who are done already count. seed : of how they feel and
    answer; schedules are drawn from what the operating system holds random, as for people. pressed : have a
    simulated finger press the twin; False leaves that out, and nothing is known of what was rendered.
    progress : trials done and in all.

    InputError on a study that is not frozen or has people in it. On Ctrl-C who has not finished is withdrawn
    and deleted. OSError.
    """

    def play(number: int, report: Callable[[float], None]) -> SimulatedSession:
        renderer = SimulatedFingerRenderer(study.folder, seed=seed + number) if pressed else NullRenderer()
        simulated = SimulatedParticipant(study.plan, study.folder, renderer, number, seed, settings)
        return _session(study, simulated, report)

    sessions = simulate_people(study, people, play, progress)
    return SimulatedStudy(sessions, finished(study), pressed)


def simulate_people(
    study: KeptStudy[Any],
    people: int | None,
    play: Callable[[int, Callable[[float], None]], Done],
    progress: Progress,
) -> tuple[Done, ...]:
    """Have simulated participants take part, one after the other, until so many are done.

    people : as many as are planned if None. play : the whole session of one, by number; it reports the part
    that is over. Returns what the sessions that were added came to. InputError on a study that has people.
    """
    wanted = study.plan.people if people is None else people
    if wanted < 1:
        raise ModelError(f"a study needs at least 1 person, got {wanted}")
    if any(not person.simulated for person in study.people()):
        reason = "has people, and cannot have simulated ones beside them"
        raise InputError(study.folder, "study", reason, "declare another study for them")
    sessions: list[Done] = []
    total = wanted - len(finished(study))
    for done in range(total):

        def report(part: float, done: int = done) -> None:
            progress(round(100 * (done + part)), 100 * total)

        sessions.append(play(len(study.people()), report))
    return tuple(sessions)


def finished(study: KeptStudy[Any]) -> tuple[str, ...]:
    """Return the simulated people of a study who are done, by name."""
    return tuple(person.name for person in study.people() if person.state == "finished")


def _session(
    study: Study, simulated: SimulatedParticipant, report: Callable[[float], None]
) -> SimulatedSession:
    clock, breaks = SimulatedClock(time.time()), 0
    start_s = clock()
    participant, _ = Participant.enrol(
        study, study.plan.languages[0], simulated.renderer, simulated=True, clock=clock
    )
    try:
        with participant:
            while (step := participant.step()).kind not in ENDS:
                report(step.progress)
                breaks += step.kind == "break"
                do_step(participant, simulated, step, clock)
            trials = len(participant.state.answers)
    except KeyboardInterrupt:
        study.withdraw(participant.person, delete=True)
        raise
    return SimulatedSession(participant.person, trials, breaks, (clock() - start_s) / 60)


def do_step(
    participant: Participant, simulated: SimulatedParticipant, step: Step[TrialFace], clock: SimulatedClock
) -> None:
    """Do what a step asks for: answer a page or a trial, or wait until a break ends."""
    if step.kind == "page":
        page = next(page for page in participant.study.plan.pages if page.name == step.page)
        clock.skip(PAGE_s)
        participant.answer_page(page.name, simulated.fill_in(page, participant.language))
    elif step.kind == "break":
        clock.skip(step.left_s)
        participant.end_break()
    else:
        participant.show_trial(step.number)
        order = simulated.order(step.trial.labels)
        piece_s = simulated.takes_s() / (len(order) + 1)
        for label in order:
            participant.go_to(label)
            clock.skip(piece_s)
        clock.skip(piece_s)
        participant.answer(step.number, simulated.answer(step.trial.item))
