"""A whole frozen timing study with simulated participants, the gap included. Simulated."""

from __future__ import annotations

import time
from collections.abc import Callable
from dataclasses import dataclass
from datetime import datetime

from fdvv_people.optimize.people.groups import TAPPERS
from fdvv_people.optimize.people.user import SimulatedUser, UserSettings, draw_user
from fdvv_people.study.plan.sitting import ENDS, Step
from fdvv_people.study.simulation.sessions import PAGE_s, Progress, SimulatedClock, finished, simulate_people
from fdvv_people.timing.files.study import TimingStudy
from fdvv_people.timing.plan.plan import DAY_s
from fdvv_people.timing.plan.schedule import TimingFace
from fdvv_people.timing.session.participant import TimingParticipant
from fdvv_people.timing.simulation.people import SimulatedTimer

PLACE_s, BETWEEN_s = 20.0, 5.0
"""To put a switch on the table, and between two trials (assumed)."""


@dataclass(frozen=True)
class SimulatedTiming:
    """What one simulated participant did. days : of simulated time, from the first page to the last."""

    person: str
    trials: int
    rounds: int
    breaks: int
    days: float


@dataclass(frozen=True)
class SimulatedTimingStudy:
    """What a simulation added to a study.

    Attributes
    ----------
    sessions : of the people that it added. finished : simulated people of the study that are done, by name.
    """

    sessions: tuple[SimulatedTiming, ...]
    finished: tuple[str, ...]
    simulated: bool = True


def simulate_timing(
    study: TimingStudy,
    people: int | None = None,
    seed: int = 0,
    rig: str = "ideal",
    progress: Progress = lambda _done, _total: None,
) -> SimulatedTimingStudy:
    """Have simulated participants take part until so many are done.

    people : as many as are planned if None; those who are done already count. seed : of who they are and how
    they press; orders and codes are drawn as for people. rig : what renders buttons. progress : trials done
    and in all.

    InputError on a study that is not frozen or has people in it. On Ctrl-C who has not finished is withdrawn
    and deleted. OSError.
    """

    def play(number: int, report: Callable[[float], None]) -> SimulatedTiming:
        return _session(study, SimulatedTimer(_user(study, number, seed), seed, rig), report)

    return SimulatedTimingStudy(simulate_people(study, people, play, progress), finished(study))


def _user(study: TimingStudy, number: int, seed: int) -> SimulatedUser:
    """Draw one person of a study, who of tapping has a finger's limit."""
    return draw_user(number, seed, TAPPERS if study.plan.tapping else UserSettings())


def _session(study: TimingStudy, timer: SimulatedTimer, report: Callable[[float], None]) -> SimulatedTiming:
    clock, breaks = SimulatedClock(time.time()), 0
    start_s = clock()
    participant, code = TimingParticipant.enrol(study, simulated=True, clock=clock)
    person = participant.person
    try:
        while (step := participant.step()).kind not in ENDS:
            report(step.progress)
            breaks += step.kind == "break"
            if step.kind == "wait":  # they go home, and come back with their card
                participant.close()
                clock.skip(until_s(step) - clock())
                participant = TimingParticipant.resume(study, person, code, clock=clock)
            else:
                do_timing_step(participant, timer, step, clock)
    except KeyboardInterrupt:
        participant.close()
        study.withdraw(person, delete=True)
        raise
    finally:
        participant.close()
    state = participant.state
    return SimulatedTiming(person, state.trials_over, state.count, breaks, (clock() - start_s) / DAY_s)


def until_s(step: Step[TimingFace]) -> float:
    """Return the wall time at which a gap is over."""
    return datetime.fromisoformat(step.due_at).timestamp() + 1.0


def do_timing_step(
    participant: TimingParticipant, timer: SimulatedTimer, step: Step[TimingFace], clock: SimulatedClock
) -> None:
    """Do what a step asks for: answer a page, place a switch, play a trial, or wait until a break ends."""
    if step.kind == "page":
        clock.skip(PAGE_s)
        timer.fill_in(participant, step.page)
    elif step.kind == "place":
        clock.skip(PLACE_s)
        participant.place(step.number)
    elif step.kind == "break":
        clock.skip(step.left_s)
        participant.end_break()
    else:
        clock.skip(BETWEEN_s)
        begun = timer.play(participant, step.number)
        clock.skip(begun.rounds * participant.study.plan.round_s(step.trial.level))
