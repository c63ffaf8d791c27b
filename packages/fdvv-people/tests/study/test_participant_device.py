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
from fdvv.errors import DeviceError
from fdvv_people.study.plan.plan import Stimulus
from fdvv_people.study.session.participant import Participant
from fdvv_people.study.stimulus.device import DeviceRenderer
from tests.support.study_people import PASSPHRASE, PLAN, answer_of, enrolled, frozen_study

pytestmark = pytest.mark.usefixtures("hasty_disk")

ONE_BUTTON = PLAN[: PLAN.rindex("[[items]]")] + PLAN[PLAN.index("[[ratings]]") :]


class KilledStage(DeviceRenderer):
    """A device whose process is killed at some moment, in the middle of whatever it does then.

    Attributes
    ----------
    prepared : what its trials made ready.
    """

    def __init__(self, folder: Path, after_s: float) -> None:
        self.board = HostBoard()
        super().__init__(LinkedDevice(self.board, SimulatedPerson()), folder, switch_s=0.0)
        self.prepared: list[dict[str, Stimulus]] = []
        self._killer = threading.Timer(after_s, self.board._process.kill)
        self._killer.start()

    def prepare(self, labels: Mapping[str, Stimulus]) -> None:
        self.prepared.append(dict(labels))
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

    now = stage()
    one, _ = enrolled(study, now)
    labels: dict[int, dict[str, Stimulus]] = {}
    answered: list[tuple[int, str]] = []
    while (step := one.step()).kind != "done":
        assert step.number not in [number for number, _ in answered]
        try:
            one.show_trial(step.number)
            assert labels.setdefault(step.number, now.prepared[-1]) == now.prepared[-1]
            for label in step.trial.labels:
                one.go_to(label)
            answer = answer_of(one.state.started.trials[step.number], one.state.attempts[step.number])
            one.answer(step.number, answer)
            answered.append((step.number, answer.choice))
        except DeviceError:
            one.reconnect(now := stage())
    assert [(number, event.answer.choice) for number, event in one.state.answers.items()] == answered
    assert len(one.state.answers) + len(one.state.skipped) == len(one.state.started.trials)
    one.close()
    assert study.verify(passphrase=PASSPHRASE) == ()
    found = study.unseal(PASSPHRASE, "a test", "to see whether all is there")
    assert sum(found.choice != "") == len([number for number, _ in answered if number > 0])
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
