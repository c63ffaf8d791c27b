"""The folder of a session: its manifest, opened, resumed or refused."""

from __future__ import annotations

import dataclasses
import hashlib
import json
import platform
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, field
from datetime import UTC, datetime
from pathlib import Path
from typing import Any, Literal, TypeVar

import msgspec
import numpy as np

from fdvv._version import __version__
from fdvv.compensation.presses import AcceptanceLimits
from fdvv.device.contract import Device
from fdvv.device.remote import Remote
from fdvv.errors import InputError
from fdvv.io.documents import Kind, pretty, read_record
from fdvv.io.files import write_atomic
from fdvv.model.file import model_to_json
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.session_log import ANSWERS, PRESSES, AnswerLog, PressLog, SessionRun
from fdvv.rendering.tuning import TUNED, open_device

MANIFEST = "session.json"
KIND = Kind("fdvv-session", 1, "a session", "name the folder of a session, or one that is new or empty")
LARGEST_bytes = 4_000_000  # assumed; manifests have about 1 kB (tests/files/old)
MUST_AGREE = ("task", "model", "device", "method", "settings", "velocities_mm_s", "seed")


Task = Literal["compensate", "probe", "tune"]


class ModelName(msgspec.Struct, forbid_unknown_fields=True):
    """A model's name and the digest of its file."""

    name: str
    sha256: str


class Manifest(msgspec.Struct, forbid_unknown_fields=True):
    """What identifies a session.

    Attributes
    ----------
    device : limits, and what distinguishes rigs: serial number, firmware and settings of a board,
        digests of the files of a simulated one.
    settings : of the method, or of the probe.
    seed : of a simulated device; None of a real one.
    """

    format: Literal["fdvv-session"]
    version: Literal[1]
    task: Task
    model: ModelName
    device: dict[str, Any]
    method: str
    settings: dict[str, Any]
    velocities_mm_s: list[float]
    seed: int | None
    simulated: bool
    versions: dict[str, str]
    created: str


def identity(device: Device) -> dict[str, Any]:
    """Return what distinguishes a device, without the settings that a session itself configures."""
    record: dict[str, Any] = dataclasses.asdict(device.info())
    if isinstance(device, Remote):
        hello = device.client.hello
        record |= {"serial": hello.serial, "firmware": hello.firmware, "protocol": hello.hash}
        settings = dataclasses.asdict(device.settings())
        record["settings"] = {name: value for name, value in settings.items() if name not in TUNED}
    return record


def plain(settings: Any) -> dict[str, Any]:
    """Return settings, a dataclass or a mapping, as JSON would read them back.

    A field goes by the "key" of its metadata if it has one: the name it has in older sessions.
    """
    record = json.loads(json.dumps(settings, default=_jsonable))
    assert isinstance(record, dict)
    return record


def _jsonable(value: Any) -> Any:
    if dataclasses.is_dataclass(value) and not isinstance(value, type):
        return {f.metadata.get("key", f.name): getattr(value, f.name) for f in dataclasses.fields(value)}
    return value.tolist() if isinstance(value, np.ndarray | np.generic) else str(value)


def digest(data: bytes) -> str:
    return hashlib.sha256(data).hexdigest()


def table_digest(surface: ForceSurface) -> str:
    columns = vars(surface).values()
    return digest(b"".join(np.ascontiguousarray(column, dtype="<f8").tobytes() for column in columns))


def versions() -> dict[str, str]:
    return {"fdvv": __version__, "python": platform.python_version(), "numpy": np.__version__}


def now() -> str:
    """Return the time, UTC."""
    return datetime.now(UTC).isoformat(timespec="milliseconds")


def read_manifest(path: Path) -> Manifest:
    return read_record(path, KIND, Manifest, LARGEST_bytes)


def differences(there: Manifest, now: Manifest) -> list[str]:
    """Return the differences of two manifests, a phrase each; empty if they agree."""
    old, new = msgspec.to_builtins(there), msgspec.to_builtins(now)
    return [text for key in MUST_AGREE for text in _unequal(old[key], new[key], key)]


def _unequal(old: Any, new: Any, place: str) -> Iterator[str]:
    if isinstance(old, dict) and isinstance(new, dict):
        for key in sorted(set(old) | set(new)):
            yield from _unequal(old.get(key), new.get(key), f"{place}.{key}")
    elif old != new:
        yield f"{place} is {_short(old)} there and {_short(new)} now"


def _short(value: Any) -> str:
    text = json.dumps(value, ensure_ascii=False)
    return text if len(text) <= 40 else text[:12] + "…"


LOGS = (PRESSES, ANSWERS)
Log = TypeVar("Log", PressLog, AnswerLog)


@dataclass(frozen=True)
class Session:
    """Where presses are stored, and the device that makes them.

    Attributes
    ----------
    folder : of the session: new, empty, or one to resume; None stores nothing.
    seed : of a simulated device; None if unknown, or of a real one.
    rig, finger : TOML files of a simulated device; the default ones if None.
    acceptance : bounds within which a press is used. They may differ from run to run.
    checked_in : folders of other sessions on this rig, whose check of its parts counts on the same day.

    Open a simulated device by ``open_device``: opened again with its first seed, it would
    repeat the random numbers of the presses on file.
    """

    folder: Path | None = None
    seed: int | None = None
    rig: Path | None = None
    finger: Path | None = None
    acceptance: AcceptanceLimits = field(default_factory=AcceptanceLimits)
    checked_in: tuple[Path, ...] = ()

    def open_device(self, name: str) -> Device:
        """Open a device by name; a simulated one that resumes a session draws fresh random numbers.

        Raises InputError for a recording in a session with presses: it would repeat them.
        """
        if name.startswith("replay:") and _runs_of(self.folder):
            reason = "a recording starts over each time and would repeat presses that are stored"
            raise InputError(self.folder, "session", reason, "name another folder")
        return open_device(name, self.rig, self.finger, self.run_seed() or 0)

    def run_seed(self) -> int | None:
        """Return the seed of the next run: first that of the session, then ones derived from it."""
        runs = _runs_of(self.folder)
        if not runs or self.seed is None:
            return self.seed
        # counted by runs, so that even a killed one never draws its numbers twice
        return int(np.random.SeedSequence([self.seed, runs]).generate_state(1)[0])

    @property
    def parts(self) -> dict[str, str]:
        """Digests of the files that a simulated device is made from."""
        files = {"rig_toml_sha256": self.rig, "finger_toml_sha256": self.finger}
        return {name: digest(path.read_bytes()) for name, path in files.items() if path}

    def manifest(
        self,
        task: Task,
        device: Device,
        model: FDVVModel,
        velocities_mm_s: Sequence[float],
        method: str,
        settings: Any,
    ) -> Manifest:
        """Return the manifest of a session; settings : of the method, a dataclass or a mapping."""
        info, about = device.info(), ModelName(model.name, digest(model_to_json(model).encode()))
        seed = self.seed if info.simulated else None
        what = method, plain(settings), list(velocities_mm_s), seed, info.simulated
        who = {**identity(device), **self.parts}
        return Manifest("fdvv-session", 1, task, about, who, *what, versions(), now())

    @contextmanager
    def open_log(self, manifest: Manifest, kind: type[Log]) -> Iterator[Log]:
        """Open the log of a session's presses or answers, locked until closed.

        Raises InputError if the folder holds something else, a session about something else, or one that is
        damaged or in use; OSError if it cannot be written.
        """
        seed = self.run_seed() if manifest.simulated else None
        log = _open(self.folder, manifest, kind) if self.folder else kind()
        try:
            log.begin(SessionRun(now(), seed, versions(), plain(self.acceptance)))
            yield log
        finally:
            log.close()


def _runs_of(folder: Path | None) -> int:
    """Count the runs of a session; an unreadable one is refused when it is opened."""
    runs = 0
    for path in [folder / name for name in LOGS] if folder else []:
        if not path.is_file():
            continue
        with path.open("rb") as stream:
            # not decoded: a line holds every column of a press, and its key is at its beginning
            runs += sum(b'"record": {"run": ' in line[:80] for line in stream)
    return runs


def _open(folder: Path, manifest: Manifest, kind: type[Log]) -> Log:
    """Start a session in a new or empty folder, or resume the existing one."""
    if folder.exists() and not folder.is_dir():
        raise InputError(folder, "session", "is a file, a folder is needed", KIND.remedy)
    if not (folder / MANIFEST).exists() and _foreign(folder):
        raise InputError(folder, "session", f"holds files but no {MANIFEST}", KIND.remedy)
    folder.mkdir(parents=True, exist_ok=True)
    log = kind(folder)
    try:
        # checked again under the lock: another process may have started the session
        if (folder / MANIFEST).exists():
            changes = differences(read_manifest(folder / MANIFEST), manifest)
            if changes:
                more = f" (and {len(changes) - 1} more)" if len(changes) > 1 else ""
                reason = f"is another session: {changes[0]}{more}"
                raise InputError(folder, "session", reason, "repeat its options, or name another folder")
        else:
            write_atomic(folder / MANIFEST, pretty(msgspec.to_builtins(manifest)) + "\n")
    except BaseException:
        log.close()
        raise
    return log


def _foreign(folder: Path) -> bool:
    """Return whether a folder holds more than the empty logs that a killed process leaves."""
    paths = folder.iterdir() if folder.exists() else ()
    return any(path.name not in LOGS or path.stat().st_size for path in paths)
