"""An adversary who holds every file, every message and all codes guesses 1,000 assignments like a coin."""

from __future__ import annotations

import json
from collections.abc import Iterator
from itertools import count
from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv_people.study.admin.progress import study_progress
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.chained_log import read_chained
from fdvv_people.study.files.people import open_schedule
from fdvv_people.study.files.run_key import RunKey
from fdvv_people.study.plan.trial import StudyTrial
from tests.support.studies import in_haste
from tests.support.study_people import PASSPHRASE, StillStage, do_all, enrolled, frozen_study

PEOPLE, SEEN, ROUNDS = 38, 12, 20
"""Of the first people the adversary is shown the truth, to learn from; those of the others are guessed."""


class Finished:
    """A study that everybody has done. codes : of all, which the adversary has read from the cards."""

    def __init__(self, folder: Path) -> None:
        self.study = frozen_study(folder, rounds=ROUNDS, practice=0)
        self.codes: dict[str, str] = {}
        for _ in range(PEOPLE):
            one, code = enrolled(self.study, StillStage(), clock=count(5000.0, 0.25).__next__)
            self.codes[one.person] = code
            do_all(one)
            one.close()
        keeper = self.study.key_holder(PASSPHRASE)
        self.truth = {person: self.study.schedule(person, keeper).trials for person in self.codes}


@pytest.fixture(scope="module")
def finished(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Finished]:
    """Draw schedules from known seeds: else one run in twenty would leave 50 +- 3 % by chance."""
    seeds, made = count(1), np.random.default_rng
    with in_haste(), pytest.MonkeyPatch.context() as patch:
        patch.setattr(np.random, "default_rng", lambda: made(next(seeds)))
        yield Finished(tmp_path_factory.mktemp("adversary") / "study")


def hides(trial: StudyTrial) -> bool:
    return trial.labels["A"] == "FDVV"


class Adversary:
    """Opens what can be opened, else guesses from all that is plain by a fit to the people who were shown."""

    def __init__(self, finished: Finished, run_key: RunKey | None = None) -> None:
        self.folder, self.codes, self.run_key = finished.study.folder, finished.codes, run_key
        people = study_progress(Study.open(self.folder), 9000.0)
        self.views = {one.person: one for one in people}
        shown = list(self.codes)[:SEEN]
        seen = np.vstack([self.plain(person) for person in shown])
        truth = [hides(trial) for person in shown for trial in finished.truth[person]]
        self.fit = np.linalg.lstsq(seen, np.array(truth) - 0.5, rcond=1e-9)[0]

    def guess(self, person: str) -> np.ndarray:
        """Return whether A hides the second stimulus, for every trial of a person."""
        for key in self._keys():
            try:
                path = self.folder / "people" / person / "schedule.json"
                return np.array(
                    [hides(trial) for trial in open_schedule(path, self.codes[person], key).trials]
                )
            except InputError:
                continue
        return np.asarray(self.plain(person) @ self.fit > 0)

    def _keys(self) -> list[RunKey | None]:
        frozen = (self.folder / "frozen.json").read_bytes()
        guessed = [RunKey.of(frozen[:32], ""), RunKey(bytes(32), ""), RunKey.drawn()]
        return [self.run_key, None, *guessed] if self.run_key else [None, *guessed]

    def plain(self, person: str) -> np.ndarray:
        """Return what is plain of every trial: times, choices, presses, ratings, lengths, places."""
        own = self.folder / "people" / person
        sealed = read_chained(own / "sealed.jsonl").records
        answers = [r["answered"] for r in read_chained(own / "session.jsonl").records if "answered" in r]
        rows = [self._row(i, one, len(sealed[i]["sealed"])) for i, one in enumerate(answers)]
        view = self.views[person]
        return np.column_stack([np.array(rows, float), np.full(len(rows), view.resumptions)])

    def _row(self, i: int, one: dict, sealed: int) -> list[float]:  # type: ignore[type-arg]
        text = json.dumps(one)
        answer = one["answer"]
        rated = answer["ratings"]["realism"]
        chosen = [float(answer["choice"] == label) for label in ("A", "B", "equal")]
        pressed = [float(n) for n in answer["presses"].values()]
        first = [t for t, _ in answer["switches"]][:2]
        placed = [1.0, i, i % 2, one["at_s"] % 60, len(text), sealed]
        return [*placed, *chosen, *pressed, *first, *rated.values()]


def right_of(adversary: Adversary, finished: Finished) -> np.ndarray:
    people = list(finished.codes)[SEEN:]
    guesses = np.concatenate([adversary.guess(person) for person in people])
    truth = np.array([hides(trial) for person in people for trial in finished.truth[person]])
    assert truth.size >= 1000
    return np.asarray(guesses == truth)


@pytest.mark.slow
def test_who_has_every_file_every_message_and_all_codes_guesses_like_a_coin(finished: Finished) -> None:
    right = right_of(Adversary(finished), finished)
    assert abs(right.mean() - 0.5) <= 0.03


def test_the_same_adversary_with_the_run_key_knows_every_assignment(finished: Finished) -> None:
    """Else the test above could not fail."""
    assert finished.study.run_key is not None
    assert right_of(Adversary(finished, finished.study.run_key), finished).all()
