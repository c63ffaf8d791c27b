"""What ``fdvv check`` says of a log of a study."""

from __future__ import annotations

from pathlib import Path

from fdvv.recording.check import CheckedJournal, FileCheck, FileProblem
from fdvv_people.study.files.chained_log import REMEDY, read_chained


def check_log(path: Path, kind: str) -> FileCheck:
    """Check a chained log without its key. InputError."""
    log = read_chained(path)
    about = {name: value for name, value in log.about.items() if isinstance(value, str | int)}
    facts = {"records": len(log.records), "size_bytes": path.stat().st_size, **about}
    problems = tuple(FileProblem("log", problem, REMEDY) for problem in log.problems)
    notes = ("marks need the study's key; fdvv study verify checks the whole folder",)
    return FileCheck(path, kind, facts, problems, notes)


LOG = CheckedJournal(("begin",), "a chained log of a study", check_log)
