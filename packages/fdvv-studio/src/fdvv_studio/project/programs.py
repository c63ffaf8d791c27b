"""The programs of a project: the shipped ones, and the person's own, which are files."""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterable
from dataclasses import dataclass, replace
from functools import cache
from itertools import count
from pathlib import Path
from threading import Lock

from fdvv.errors import InputError
from fdvv.io.files import read_limited, sync_folder, write_atomic
from fdvv.program.file import PROGRAM_SUFFIX, program_from_json, program_to_json
from fdvv.program.library import load_shipped, programs
from fdvv.program.program import Program

FOLDER = "programs"
"""Folder of a project that holds the person's own programs."""
TRASH = "trash"
"""Folder in it that holds what was deleted."""
LARGEST_bytes = 2_000_000
"""Of a program's file: far above what a device holds (7 kB as an image), small enough to check at once."""
NAME = re.compile(r"[A-Za-z0-9](?:[A-Za-z0-9 ._-]{0,38}[A-Za-z0-9_-])?")
MOST_COPIES = 1000  # three digits: with a stem of 34 letters and a blank they stay within NAME's 40


@dataclass(frozen=True)
class ProgramEntry:
    """A program to choose: its id, its name, what it does, how large it is.

    Attributes
    ----------
    id : ``shipped:NAME`` or ``own:NAME``.
    states, transitions : how many.
    problem : why a file of the person's cannot be read, in one line; else empty.
    """

    id: str
    name: str
    summary: str
    states: int = 0
    transitions: int = 0
    problem: str = ""


@dataclass(frozen=True)
class KeptProgram:
    """A program as it is kept: its id (`program`), the text of its file, and which text of that file it is.

    revision : changes with every change of the file; empty for a shipped program.
    """

    program: str
    text: str
    revision: str


class ProgramCatalog:
    """Shipped programs and the person's own ones in ``<project>/programs``.

    Ids are looked up among what is there; only a new name becomes part of a path, and only one that `NAME`
    allows. Every method raises InputError in a person's words, and may be called from any thread.
    """

    def __init__(self, project: Path) -> None:
        self.folder = project / FOLDER
        self._lock = Lock()

    def entries(self) -> tuple[ProgramEntry, ...]:
        """List the shipped programs, then the person's own; a broken file is listed with its problem."""
        return (*_builtin_entries(), *(self._own_entry(name) for name in self._own()))

    def open(self, program_id: str) -> KeptProgram:
        program, revision = self._open_text(program_id)
        return KeptProgram(program_id, program_to_json(program), revision)

    def program(self, program_id: str) -> Program:
        return self._open_text(program_id)[0]

    def save(self, program_id: str, text: str, revision: str = "") -> KeptProgram:
        """Write a program of the person's, whole or not at all.

        revision : of the file that was opened; empty for a new one. If the file is another by now, nothing
        is written: who opened the program in two places loses neither.
        """
        name = _own_name(program_id)
        program = read_program(text)
        with self._lock:
            held = self._own().get(name)
            if held is None:
                self._check_free(name)
            self._check_revision(program_id, held, revision)
            content = program_to_json(program)
            path = held or self.folder / (name + PROGRAM_SUFFIX)
            write_atomic(path, content)
            sync_folder(path.parent)
        return KeptProgram(program_id, content, _revision(content.encode()))

    def copy(self, program_id: str, name: str = "") -> KeptProgram:
        """Copy a program under a new name; without one, the next free name after its own."""
        program = self.program(program_id)
        chosen = name or self.free_name(program.name)
        return self.save(f"own:{chosen}", program_to_json(replace(program, name=chosen)))

    def free_name(self, like: str) -> str:
        """Return a free name: the wanted one, or it with a number."""
        stem = re.sub(r"[^A-Za-z0-9 ._-]", "-", like).strip(" ._-")[:34].strip(" ._-") or "program"
        taken = {name.casefold() for name in self._own()}
        for number in range(1, MOST_COPIES):
            name = stem if number == 1 else f"{stem} {number}"
            if name.casefold() not in taken:
                return name
        raise InputError("studio", "name", f"there are {MOST_COPIES} programs like {stem!r}", "name it anew")

    def delete(self, program_id: str, revision: str) -> str:
        """Move a program of the person's to the trash; give the name under which it lies there."""
        with self._lock:
            held = self._own().get(_own_name(program_id))
            if held is None:
                raise InputError("studio", program_id, "no such program", "look in the list again")
            self._check_revision(program_id, held, revision)
            trash = self.folder / TRASH
            trash.mkdir(parents=True, exist_ok=True)
            stem = held.name.removesuffix(PROGRAM_SUFFIX)
            numbered = (f"{stem}~{i}" for i in count(1))
            thrown = next(name for name in numbered if not (trash / (name + PROGRAM_SUFFIX)).exists())
            held.rename(trash / (thrown + PROGRAM_SUFFIX))
            sync_folder(self.folder)
        return thrown

    def restore(self, thrown: str) -> KeptProgram:
        """Take a program out of the trash, under its old name or the next free one."""
        with self._lock:
            trash = _by_name((self.folder / TRASH).glob(f"*{PROGRAM_SUFFIX}"))
            if thrown not in trash:
                raise InputError("studio", thrown, "not in the trash", "look in the list again")
            name = self.free_name(thrown.rpartition("~")[0])
            trash[thrown].rename(self.folder / (name + PROGRAM_SUFFIX))
            sync_folder(self.folder)
        return self.open(f"own:{name}")

    # -- files ---------------------------------------------------------------------------------------------

    def _own(self) -> dict[str, Path]:
        paths = sorted(self.folder.glob(f"*{PROGRAM_SUFFIX}")) if self.folder.is_dir() else []
        return _by_name(path for path in paths if not path.name.startswith("."))

    def _open_text(self, program_id: str) -> tuple[Program, str]:
        """Read a program, and which text of its file it is."""
        kind, _, name = program_id.partition(":")
        if kind == "shipped":
            return load_shipped(name), ""
        data = self._read(program_id)
        return program_from_json(data, program_id), _revision(data)

    def _own_entry(self, name: str) -> ProgramEntry:
        program_id = f"own:{name}"
        try:
            program = program_from_json(self._read(program_id), program_id)
        except InputError as error:
            return ProgramEntry(program_id, name, "", problem=f"{error.place}: {error.reason}")
        return replace(_entry(program_id, program, program.description), name=name)

    def _read(self, program_id: str) -> bytes:
        kind, _, name = program_id.partition(":")
        path = self._own().get(name) if kind == "own" else None
        if path is None:
            raise InputError("studio", program_id, "no such program", "choose one from the list")
        return read_limited(path, LARGEST_bytes, "take a smaller program")

    def _check_free(self, name: str) -> None:
        """Refuse a new name that some file system would take for one that is there."""
        alike = [held for held in self._own() if held.casefold() == name.casefold()]
        if alike:
            raise InputError("studio", "name", f"there is a program {alike[0]!r}", "choose another name")

    def _check_revision(self, program_id: str, held: Path | None, revision: str) -> None:
        if held is None and revision:
            raise InputError("studio", program_id, "it is no longer there", "save it under another name")
        if held and revision != _revision(read_limited(held, LARGEST_bytes, "move the file away")):
            reason = "it was changed elsewhere since it was opened" if revision else "that name is taken"
            raise InputError("studio", program_id, reason, "save it under another name, or open it again")


def _by_name(paths: Iterable[Path]) -> dict[str, Path]:
    return {path.name.removesuffix(PROGRAM_SUFFIX): path for path in paths}


def read_program(text: str, source: str = "program") -> Program:
    """Read the text of a program that came from elsewhere, within the size that is kept."""
    size_bytes = len(text.encode(errors="surrogatepass"))
    if size_bytes > LARGEST_bytes:
        reason = f"{size_bytes / 1e6:.1f} MB, a program has at most {LARGEST_bytes / 1e6:g} MB"
        raise InputError(source, "whole file", reason, "use fewer points or fewer velocities")
    return program_from_json(text, source)


@cache
def _builtin_entries() -> tuple[ProgramEntry, ...]:
    return tuple(_entry(f"shipped:{row.name}", load_shipped(row.name), row.summary) for row in programs())


def _entry(program_id: str, program: Program, summary: str) -> ProgramEntry:
    transitions = sum(len(state.transitions) for state in program.states)
    return ProgramEntry(program_id, program.name, summary, len(program.states), transitions)


def _own_name(program_id: str) -> str:
    kind, _, name = program_id.partition(":")
    if kind != "own":
        raise InputError("studio", program_id, "shipped programs stay as they are", "copy it first")
    if not NAME.fullmatch(name):
        reason = f"{name!r:.60} is no name for a file"
        raise InputError("studio", "name", reason, "use 1 to 40 letters, digits, spaces or . _ -")
    return name


def _revision(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()[:16]
