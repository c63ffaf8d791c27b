"""A timing session whose process is killed at any moment: no press that was acknowledged is lost."""

from __future__ import annotations

import os
import random
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.plan.sitting import ENDS
from fdvv_people.study.timing.events import RoundKept
from fdvv_people.study.timing.participant import TimingParticipant
from fdvv_people.study.timing.plan import DAY_s
from fdvv_people.study.timing.state import TimingState
from tests.support.studies import PASSPHRASE
from tests.support.timing import SMALL, TIMING, Clock, attended, do_step, frozen, late_s

HATCHERY = """
from tests.study.timing.test_participant_killed import hatch
hatch()
"""
ROOT = Path(__file__).resolve().parents[5]
BIG = SMALL.replace("presses = 3", "presses = 20").replace("trials = 2", "trials = 6")
WEEK_LATER = 30 * DAY_s


class LongClock(Clock):
    """The clock of a life: wall time, a month further on once the training is over."""

    def __init__(self) -> None:
        self.ahead_s = 0.0

    def __call__(self) -> float:
        return time.time() + self.ahead_s


def hatch() -> None:
    """Fork a process for every line, kill it, and tell what it had acknowledged.

    It is killed so long after it acknowledged so many presses. All imports are done before.
    """
    import sklearn.gaussian_process  # noqa: F401

    tell("ready")
    for line in sys.stdin:
        folder, person, code, after, after_s = line.rstrip("\n").split("\t")
        output, into = os.pipe()
        child = os.fork()
        if child == 0:
            live(Path(folder), person, code, into)
        os.close(into)
        with os.fdopen(output) as stream:
            said = "".join(stream.readline() for _ in range(int(after)))
            time.sleep(float(after_s))
            os.kill(child, signal.SIGKILL)
            _, status = os.waitpid(child, 0)
            assert os.WTERMSIG(status) == signal.SIGKILL
            tell("\t".join((said + stream.read()).split("\n")[:-1]))


def tell(line: str) -> None:
    sys.stdout.write(f"{line}\n")
    sys.stdout.flush()


def live(folder: Path, person: str, code: str, into: int) -> None:
    """Go on with a session, tell every press that is kept, and wait to be killed."""
    os.fsync = lambda fd: None
    clock = LongClock()
    with TimingParticipant.resume(attended(folder), person, code, clock=clock) as one:
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


class Hatchery:
    """A process that starts lives and ends them."""

    def __init__(self) -> None:
        command = [sys.executable, "-c", HATCHERY]
        self.process = subprocess.Popen(
            command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, cwd=ROOT
        )
        assert self._line() == "ready"

    def _line(self) -> str:
        assert self.process.stdout is not None
        return self.process.stdout.readline().rstrip("\n")

    def killed(self, folder: Path, person: str, code: str, after: int, after_s: float) -> list[str]:
        """Kill a life after so many presses and so long; return what it acknowledged."""
        assert self.process.stdin is not None
        self.process.stdin.write(f"{folder}\t{person}\t{code}\t{after}\t{after_s!r}\n")
        self.process.stdin.flush()
        return [line for line in self._line().split("\t") if line]

    def close(self) -> None:
        self.process.communicate(timeout=30)
        assert self.process.returncode == 0


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
    hatchery, acknowledged, lives = Hatchery(), dict[tuple[int, int], float](), 0
    while True:
        lives += 1
        said = hatchery.killed(folder, one.person, code, rng.randrange(most), rng.uniform(0.0, longest_s))
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
