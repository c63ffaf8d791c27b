"""The folder of a session: begun, gone on with, refused."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import AbstractContextManager, contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

import numpy as np

from fdvv.compensate import Acceptance
from fdvv.device import Device
from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.workflow._answer_log import ANSWERS, AnswerLog
from fdvv.workflow._devices import open_device
from fdvv.workflow._session_file import Run
from fdvv.workflow._session_log import PRESSES, PressLog
from fdvv.workflow._session_manifest import (
    KIND,
    MANIFEST,
    Manifest,
    differences,
    digest,
    manifest_text,
    now,
    plain,
    read_manifest,
    versions,
)

LOGS = (PRESSES, ANSWERS)
Log = TypeVar("Log", PressLog, AnswerLog)


@dataclass(frozen=True)
class Session:
    """Where presses are kept, and what makes them.

    Attributes
    ----------
    folder : of the session: new, empty, or one to go on with; None keeps nothing.
    seed : of a simulated device; None if it is not known, or of a real one.
    rig, finger : TOML files of a simulated device; the default ones if None.
    acceptance : bounds that a press keeps to be used. They may differ from run to run.

    A simulated device is best opened by ``open_device``: one opened again with the seed it began with would
    repeat the very chance that the presses on file have had already.
    """

    folder: Path | None = None
    seed: int | None = None
    rig: Path | None = None
    finger: Path | None = None
    acceptance: Acceptance = field(default_factory=Acceptance)

    def open_device(self, name: str) -> Device:
        """Open a device by name; a simulated one that goes on with a session draws fresh chance.

        Raises InputError on a recording that would have to go on: it begins anew, with presses kept already.
        """
        if name.startswith("replay:") and _runs_of(self.folder):
            reason = "a recording begins anew each time and would repeat presses that are kept"
            raise InputError(self.folder, "session", reason, "name another folder")
        return open_device(name, self.rig, self.finger, self.run_seed() or 0)

    def run_seed(self) -> int | None:
        """Give the seed of the run that begins now: that of the session first, then ones derived from it."""
        runs = _runs_of(self.folder)
        if not runs or self.seed is None:
            return self.seed
        return int(np.random.SeedSequence([self.seed, runs]).generate_state(1)[0])

    @property
    def parts(self) -> dict[str, str]:
        """Give digests of the files that a simulated device is made from."""
        files = {"rig_toml_sha256": self.rig, "finger_toml_sha256": self.finger}
        return {name: digest(path.read_bytes()) for name, path in files.items() if path}

    def begun(self, manifest: Manifest) -> AbstractContextManager[PressLog]:
        """Give the log of a session's presses, locked while it lasts.

        Raises InputError if the folder holds something else, a session about something else, or one that is
        damaged or in use; OSError if it cannot be written.
        """
        return self._begun(manifest, PressLog)

    def begun_answers(self, manifest: Manifest) -> AbstractContextManager[AnswerLog]:
        """Give the log of a session's answers, as begun gives that of presses."""
        return self._begun(manifest, AnswerLog)

    @contextmanager
    def _begun(self, manifest: Manifest, kind: type[Log]) -> Iterator[Log]:
        seed = self.run_seed() if manifest.simulated else None
        log = _open(self.folder, manifest, kind) if self.folder else kind()
        try:
            log.begin(Run(now(), seed, versions(), plain(self.acceptance)))
            yield log
        finally:
            log.close()


def _runs_of(folder: Path | None) -> int:
    """Count the runs of a session; one that cannot be read is refused where it is opened."""
    runs = 0
    for path in [folder / name for name in LOGS] if folder else []:
        if not path.is_file():
            continue
        with path.open("rb") as stream:
            runs += sum(b'"record": {"run": ' in line[:80] for line in stream)
    return runs


def _open(folder: Path, manifest: Manifest, kind: type[Log]) -> Log:
    """Begin a session in a new or empty folder, or go on with the one that is there."""
    if folder.exists() and not folder.is_dir():
        raise InputError(folder, "session", "is a file, a folder is needed", KIND.remedy)
    if not (folder / MANIFEST).exists() and _foreign(folder):
        raise InputError(folder, "session", f"holds files but no {MANIFEST}", KIND.remedy)
    folder.mkdir(parents=True, exist_ok=True)
    log = kind(folder)
    try:
        # asked again under the lock: another process may have begun the session meanwhile
        if (folder / MANIFEST).exists():
            _check(folder, manifest)
        else:
            write_atomic(folder / MANIFEST, manifest_text(manifest))
    except BaseException:
        log.close()
        raise
    return log


def _foreign(folder: Path) -> bool:
    """Tell whether a folder holds more than what a process leaves that was killed as it began."""
    if not folder.exists():
        return False
    return any(path.name not in LOGS or path.stat().st_size for path in folder.iterdir())


def _check(folder: Path, manifest: Manifest) -> None:
    """Refuse a session that is about something else."""
    found = differences(read_manifest(folder / MANIFEST), manifest)
    if found:
        more = f" (and {len(found) - 1} more)" if len(found) > 1 else ""
        reason = f"is another session: {found[0]}{more}"
        raise InputError(folder, "session", reason, "ask for the same, or name another folder")
