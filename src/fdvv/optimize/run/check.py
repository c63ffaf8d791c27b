"""What ``fdvv check`` says of the trials of an optimisation."""

from __future__ import annotations

from collections import Counter
from pathlib import Path

from fdvv.optimize.run.ledger import KIND, read_ledger
from fdvv.recording.check import CheckedJournal, FileCheck


def check_trials(path: Path, kind: str) -> FileCheck:
    """Count what a ledger holds. InputError."""
    ledger = read_ledger(path)
    states = Counter(str(trial.state) for trial in ledger.trials)
    facts = {"trials": len(ledger.trials), **states, "comparisons": len(ledger.comparisons)}
    if ledger.lines:
        facts["lines"] = len(ledger.lines)
    return FileCheck(path, kind, {**facts, "size_bytes": path.stat().st_size})


TRIALS = CheckedJournal(tuple(KIND.types), "the trials of an optimisation", check_trials)
