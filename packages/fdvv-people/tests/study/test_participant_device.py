"""The firmware as a process of its own, killed while people feel labels on it: the session goes on."""

from __future__ import annotations

import random
import threading
from collections.abc import Callable, Mapping
from pathlib import Path

import pytest

from fdvv.device.boards import HostBoard
from fdvv.device.linked import LinkedDevice
from fdvv.device.twin import SimulatedPerson
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.stimulus.device import DeviceRenderer
from tests.study.test_participant_killed import run_through_losses
from tests.support.study_people import PASSPHRASE, PLAN, frozen_study

ONE_BUTTON = PLAN[: PLAN.rindex("[[items]]")] + PLAN[PLAN.index("[[ratings]]") :]


class KilledStage(DeviceRenderer):
    """A device whose process is killed at some moment, in the middle of whatever it does then.

    labels : that its last trial made ready.
    """

    def __init__(self, folder: Path, after_s: float) -> None:
        self.board = HostBoard()
        super().__init__(LinkedDevice(self.board, SimulatedPerson()), folder, switch_s=0.0)
        self.labels: Mapping[str, Stimulus] = {}
        self._killer = threading.Timer(after_s, self.board._process.kill)
        self._killer.start()

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        self.labels = dict(labels)
        super().prepare(labels)

    def close(self) -> None:
        self._killer.cancel()
        super().close()
        self._killer.join()


def run_with_kills(folder: Path, kills: int, seed: int, rounds: int) -> Participant:
    """Run a session on devices that are killed one after the other, the last one excepted."""
    rng = random.Random(seed)
    study = frozen_study(folder, text=ONE_BUTTON, rounds=rounds)
    left = iter(range(kills))

    def stage() -> KilledStage:
        return KilledStage(study.folder, rng.uniform(0.0, 2.0) if next(left, None) is not None else 3600.0)

    one = run_through_losses(study, stage)
    found = study.unseal(PASSPHRASE, "a test", "to see whether all is there")
    assert sum(found.choice != "") == len([number for number in one.state.answers if number > 0])
    return one


@pytest.mark.slow
def test_a_session_survives_the_deaths_of_its_devices(
    tmp_path: Path, record_property: Callable[[str, object], None]
) -> None:
    one = run_with_kills(tmp_path / "study", kills=20, seed=1, rounds=12)
    record_property("interruptions", one.state.interruptions)
    record_property("answers", len(one.state.answers))
    assert one.state.interruptions
    # three deaths in one trial give it up: twenty cost six at most
    assert len(one.state.answers) >= 7
