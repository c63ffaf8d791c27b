"""A whole frozen study with simulated participants, from enrolment to the last page. Simulated."""

from __future__ import annotations

import time
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from datetime import datetime
from typing import Any, Protocol

from fdvv.errors import InputError, ModelError
from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.events import Value
from fdvv_people.study.plan.plan import Page
from fdvv_people.study.plan.sitting import ENDS, Step
from fdvv_people.study.session.sitting import Sitting
from fdvv_people.study.simulation.people import ProxySettings

Progress = Callable[[int, int], None]
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
class Simulation:
    """How participants are simulated; each kind of study takes what concerns it.

    Attributes
    ----------
    seed : of who they are, and of what they do. settings : of proxies who judge; None: the usual ones.
    pressed : have a simulated finger press the twin; False: nothing is known of what was rendered then.
    rig : what renders the buttons of a timing study.
    """

    seed: int = 0
    settings: ProxySettings | None = None
    pressed: bool = True
    rig: str = "ideal"


class SimulatedPerson(Protocol):
    """A simulated participant of some kind of study."""

    def sit_down(self, study: Study, person: str, code: str, clock: SimulatedClock) -> Sitting[Any]:
        """Begin, or resume, the session of a person of a study."""

    def fill_in(self, page: Page, language: str) -> Mapping[str, Value]:
        """Fill in a page, in a way that anybody could."""

    def do(self, participant: Any, step: Step[Any], clock: SimulatedClock) -> None:
        """Do what a step asks for that is neither a page nor a break nor a gap."""


@dataclass(frozen=True)
class SimulatedSession:
    """What one simulated participant did.

    Attributes
    ----------
    person : as the study names them. trials : that are over. count : of answers, or rounds, that were given.
    time_s : simulated, from the first page to the last.
    """

    person: str
    trials: int
    count: int
    breaks: int
    time_s: float


@dataclass(frozen=True)
class SimulatedStudy:
    """What a simulation added to a study.

    Attributes
    ----------
    sessions : of the people that it added. finished : simulated people of the study that are done, by name.
    """

    sessions: tuple[SimulatedSession, ...]
    finished: tuple[str, ...]


def simulate_study(
    study: Study,
    people: int | None = None,
    simulation: Simulation | None = None,
    progress: Progress = lambda _done, _total: None,
) -> SimulatedStudy:
    """Have simulated participants take part, one after the other, until so many are done.

    people : as many as are planned if None; those who are done already count. Schedules are drawn from what
    the operating system holds random, as for people. progress : trials done and in all.

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
    total = wanted - len(_finished(study))
    for done in range(total):

        def report(part: float, done: int = done) -> None:
            progress(round(100 * (done + part)), 100 * total)

        person = study.kind.draw_simulated(study, len(study.people()), simulation or Simulation())
        sessions.append(_session(study, person, report))
    return SimulatedStudy(tuple(sessions), _finished(study))


def _finished(study: Study) -> tuple[str, ...]:
    return tuple(person.name for person in study.people() if person.state == "finished")


def _session(study: Study, simulated: SimulatedPerson, report: Callable[[float], None]) -> SimulatedSession:
    clock, breaks = SimulatedClock(time.time()), 0
    start_s = clock()
    person, code = study.enrol(simulated=True)
    participant = simulated.sit_down(study, person, code, clock)
    try:
        while (step := participant.step()).kind not in ENDS:
            report(step.progress)
            breaks += step.kind == "break"
            if step.kind == "wait":  # they go home, and come back with their card
                participant.close()
                clock.skip(until_s(step) - clock())
                participant = simulated.sit_down(study, person, code, clock)
            else:
                do_step(participant, simulated, step, clock)
    except KeyboardInterrupt:
        participant.close()
        study.withdraw(person, delete=True)
        raise
    finally:
        participant.close()
    state = participant.state
    return SimulatedSession(person, state.trials_over, state.count, breaks, clock() - start_s)


def until_s(step: Step[Any]) -> float:
    """Return the wall time at which a gap is over."""
    return datetime.fromisoformat(step.due_at).timestamp() + 1.0


def do_step(
    participant: Sitting[Any], simulated: SimulatedPerson, step: Step[Any], clock: SimulatedClock
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
        simulated.do(participant, step, clock)
