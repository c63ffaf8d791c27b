"""A recording that is made: each take is on the disk before the next begins."""

from __future__ import annotations

from dataclasses import asdict, replace
from pathlib import Path
from typing import Self

from fdvv.errors import InputError, ModelError
from fdvv.eventlog import Journal
from fdvv.io.documents import to_plain
from fdvv.recording.file import CUT, Correction, corrected, pack_head, pack_take, read_file
from fdvv.recording.types import Recording, Take

MUST_AGREE = ("name", "bench", "licence", "person", "simulated")


class RecordingLog:
    """A recording on file to which takes are added, by one process at a time.

    Parameters
    ----------
    path : a new file, or one that goes on. Its folder is made.
    about : name, bench, licence, person, sources; its takes, if any, do not count. A file that goes on must
        be of the same button, bench, licence and person.

    Attributes
    ----------
    recording : what is on file so far, those takes among them that were there before.
    warnings : what a person should know of the file that goes on.

    Raises InputError on a file of something else, a damaged one or one in use, OSError if it cannot be
    written.
    """

    def __init__(self, path: Path | str, about: Recording) -> None:
        self.path = Path(path)
        self.warnings: list[str] = []
        self.path.parent.mkdir(parents=True, exist_ok=True)
        busy = "another process is at work on this recording", "wait for it, or name another file"
        self._journal = Journal(self.path, InputError(self.path, "recording", *busy))
        try:
            self.recording = self._opened(replace(about, takes=()))
        except BaseException:
            self.close()
            raise

    def _opened(self, about: Recording) -> Recording:
        there, end, _ = read_file(self.path)
        if there is not None:
            _check(self.path, there, about)
        if self._journal.cut(end):
            self.warnings.append(f"{self.path}: {CUT}; takes kept: {len(there.takes) if there else 0}")
        if there is None:
            self._journal.write({"head": pack_head(about)})
        return there or about

    @property
    def next_number(self) -> int:
        return len(self.recording.takes) + 1

    def add(self, take: Take) -> None:
        """Keep a take; when this returns it is on the disk.

        Raises ModelError if it does not bear next_number or holds what no file can, OSError if it cannot be
        written; the file is then as it was before.
        """
        if take.number != self.next_number:
            raise ModelError(f"the next take bears the number {self.next_number}, got {take.number}")
        record = pack_take(take)
        try:
            self._journal.write({"take": record})
        except ValueError as error:
            raise ModelError(f"take {take.number}: {error}") from error
        self.recording = replace(self.recording, takes=(*self.recording.takes, take))

    def mend(self, mend: Correction, made: str = "") -> None:
        """Correct what may be corrected; the samples stay as they are.

        made : when, as ISO 8601. Raises ModelError if it names what is not there, OSError.
        """
        found = corrected(self.recording, mend)
        self._journal.write({"mend": to_plain(replace(mend, made=made or mend.made))})
        self.recording = found

    def close(self) -> None:
        """Close the file; a second call does nothing."""
        self._journal.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_error: object) -> None:
        self.close()


def _check(path: Path, there: Recording, about: Recording) -> None:
    old, new = asdict(replace(there, takes=())), asdict(about)
    unequal = [key for key in MUST_AGREE if old[key] != new[key]]
    if unequal:
        key = unequal[0]
        reason = f"is another recording: {key} is {old[key]!r:.60} there and {new[key]!r:.60} now"
        raise InputError(path, "recording", reason, "name another file")
