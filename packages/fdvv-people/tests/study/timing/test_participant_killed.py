"""A timing session whose process is killed at any moment: no press that was acknowledged is lost."""

from __future__ import annotations

import os
import random
import signal
import time
from pathlib import Path

import pytest

from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.plan.sitting import ENDS
from fdvv_people.study.timing.events import RoundKept
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from fdvv_people.study.timing.state import TimingState
from tests.hatchery import Hatchery, fork_and_kill
from tests.support.studies import PASSPHRASE
from tests.support.timing import SMALL, TIMING, Clock, attended, do_step, frozen, late_s

BIG = SMALL.replace("presses = 3", "presses = 20").replace("trials = 2", "trials = 6")
WEEK_LATER = 30 * DAY_s


class LongClock(Clock):
    """The clock of a life: wall time, a month further on once the training is over."""

    def __init__(self) -> None:
        self.ahead_s = 0.0

    def __call__(self) -> float:
        return time.time() + self.ahead_s


def hatch() -> None:
    """Fork lives and kill them."""
    import sklearn.gaussian_process  # noqa: F401

    fork_and_kill(live)


def live(folder: str, person: str, code: str, into: int) -> None:
    """Go on with a session, tell every press that is kept, and wait to be killed."""
    os.fsync = lambda fd: None
    clock = LongClock()
    with TimingParticipant.resume(attended(Path(folder)), person, code, clock=clock) as one:
        while (step := one.step()).kind not in ENDS:
            if step.kind == "wait":
                clock.ahead_s = WEEK_LATER
            elif step.kind != "trial":
                do_step(one, step, clock)
            else:
                begun = one.begin(step.number, "page")
                for round_ in range(begun.kept + 1, begun.rounds + 1):
                    key_s = 10.0 * round_ + late_s(step.number, round_)
                    one.keep(step.number, 10.0 * round_, (key_s,), TIMING)
                    os.write(into, f"{step.number} {round_} {key_s!r}\n".encode())
    os.write(into, b"done\n")
    os.close(into)
    signal.pause()


def kept_rounds(folder: Path, person: str) -> dict[tuple[int, int], float]:
    """Return when the key went down in every round that is on the disk."""
    records = read_chained(folder / "people" / person / "session.jsonl").records
    events = [TimingState.event_of(record) for record in records]
    found = [one for one in events if isinstance(one, RoundKept)]
    assert len({(one.number, one.round) for one in found}) == len(found), "a round was met twice"
    return {(one.number, one.round): one.activations_s[0] for one in found}


def check_kills(folder: Path, seed: int, longest_s: float, most: int) -> int:
    """Kill one session until it is done; return how often that was."""
    rng = random.Random(seed)
    study = frozen(folder, BIG)
    one, code = TimingParticipant.enrol(study)
    one.close()
    hatchery = Hatchery("tests.study.timing.test_participant_killed")
    acknowledged, lives = dict[tuple[int, int], float](), 0
    while True:
        lives += 1
        after, after_s = rng.randrange(most), rng.uniform(0.0, longest_s)
        said = hatchery.killed(folder, one.person, code, after=after, after_s=after_s)
        for line in said:
            if line != "done":
                number, round_, key_s = line.split()
                acknowledged[int(number), int(round_)] = float(key_s)
        there = kept_rounds(folder, one.person)
        assert acknowledged.items() <= there.items()
        # a press that was on its way to the disk may be there as well, and no more
        assert len(there) - len(acknowledged) <= lives
        if "done" in said:
            break
    hatchery.close()
    assert len(there) == study.plan.trials * study.plan.presses
    assert attended(folder).verify(passphrase=PASSPHRASE) == ()
    assert attended(folder).person(one.person).state == "finished"
    return lives


def test_a_killed_session_keeps_every_press_it_acknowledged(tmp_path: Path) -> None:
    assert check_kills(tmp_path / "study", 1, 0.1, 120) >= 4


@pytest.mark.slow
def test_no_press_is_lost_at_many_random_moments(tmp_path: Path) -> None:
    """The wait before each end is short, or a quick machine is done with its presses after few of them."""
    assert check_kills(tmp_path / "study", 2, 0.01, 12) >= 25
