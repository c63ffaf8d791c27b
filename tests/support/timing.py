"""Small timing studies, and people who press at known times."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from fdvv_people.study.admin.study import Study
from fdvv_people.study.plan.sitting import ENDS, Step
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from fdvv_people.study.timing.schedule import TimingFace
from fdvv_people.task.rounds import ClockSource, RoundTiming
from tests.support.studies import CHEAP, PASSPHRASE

SMALL = """
format = "fdvv-timing"
version = 1
name = "small"
title = { en = "Small" }
levels = ["easy", "hard"]
presses = 3
rounds = 1
people = 4
break_every_min = 0
reminder = { en = "{person}, come from {date} on." }
[training]
trials = 2
engine = "sobol"
[[conditions]]
name = "optimised"
kind = "optimised"
[[conditions]]
name = "MX Red"
kind = "button"
button = "mx-red"
[[conditions]]
name = "table"
kind = "switch"
button = "mx-clear"
latency_ms = 1.0
latency_error_ms = 1.0
[[conditions]]
name = "random"
kind = "random"
[claim]
better = "optimised"
[[pages]]
name = "consent"
when = "consent"
title = { en = "Consent" }
"""
TIMING = RoundTiming(ClockSource.PAGE, 20.0, 16.0, 10.0, 8.0, 0.1, 0.2, 3.0, 16.7, "key")
START_s = 1_790_000_000.0


class Clock:
    """Wall time that passes when it is said so."""

    def __init__(self) -> None:
        self.now_s = START_s

    def __call__(self) -> float:
        return self.now_s


def declared(folder: Path, text: str = SMALL) -> Study:
    return Study.declare_text(folder, text, folder.parent)


def frozen(folder: Path, text: str = SMALL) -> Study:
    study = declared(folder, text)
    study.freeze(PASSPHRASE, CHEAP)
    return study


def attended(folder: Path) -> Study:
    """Open a study with its sessions open."""
    study = Study.open(folder)
    study.open_sessions(PASSPHRASE)
    return study


def late_s(number: int, round_: int) -> float:
    """Return how late a person is in a round: known, and another in each."""
    return 0.001 * (1 + number) + 0.0001 * round_


def press(participant: TimingParticipant, number: int, round_: int) -> None:
    target_s = 10.0 * round_
    participant.keep(number, target_s, (target_s + late_s(number, round_),), TIMING)


def do_step(participant: TimingParticipant, step: Step[TimingFace], clock: Clock) -> None:
    """Do what a step asks for; a trial is played to its end."""
    if step.kind == "page":
        participant.answer_page(step.page, {})
    elif step.kind == "place":
        participant.place(step.number)
    elif step.kind == "break":
        clock.now_s += step.left_s
        participant.end_break()
    elif step.kind == "wait":
        clock.now_s += 7 * DAY_s
    else:
        begun = participant.begin(step.number, "page")
        for round_ in range(begun.kept + 1, begun.rounds + 1):
            press(participant, step.number, round_)


def do_all(participant: TimingParticipant, clock: Clock, until: str = "") -> Iterator[Step[TimingFace]]:
    """Yield every step before it is done, to the end or to one of a kind."""
    while (step := participant.step()).kind not in (*ENDS, until):
        yield step
        do_step(participant, step, clock)
