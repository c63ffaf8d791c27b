"""Studio or page are killed at any moment of whole studies: no answer is lost, no trial is met again."""

from __future__ import annotations

import random
import socket
from collections import Counter
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest

from fdvv_people.study.admin.study import Study
from tests.browser.study_screens import plan_text
from tests.pages.study_lives import GONE, HOST, PASSPHRASE, Hatchery, Killer, Taker, Words
from tests.support.campaign import campaign
from tests.support.study_witness import Witness, check_labels

TEXT = plan_text(2, 2, reference=True, pages=True, switch_s=0.0, break_every_min=0.01, break_min=0.002)
MOST_SAID = 40
"""A studio or page is killed after at most so many things were asked or reported: a trial takes a dozen."""


@pytest.fixture
def port() -> int:
    """A free port; a studio that comes again takes it again."""
    with socket.socket() as free:
        free.bind((HOST, 0))
        return int(free.getsockname()[1])


@pytest.fixture
def studios() -> Iterator[Hatchery]:
    """What starts studios."""
    hatchery = Hatchery("studio")
    yield hatchery
    hatchery.close()


@pytest.fixture
def people() -> Iterator[Hatchery]:
    """What starts people's pages."""
    hatchery = Hatchery("person")
    yield hatchery
    hatchery.close()


class Project:
    """A project whose studies are run one after the other, each by so many people.

    Attributes
    ----------
    moments : what was asked for last when something was killed, and how often. answers : over all studies.
    """

    def __init__(self, folder: Path, people: int = 2) -> None:
        self.folder, self._people = folder, people
        self.moments, self.answers, self.studies = Counter[str](), 0, 0
        self._begin()

    @property
    def name(self) -> str:
        """Get the study that is run now."""
        return f"s{self.studies}"

    @property
    def study(self) -> Study:
        """Get it."""
        return Study(self.folder / "studies" / self.name)

    def _begin(self) -> None:
        self.witness, self.fingerprint, self._lives = Witness(self.study), "", 0

    def hear(self, words: Words) -> None:
        """Note what is reported."""
        if words[0] == "does":
            self.doing = words[1]
        elif words[0] == "frozen":
            self.fingerprint = words[1]
        else:
            self.witness.hear(words)

    def killed(self) -> None:
        """Note that something was killed."""
        self.moments[self.doing] += 1
        self._lives += 1

    def check(self) -> None:
        """Compare what was reported with what is on disk."""
        if self.fingerprint:
            assert self.study.fingerprint == self.fingerprint
        if self.witness.person:
            self.witness.check(self._lives)
        self._lives = 0

    def end_study(self) -> None:
        """Go on to the next study where enough people are done with this one."""
        if len(self.witness.done) >= self._people:
            assert self.study.verify(self.fingerprint, PASSPHRASE) == ()
            check_labels(self.study, self.witness, PASSPHRASE)
            self.answers += len(self.witness.answers)
            self.studies += 1
            self._begin()


def moments(seed: int, project: Project, kinds: int) -> Iterator[tuple[int, float]]:
    """Draw 32 moments, and up to 64 more until kills fell into so many kinds of work.

    A moment is so long after so many things. Some requests take 0.1 ms and others 0.1 s.
    """
    draw = random.Random(seed)
    for kill in range(96):
        if kill >= 32 and len(project.moments) >= kinds:
            return
        yield draw.randint(0, MOST_SAID), 10.0 ** draw.uniform(-4.0, -1.0)


def kill_studio(project: Project, studios: Hatchery, port: int, after: int, after_s: float) -> None:
    """Run studies at a studio until it is killed, ``after_s`` after ``after`` things were reported."""
    pid, address = studios.ask(project.folder, port)
    killer = Killer(int(pid), after, after_s)

    def hear(words: Words) -> None:
        project.hear(words)
        killer.count()

    taker = Taker(address, hear, TEXT)
    project.doing = "nothing"
    try:
        while True:
            taker.prepare(project.name)
            taker.take_part(project.name, project.witness.person, project.witness.code)
            project.end_study()
    except GONE:
        killer.wait()
    assert studios.ask("wait", pid) == ["-9"]
    project.killed()
    project.check()


@pytest.mark.slow
@campaign("seed", range(8), part=1)
def test_no_answer_is_lost_when_the_studio_is_killed_at_256_random_moments(
    tmp_path: Path, studios: Hatchery, port: int, seed: int, record_property: Callable[[str, object], None]
) -> None:
    project = Project(tmp_path)
    for moment in moments(seed, project, kinds=6):
        kill_studio(project, studios, port, *moment)
    record(project, record_property)
    assert len(project.moments) >= 6


@pytest.mark.slow
@campaign("seed", range(8), part=1)
def test_no_answer_is_lost_when_the_page_is_killed_at_256_random_moments(
    tmp_path: Path,
    studios: Hatchery,
    people: Hatchery,
    port: int,
    seed: int,
    record_property: Callable[[str, object], None],
) -> None:
    """The page is a process that speaks as the real one; half of the time its person is back at once."""
    project, hasty = Project(tmp_path), random.Random(seed)
    _, address = studios.ask(tmp_path, port)
    for moment in moments(seed, project, kinds=4):
        leader = Taker(address, project.hear, TEXT)
        leader.prepare(project.name)
        person = (project.witness.person, project.witness.code)
        for line in filter(None, people.ask(*moment, address, project.name, *person)):
            project.hear(line.split())
        project.killed()
        # what the page sent before it was killed may still be under way
        if hasty.random() < 0.5 or project.witness.done:
            leader.wait_for_nobody(project.name)
            project.check()
            project.end_study()
    record(project, record_property)
    assert len(project.moments) >= 4


def record(project: Project, record_property: Callable[[str, object], None]) -> None:
    """Note what was done, and see that it was something."""
    for name in ("moments", "answers", "studies"):
        record_property(name, str(getattr(project, name)))
    assert project.answers > 10
