"""What a look at a file found: facts, and problems with their place and remedy."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from fdvv.errors import InputError


@dataclass(frozen=True)
class Problem:
    """Something in a file that is not as it should be."""

    place: str
    reason: str
    remedy: str

    def __str__(self) -> str:
        return f"{self.place}: {self.reason}; {self.remedy}"


@dataclass(frozen=True)
class FileCheck:
    """What a file is, and whether it is whole.

    Attributes
    ----------
    kind : what it holds, with its article.
    facts : by name, plain values; the unit is the last part of a name.
    problems : what is wrong, the worst first.
    notes : what the file says of itself, as repairs that a reader made.
    usable : it can be read.
    """

    path: Path
    kind: str
    facts: Mapping[str, Any] = field(default_factory=dict)
    problems: tuple[Problem, ...] = ()
    notes: tuple[str, ...] = ()
    usable: bool = True

    @property
    def status(self) -> int:
        """Give 0 for a whole file, 1 for one that can be read but has problems, 2 for an unusable one."""
        return 2 if not self.usable else int(bool(self.problems))

    def to_dict(self) -> dict[str, Any]:
        """Give it as plain values."""
        verdict = ("whole", "readable with problems", "unusable")[self.status]
        return {
            "file": str(self.path),
            "kind": self.kind,
            "verdict": verdict,
            "facts": dict(self.facts),
            "problems": [vars(problem) for problem in self.problems],
            "notes": list(self.notes),
        }


def unusable(path: Path, kind: str, error: InputError) -> FileCheck:
    """Say of a file that it cannot be read, and why."""
    place = error.place if Path(error.source) == path else f"{error.source}, {error.place}"
    return FileCheck(path, kind, problems=(Problem(place, error.reason, error.remedy),), usable=False)
