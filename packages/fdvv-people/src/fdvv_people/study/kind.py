"""The kinds of studies: all that is a kind's own in one record, which is found by what its plans declare."""

from __future__ import annotations

import importlib
import tomllib
from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any, ClassVar, Generic, NamedTuple, TypeVar

from msgspec import Struct

from fdvv.errors import InputError
from fdvv_people.study.plan.plan_file import STUDY_FILE, read_declared, template_names
from fdvv_people.study.plan.sitting import SittingState

if TYPE_CHECKING:
    from fdvv.report.report import Section
    from fdvv_people.study.admin.progress import PersonProgress
    from fdvv_people.study.admin.study import Study
    from fdvv_people.study.files.opened import OpenedPerson
    from fdvv_people.study.files.people import Person, Schedule
    from fdvv_people.study.plan.events import SessionEvent
    from fdvv_people.study.plan.trial import StudyTrial
    from fdvv_people.study.simulation.sessions import SimulatedPerson, SimulatedSession, Simulation

P = TypeVar("P", bound=Struct)
MODULES = {"fdvv-study": "fdvv_people.study.labels", "fdvv-timing": "fdvv_people.study.timing.kind"}
"""Where the record of each kind is, as KIND, by the format of its plans; the first is the default."""


class Account(NamedTuple):
    """What a plan comes to. problems : for which it cannot be run. notes : what may not be meant.

    text : in a line, empty where there are problems; so are sections, of which a page shows it.
    """

    problems: tuple[str, ...]
    notes: tuple[str, ...] = ()
    text: str = ""
    sections: Sequence[Section] = ()


class Refusal(NamedTuple):
    """Why a command is not for a kind. place : that the error names."""

    place: str
    reason: str
    remedy: str


class StudyKind(ABC, Generic[P]):
    """A kind of study: its plans, trials and people, and what is found of them.

    Attributes
    ----------
    format, plan : the word that plans declare, and what they are read as.
    described : what its studies are, after "is". gave : what its people leave, as a subordinate clause.
    proxy_data : what simulated ones leave. unsealed : which trials are unsealed, where not all are.
    feels : its people compare what is rendered, whether a simulated one presses it or not.
    state : of a session. refusals : by command.
    """

    format: ClassVar[str]
    plan: type[P]
    described: ClassVar[str]
    gave: ClassVar[str]
    proxy_data: ClassVar[str]
    unsealed: ClassVar[str] = ""
    feels: ClassVar[bool] = False
    state: ClassVar[type[SittingState[Any]]]
    refusals: ClassVar[Mapping[str, Refusal]] = {}

    @property
    def templates(self) -> tuple[str, ...]:
        """The names of shipped plans."""
        return template_names(self.format)

    def read_plan(self, text: str | bytes, source: object) -> P:
        """Read the text of a plan, unchecked. InputError, see `read_declared`."""
        return read_declared(text, source, self.plan, self.format)

    def require(self, command: str, path: Path) -> None:
        """Raise InputError on a command that the kind has no use for. path : of the study."""
        if refusal := self.refusals.get(command):
            raise InputError(path, *refusal)

    @abstractmethod
    def problems(self, plan: P) -> tuple[str, ...]:
        """List what is wrong with a plan alone, each as "place: reason"."""

    @abstractmethod
    def unfit(self, plan: P, folder: Path) -> Iterable[str]:
        """List what a plan without problems names and nothing can render. folder : of the study."""

    @abstractmethod
    def account(self, plan: P, folder: Path) -> Account:
        """Return what a plan comes to, with all that it names. folder : of the study, where its files are."""

    @abstractmethod
    def device_problems(self, plan: P, folder: Path, device: str) -> Iterable[str]:
        """List why a device cannot render a study."""

    @abstractmethod
    def draw(self, study: Study, place: int, simulated: bool) -> tuple[StudyTrial, ...]:
        """Draw the trials of a person at a place in a study, 0, 1, ... **Secret.**"""

    @abstractmethod
    def start(self, study: Study, person: Person, schedule: Schedule, at_s: float) -> SessionEvent:
        """Return the event with which a person's session begins, with all of the trials that may be seen."""

    @abstractmethod
    def progress(self, about: PersonProgress, state: Any, now_s: float) -> PersonProgress:
        """Return how far a person is. about : without the state of their session; None: it is not known."""

    def promise(self, plan: P) -> str:
        """Return what a plan promises to find, as the end of a sentence; empty where that is not known."""
        del plan
        return ""

    @abstractmethod
    def at_it(self, people: Sequence[PersonProgress], done: int) -> str:
        """Return who is at it, as the end of a sentence. done : how many are done."""

    @abstractmethod
    def verdict(self, study: Study) -> tuple[str, bool | None] | None:
        """Return what became of the claim of an unsealed study, and whether it holds; None without one.

        InputError.
        """

    @abstractmethod
    def unseal(self, plan: P, people: Sequence[OpenedPerson], folder: Path) -> Any:
        """Join what people did with what was hidden, and write it into a folder.

        What it returns says whether its people are `simulated`, and the `reasons` for which rows do not
        count, empty of those that do. InputError, OSError.
        """

    @abstractmethod
    def draw_simulated(self, study: Study, number: int, simulation: Simulation) -> SimulatedPerson:
        """Return a simulated participant. number : 0, 1, ... of those of the study."""

    @abstractmethod
    def session_row(self, session: SimulatedSession) -> Mapping[str, object]:
        """Return what a simulated participant did, by what a table calls it."""

    @abstractmethod
    def report(self, study: Study, origin: str) -> str:
        """Return the report of an unsealed study as a page. origin : of what. InputError, BuildError."""


def kind_of(path: Path) -> StudyKind[Any]:
    """Return the kind of study that a folder, or a file, declares; the first of what cannot be read."""
    file = path / STUDY_FILE if path.is_dir() else path
    try:
        return kind_of_text(file.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return kind_of_text("")


def kind_of_text(text: str) -> StudyKind[Any]:
    """Return the kind of study that the text of a plan declares; the first of what cannot be read."""
    try:
        format_ = tomllib.loads(text.removeprefix("\ufeff")).get("format")
    except ValueError:
        format_ = None
    module = MODULES.get(format_, "") if isinstance(format_, str) else ""
    kind: StudyKind[Any] = importlib.import_module(module or MODULES["fdvv-study"]).KIND
    return kind


def all_kinds() -> Iterator[StudyKind[Any]]:
    """Yield every kind."""
    for module in MODULES.values():
        yield importlib.import_module(module).KIND
