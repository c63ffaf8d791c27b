"""The folder of a study: its files, and what is frozen of them."""

from __future__ import annotations

import hashlib
from collections.abc import Sequence
from pathlib import Path
from typing import Literal, TypeVar

import msgspec
from msgspec import Struct

from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty, read_document
from fdvv.io.files import read_limited, write_atomic
from fdvv.model.file import builtin_names, load_builtin, model_to_json
from fdvv_people.study.plan.plan import DeclaredPlan

FROZEN_FILE, KEEPER_FILE, LOG_FILE = "frozen.json", "keeper.json", "study.jsonl"
COUNTS_FILE = "counts.json"
BUTTONS, PEOPLE, UNSEALED = "buttons", "people", "unsealed"
PAGES_FILE = "pages.csv"
SESSION_FILE, SCHEDULE_FILE, SEALED_FILE = "session.jsonl", "schedule.json", "sealed.jsonl"
Record = TypeVar("Record")
LARGEST_bytes = 64_000_000  # as of a model's file (`fdvv.model.file`), the largest that a study copies
SMALLER = "name a smaller file"
REMEDY = "take the study's folder from a backup, or declare a new study"
FROZEN = Kind("fdvv-frozen", 2, "what is frozen of a study", REMEDY, oldest=1)


class Frozen(Struct, frozen=True, forbid_unknown_fields=True, kw_only=True):
    """What was fixed before the first person.

    Attributes
    ----------
    version : 1: a person's code alone opens their schedule. 2: the run key is needed too.
    files : SHA-256 of the plan, of every file that it names and of keeper.json, by path in the folder.
    builtins : SHA-256 of every built-in button that it names, for a new fdvv may ship others.
    seal : the public half of the keys. fdvv : version. when : UTC.
    """

    format: Literal["fdvv-frozen"] = "fdvv-frozen"
    version: Literal[1, 2] = 2
    files: dict[str, str]
    builtins: dict[str, str]
    seal: str
    fdvv: str
    when: str

    @property
    def text(self) -> str:
        return pretty(msgspec.to_builtins(self)) + "\n"


def read_frozen(folder: Path) -> tuple[Frozen, str] | None:
    """Read what is frozen, and the SHA-256 of the file; None of a study that is not. InputError."""
    path = folder / FROZEN_FILE
    if not path.exists():
        return None
    data = content(path)
    return read_record(data, path, FROZEN, Frozen), digest(data)


def read_record(data: str | bytes, source: object, kind: Kind, record: type[Record]) -> Record:
    """Read a document that holds a record. InputError."""
    return read_document(data, source, kind, msgspec.json.Decoder(record).decode, lambda _: None)


def content(path: Path) -> bytes:
    """Read a file of a study. InputError where it is missing or too large."""
    return read_limited(path, LARGEST_bytes, REMEDY)


def fingerprint_of(sha256: str) -> str:
    """Return what people write down: the first 16 digits, in groups of four."""
    return "-".join(sha256[i : i + 4] for i in range(0, 16, 4))


def digest(data: bytes | str) -> str:
    return hashlib.sha256(data.encode() if isinstance(data, str) else data).hexdigest()


def builtin_digest(name: str) -> str:
    """Return the SHA-256 of a built-in button; empty if there is none of that name."""
    return digest(model_to_json(load_builtin(name))) if name in builtin_names() else ""


def named_builtins(plan: DeclaredPlan) -> tuple[str, ...]:
    """Return the built-in buttons that a plan names, sorted."""
    return tuple(sorted(plan.named & set(builtin_names())))


def named_files(plan: DeclaredPlan) -> tuple[str, ...]:
    """Return the files that a plan names, as it names them. InputError on one outside its folder."""
    found = tuple(sorted(plan.named - set(builtin_names())))
    for name in found:
        _require_inside(name)
    return found


def _require_inside(name: str) -> None:
    if Path(name).is_absolute() or ".." in Path(name).parts:
        remedy = "copy it beside the study and name it as it lies there"
        raise InputError(name, "name", "lies outside the folder of the study", remedy)


def kept_path(folder: Path, name: str) -> Path:
    """Return where a study's folder keeps a file that its plan names: as named, or in buttons/."""
    return folder / name if Path(name).parts[0] == BUTTONS else folder / BUTTONS / name


def study_file(folder: Path, name: str) -> Path:
    """Find a file that a plan names: what the folder keeps, and is frozen, before what lies beside it.

    InputError on one that is not there, or outside the folder.
    """
    _require_inside(name)
    for path in (kept_path(folder, name), folder / name):
        if path.is_file():
            return path
    known = ", ".join(builtin_names())
    remedy = f"copy it beside the study and name it as it lies there, or use one of {known}"
    raise InputError(name, "name", "no such file in the study's folder", remedy)


def copy_files(names: Sequence[str], beside: Path, folder: Path) -> None:
    """Copy the files that a plan names from beside it into a study's folder. InputError, OSError."""
    for name in names:
        _require_inside(name)
        sources = (beside / name, kept_path(beside, name))
        source = next((path for path in sources if path.is_file()), None)
        if source is None:
            known = ", ".join(builtin_names())
            reason = f"no such file beside the plan in {beside}, and no built-in button"
            raise InputError(name, "name", reason, f"copy it there, or name one of {known}")
        write_atomic(kept_path(folder, name), read_limited(source, LARGEST_bytes, SMALLER))


def keep_files(names: Sequence[str], folder: Path) -> None:
    """Copy the files that a plan names and that lie beside it to where the study keeps them.

    A file that it keeps already stays, for that is the one that was reviewed. InputError, OSError.
    """
    for name in names:
        kept = kept_path(folder, name)
        if not kept.is_file():
            write_atomic(kept, read_limited(study_file(folder, name), LARGEST_bytes, SMALLER))
