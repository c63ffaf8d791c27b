"""Seats of studies: words that open one participant's screen, and nothing else of the studio.

They are kept beside the studies, as digests, so that invitations that were prepared outlive the studio.
"""

from __future__ import annotations

import hashlib
import logging
import secrets
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock, RLock
from typing import Literal

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty, read_record
from fdvv.io.files import write_atomic
from fdvv_studio.studio.studio import Studio

log = logging.getLogger("fdvv_studio.studio")
FOLDER, SUFFIX = "studies", ".seats"
LARGEST_bytes = 4_000_000  # a seat takes some 250 bytes: sixteen for each of 1000 people, the most of a plan
SEATS = Kind("fdvv-seats", 1, "the seats of a study", "delete it: invitations are made anew")


class Seat(Struct, frozen=True, forbid_unknown_fields=True):
    """A seat.

    Attributes
    ----------
    word : SHA-256 of the word that opens it. holder : SHA-256 of the word of the page that took it, or empty.
    person : who sits there, or empty. settled : their screen knows the code: nobody takes the seat any more.
    """

    word: str
    holder: str = ""
    person: str = ""
    settled: bool = False

    @property
    def free(self) -> bool:
        return not (self.holder or self.person)


@dataclass(eq=False)
class Invitation:
    """A seat that is taken at this moment. person, code : whose it is until their screen knows."""

    study: str
    word: str
    person: str = ""
    code: str = ""
    lock: Lock = field(default_factory=Lock)


class SeatsFile(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """Content of the file of a study's seats."""

    format: Literal["fdvv-seats"] = "fdvv-seats"
    version: Literal[1] = 1
    seats: tuple[Seat, ...]


def digest_of(word: str) -> str:
    """Return what is kept of a word; empty of none."""
    return hashlib.sha256(word.encode()).hexdigest() if word else ""


class Seats:
    """The seats of all studies of a project.

    Attributes
    ----------
    unkept : studies whose seats are in memory only: those that are tried.
    """

    def __init__(self, studio: Studio) -> None:
        self._folder = studio.project / FOLDER
        self._lock = RLock()
        self._seats: dict[str, tuple[str, Seat]] = {}
        self._invitations: dict[str, Invitation] = {}
        self.unkept: set[str] = set()
        for path in sorted(self._folder.glob(f"*{SUFFIX}")):
            try:
                seats = read_record(path, SEATS, SeatsFile, LARGEST_bytes).seats
            except InputError as error:
                log.warning("%s", error)  # invitations are made anew; nobody's answers are in it
                continue
            self._seats |= {seat.word: (path.stem, seat) for seat in seats}

    def make(self, study: str) -> str:
        """Make a free seat; return its word, which is kept nowhere. OSError."""
        word = secrets.token_urlsafe(18)
        self._keep(study, Seat(digest_of(word)))
        return word

    def find(self, word: str) -> tuple[str, Seat] | None:
        """Return the study of a word and its seat; None of a word that opens nothing."""
        with self._lock:
            return self._seats.get(digest_of(word)) if word else None

    def of(self, study: str) -> list[Seat]:
        with self._lock:
            return [seat for name, seat in self._seats.values() if name == study]

    def invitation(self, name: str, word: str, holder: str) -> Invitation | None:
        """Find an invitation that a page may take: a free one, or its own."""
        study, seat = self.find(word) or ("", None)
        if seat is None or study != name or seat.settled or seat.holder not in ("", digest_of(holder)):
            return None
        with self._lock:
            return self._invitations.setdefault(word, Invitation(name, word, seat.person))

    def take(self, invitation: Invitation, person: str, code: str, holder: str) -> None:
        """Note who sits on a seat, and which page took it. OSError."""
        invitation.person, invitation.code = person, code
        self._change(invitation.word, person=person, holder=digest_of(holder))

    def settle(self, word: str, person: str) -> None:
        """Note that nobody else takes a seat, and forget the code: its person's screen knows. OSError."""
        with self._lock:
            self._invitations.pop(word, None)
        self._change(word, person=person, settled=True)

    def waiting(self, name: str) -> int:
        return sum(seat.free for seat in self.of(name))

    def _change(self, word: str, **changes: str | bool) -> None:
        """Change what is known of a seat; nothing where there is none. OSError."""
        with self._lock:
            pair = self.find(word)
            if pair and (seat := msgspec.structs.replace(pair[1], **changes)) != pair[1]:
                self._keep(pair[0], seat)

    def _keep(self, study: str, seat: Seat) -> None:
        with self._lock:
            before = {other.word: other for other in self.of(study)}
            kept = SeatsFile(seats=(*({**before, seat.word: seat}).values(),))
            if study not in self.unkept:
                write_atomic(self._path(study), pretty(msgspec.to_builtins(kept)) + "\n", private=True)
            self._seats[seat.word] = study, seat

    def _path(self, study: str) -> Path:
        return self._folder / f"{study}{SUFFIX}"
