"""The studies of a project: their folders, their keys while sessions are open, what renders them."""

from __future__ import annotations

import re
import secrets
from collections.abc import Callable, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from threading import RLock
from typing import Any, Literal

from msgspec import Struct

from fdvv.errors import InputError
from fdvv.io.files import write_atomic
from fdvv.io.memory import hide_memory
from fdvv_people.pages.screens import Screens
from fdvv_people.study.admin.study import Study
from fdvv_people.study.files.people import EVERYBODY
from fdvv_people.study.files.run_key import CLOSED, OPEN_FIRST, RunKey
from fdvv_people.study.files.seal import Cost
from fdvv_people.study.kind import StudyKind
from fdvv_people.study.plan.plan_file import STUDY_FILE
from fdvv_studio.studio.contract import Message, Watchers
from fdvv_studio.studio.devices import require_listed
from fdvv_studio.studio.seats import FOLDER, Seats
from fdvv_studio.studio.studio import Studio

DEVICE_SUFFIX = ".device"
TWIN = "twin"
TRIED = "try."
"""Before the name of a study that is tried: no study that is kept can be called so."""
QUICK = Cost(1, 8192)
"""Of a passphrase that nobody knows."""
NAME = re.compile(r"[a-z0-9][a-z0-9-]{0,39}")

StudyState = Literal["draft", "frozen", "unsealed", "broken"]


class StudiesChanged(Message, tag="changed"):
    """A study is not what it was."""

    study: str


class Studies:
    """The studies in ``studies/NAME`` of a project.

    screens : those that serve their participants. seats : words that open one.
    """

    def __init__(self, studio: Studio) -> None:
        self.folder = studio.project / FOLDER
        self.watchers = Watchers[Struct]()
        self.screens = Screens(self.announce)
        self.seats = studio.part(Seats)
        self._run_keys: dict[str, RunKey] = {}
        self._tried: dict[str, TemporaryDirectory[str]] = {}
        self._waiting_for_key: dict[str, list[Callable[[], None]]] = {}
        # held briefly only: the thread of a screen may take it
        self._lock = RLock()

    def names(self) -> list[str]:
        if not self.folder.is_dir():
            return []
        return sorted(path.name for path in self.folder.iterdir() if NAME.fullmatch(path.name))

    def path(self, name: str) -> Path:
        """Return the folder of a study, which need not exist. InputError on an invalid name."""
        if tried := self._tried.get(name):
            return Path(tried.name) / name
        if not NAME.fullmatch(name):
            remedy = "use small letters, digits and hyphens, 40 at most"
            raise InputError("study", "name", f"{name!r:.60} is no name of a study", remedy)
        return self.folder / name

    def rehearse(self, name: str) -> str:
        """Make a seat in a copy of a study's plan that is frozen for this, and forgotten with the studio.

        Nothing of it comes to the study; its name is TRIED and the study's. InputError on problems of it.
        """
        tried, study = f"{TRIED}{name}", self.study(name)
        text = (study.folder / STUDY_FILE).read_text(encoding="utf-8")
        folder = TemporaryDirectory(prefix="fdvv-try-")
        try:
            copy = Study.declare_text(Path(folder.name) / tried, text, study.folder)
            copy.freeze(secrets.token_urlsafe(), QUICK)
        except BaseException:
            folder.cleanup()
            raise
        with self._lock:
            screens = self.screens.of(tried)
            self._tried[tried], before = folder, self._tried.get(tried)
            self._run_keys.pop(tried, None)
        for screen in screens.values():
            screen.leave("it is tried elsewhere")
        if before:
            before.cleanup()
        self.seats.unkept.add(tried)
        self._keep_key(tried, copy)
        return self.seats.make(tried)

    def study(self, name: str, kind: StudyKind[Any] | None = None) -> Study:
        """Open a study, with its run key while its sessions are open. InputError, also on another kind."""
        study = Study.open(self.path(name))
        if kind and study.kind is not kind:
            raise InputError("study", name, f"is {study.kind.described}", "open its own screens")
        study.run_key = self._run_keys.get(name)
        return study

    def freeze(self, name: str, passphrase: str) -> None:
        """Freeze a study; its sessions are open then. InputError, OSError."""
        study = self.study(name)
        study.freeze(passphrase)
        self._keep_key(name, study)

    def open_sessions(self, name: str, passphrase: str, keeper: bytes | None) -> None:
        """Let sessions run until this studio ends. keeper : keeper.json, if it was moved.

        InputError, OSError.
        """
        study = self.study(name)
        study.open_sessions(passphrase, keeper)
        self._keep_key(name, study)

    def _keep_key(self, name: str, study: Study) -> None:
        assert study.run_key is not None
        hide_memory()
        with self._lock:
            before = self._run_keys.get(name)
            # opened a second time, it must not forget how much was counted
            if before is None or before.seal != study.run_key.seal:
                self._run_keys[name] = study.run_key
            waiting = self._waiting_for_key.pop(name, [])
        self.announce(name)
        for go_on in waiting:
            go_on()

    def when_open(self, name: str, go_on: Callable[[], None]) -> None:
        """Call a function once the sessions of a study are open."""
        with self._lock:
            there = name in self._run_keys
            if not there:
                self._waiting_for_key.setdefault(name, []).append(go_on)
        if there:
            go_on()

    def device(self, name: str) -> str:
        """Return what renders a study: the twin, or a device by its `fdvv.device` name."""
        path = self.path(name).with_suffix(DEVICE_SUFFIX)
        return path.read_text(encoding="utf-8").strip() if path.is_file() else TWIN

    def use_device(self, name: str, device: str, known: Sequence[str]) -> None:
        """Have a study rendered by another device of those that are known, from the next trial on.

        InputError on one that is not there, or that cannot hide a change between the study's buttons.
        """
        study = self.study(name)
        require_listed("device", device, (TWIN, *known), "choose one of the list")
        problems = study.kind.device_problems(study.plan, study.folder, device) if device != TWIN else ()
        for problem in problems:
            raise InputError("device", device, problem, "use the twin, or change the plan")
        write_atomic(self.path(name).with_suffix(DEVICE_SUFFIX), f"{device}\n")
        self.announce(name)

    def invite(self, name: str) -> str:
        """Make a seat for one person; return the word that opens it. InputError where nobody can begin."""
        study = self.study(name)
        state = state_of(study)
        if state == "draft":
            raise InputError("study", name, "is not frozen", "freeze it before the first person")
        if state == "unsealed":
            raise InputError("study", name, "was unsealed, nobody can begin it any more", "declare a new one")
        if study.needs_run_key and not study.sessions_open:
            raise InputError("study", "sessions", CLOSED, OPEN_FIRST)
        word = self.seats.make(name)
        self.announce(name)
        return word

    def pause(self, name: str, person: str | None, on: bool) -> None:
        """Pause or continue all screens of a study, or one; kept with the study. InputError."""
        self.study(name).pause(person or EVERYBODY, on)
        for who, screen in self.screens.of(name).items():
            screen.pause(self.paused(name, who))
        self.announce(name)

    def paused(self, name: str, person: str | None = None) -> bool:
        """Return whether a study, or one person of it, is paused."""
        return not self.study(name).paused.isdisjoint({EVERYBODY, person or EVERYBODY})

    def withdraw(self, name: str, person: str, delete: bool) -> None:
        """Take a person out of a study, wherever they are. InputError."""
        screen = self.screens.find(name, person)
        if screen:
            screen.withdraw(delete)
        else:
            self.study(name).withdraw(person, delete=delete)
        self.announce(name)

    def announce(self, name: str) -> None:
        self.watchers.tell(StudiesChanged(name))

    def close(self) -> None:
        """End every session in order."""
        self.screens.end("the studio was closed")
        for folder in self._tried.values():
            folder.cleanup()


def state_of(study: Study) -> StudyState:
    if study.frozen is None:
        return "draft"
    return "unsealed" if any("unsealed" in record for record in study.history()) else "frozen"
