"""The screens that serve participants at this moment: one for each person of a study."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock, RLock
from typing import Protocol

from fdvv.errors import InputError

PATIENCE_s = 10.0  # assumed: above the 4 s in which a rig is identified; a participant waits meanwhile


class ParticipantScreen(Protocol):
    """A participant's screen as the operator has it."""

    def pause(self, on: bool) -> None: ...
    def leave(self, reason: str) -> None:
        """End the session at this screen with a reason."""

    def withdraw(self, delete: bool) -> None: ...


class Screens:
    """Which screen serves whom. announce : called with the name of a study that has one more or one less."""

    def __init__(self, announce: Callable[[str], None]) -> None:
        self._announce = announce
        self._screens: dict[tuple[str, str], ParticipantScreen] = {}
        self._person_locks: dict[tuple[str, str], Lock] = {}
        # held briefly only: the thread of a screen may take it
        self._lock = RLock()

    def attach(self, name: str, person: str, screen: ParticipantScreen) -> None:
        """Register a person's screen and end the session at an earlier one."""
        with self._lock:
            before = self._screens.pop((name, person), None)
            self._screens[name, person] = screen
        if before:
            before.leave("this study continues at another screen")
        self._announce(name)

    def detach(self, name: str, person: str, screen: ParticipantScreen) -> None:
        """Note that a screen serves a person no more."""
        with self._lock:
            if self._screens.get((name, person)) is screen:
                del self._screens[name, person]
        self._announce(name)

    @contextmanager
    def exclusive(self, name: str, person: str) -> Iterator[None]:
        """Take a person up alone: a page that is gone may still be at it when they come back on another.

        InputError where that takes too long.
        """
        with self._lock:
            lock = self._person_locks.setdefault((name, person), Lock())
        if not lock.acquire(timeout=PATIENCE_s):
            raise InputError("study", "screen", "is taken up elsewhere at this moment", "try again")
        try:
            yield
        finally:
            lock.release()

    def find(self, name: str, person: str) -> ParticipantScreen | None:
        with self._lock:
            return self._screens.get((name, person))

    def of(self, name: str) -> dict[str, ParticipantScreen]:
        """Return the screens of a study, by person."""
        with self._lock:
            return {person: screen for (study, person), screen in self._screens.items() if study == name}

    def end(self, reason: str) -> None:
        """End the session at every screen."""
        with self._lock:
            screens = list(self._screens.values())
        for screen in screens:
            screen.leave(reason)
