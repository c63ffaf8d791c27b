"""A whole frozen study with simulated participants, from enrolment to the last page. Simulated."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from fdvv.errors import InputError, ModelError
from fdvv.study import ENDS, ProxySettings, Step
from fdvv.workflow._participant import Participant
from fdvv.workflow._study import Study
from fdvv.workflow._study_simulated_person import SimulatedParticipant, UnpressedStage
from fdvv.workflow._study_stage import StudyStage
from fdvv.workflow._study_stage_finger import SimulatedFingerStage

Progress = Callable[[int, int], None]
PAGE_s = 30.0
"""Time that a page takes."""


class SkippedClock:
    """Wall time that passes only when it is told to."""

    def __init__(self, begin_s: float) -> None:
        self._now_s = begin_s

    def __call__(self) -> float:
        """Tell the time in seconds."""
        return self._now_s

    def skip(self, by_s: float) -> None:
        """Let time pass."""
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
    wanted = study.plan.people if people is None else people
    if wanted < 1:
        raise ModelError(f"a study needs at least 1 person, got {wanted}")
    if any(not person.simulated for person in study.people()):
        reason = "has people, and cannot have simulated ones beside them"
        raise InputError(study.folder, "study", reason, "declare another study for them")
    sessions: list[SimulatedSession] = []
    total = wanted - len(finished(study))
    for done in range(total):
        hand = _hand(study, seed, pressed, settings)
        sessions.append(_session(study, hand, partial(_tell, progress, done, total)))
    return SimulatedStudy(tuple(sessions), finished(study), pressed)


def finished(study: Study) -> tuple[str, ...]:
    """Give the names of those who are done."""
    return tuple(person.name for person in study.people() if person.state == "finished")


def _tell(progress: Progress, done: int, total: int, part: float) -> None:
    """Tell progress in hundredths of a person."""
    progress(round(100 * (done + part)), 100 * total)


def _hand(study: Study, seed: int, pressed: bool, settings: ProxySettings | None) -> SimulatedParticipant:
    """Make the simulated participant who comes next."""
    number = len(study.people())
    finger = SimulatedFingerStage(study.folder, seed=seed + number)
    stage: StudyStage = finger if pressed else UnpressedStage()
    return SimulatedParticipant(study.plan, study.folder, stage, number, seed, settings)


def _session(study: Study, hand: SimulatedParticipant, tell: Callable[[float], None]) -> SimulatedSession:
    """Take one simulated participant through a whole session."""
    clock = SkippedClock(time.time())
    participant, _ = Participant.enrol(
        study, study.plan.languages[0], hand.stage, simulated=True, clock=clock
    )
    begun_s, breaks = clock(), 0
    try:
        with participant:
            while (step := participant.step()).kind not in ENDS:
                tell(step.progress)
                breaks += step.kind == "break"
                meet(participant, hand, step, clock)
            trials = len(participant.state.answers)
    except KeyboardInterrupt:
        study.withdraw(participant.person, delete=True)
        raise
    return SimulatedSession(participant.person, trials, breaks, (clock() - begun_s) / 60)


def meet(participant: Participant, hand: SimulatedParticipant, step: Step, clock: SkippedClock) -> None:
    """Do what a step asks for: answer a page or a trial, or sit out a break."""
    if step.kind == "page":
        page = next(page for page in participant.study.plan.pages if page.name == step.page)
        clock.skip(PAGE_s)
        participant.answer_page(page.name, hand.fill_in(page, participant.language))
    elif step.kind == "break":
        clock.skip(step.left_s)
        participant.end_break()
    else:
        _trial(participant, hand, step, clock)


def _trial(participant: Participant, hand: SimulatedParticipant, step: Step, clock: SkippedClock) -> None:
    participant.shown(step.number)
    order = hand.order(step.labels)
    piece_s = hand.takes_s() / (len(order) + 1)
    for label in order:
        participant.go_to(label)
        clock.skip(piece_s)
    clock.skip(piece_s)
    participant.answer(step.number, hand.answer(step.item))
