"""What kind of study a folder or file declares, and what each kind of command opens."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv_people.study.plan.plan_file import write_template
from fdvv_people.timing.plan.plan_file import TEMPLATE_NAMES, is_timing, timing_template

KINDS = ("realism", "abx", "2afc", "2ac", "preference", "mushra", "staircase", "thresholds", *TEMPLATE_NAMES)
DEFAULT = "realism"


def kind_named(folder: Path, kind: str | None) -> str:
    """Return the kind of a new study: as asked, or as its folder is called, or the paper's study."""
    name = folder.absolute().name
    return kind or (name if name in KINDS else DEFAULT)


def write_kind(kind: str, folder: Path) -> Path:
    """Write a shipped study of a kind, called as its folder; return its file. InputError, OSError."""
    write = timing_template if kind in TEMPLATE_NAMES else write_template
    return write(kind, folder, folder.absolute().name)


def refuse_timing(study: Path, command: str, instead: str) -> None:
    """Refuse a command that timing studies have no use for. InputError."""
    if is_timing(study):
        raise InputError(study, command, "is for studies that ask about what is rendered", instead)
