"""What ``fdvv check`` says of the trials of an optimisation."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from fdvv.recording.check import CheckedJournal, FileCheck
from fdvv_people.optimize.run.ledger import KIND, read_ledger


def check_trials(path: Path, kind: str) -> FileCheck:
    """Count what a ledger holds. InputError."""
    trials = read_ledger(path).trials
    states = Counter(str(trial.state) for trial in trials if not trial.beside)
    sizes = Counter(min(len(trial.designs), 3) for trial in trials)
    facts = {"trials": sizes[1], **states, "comparisons": sizes[2]}
    if sizes[3]:
        facts["lines"] = sizes[3]
    return FileCheck(path, kind, {**facts, "size_bytes": path.stat().st_size})


TRIALS = CheckedJournal(tuple(KIND.types), "the trials of an optimisation", check_trials)
