"""Where the results of a job go in the project."""

from __future__ import annotations

import re
from dataclasses import dataclass
from pathlib import Path

from fdvv.device import pressed_by_person
from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.studio._job_file import JobFolder
from fdvv.studio._messages_jobs import JobResult
from fdvv.studio._messages_orders import CaptureOrder, CompensateOrder, Order

NAME = re.compile(r"[^\W_][\w .+()-]{0,79}")
"""Of what comes out: it becomes part of a file's name."""


@dataclass(frozen=True)
class Place:
    """A folder of the project and how its files end; fresh: a name that is there already is not taken."""

    folder: str
    suffix: str
    fresh: bool

    def file(self, project: Path, name: str) -> Path:
        """Name the file of a result."""
        return project / self.folder / f"{name}{self.suffix}"


PLACES = {
    "actuation": Place("actuations", ".actuation.json", False),
    "measured": Place("measured", ".json", False),
    "rig": Place("rigs", ".rig.json", False),
    "button": Place("buttons", ".fdvv.json", True),
    "recording": Place("recordings", ".recording.jsonl", True),
}


def check_name(name: str) -> str:
    """Give a name that may be part of a file's name; InputError on any other."""
    if not NAME.fullmatch(name) or name.endswith((".", " ")):
        reason = f"cannot be {name[:80]!r}"
        raise InputError("name", "name", reason, "use letters, digits, spaces and . + - ( ), 80 at most")
    return name


def kept_names(project: Path, kind: str) -> tuple[str, ...]:
    """List the results of a kind in the project."""
    place = PLACES[kind]
    found = (project / place.folder).glob(f"*{place.suffix}")
    return tuple(sorted(path.name.removesuffix(place.suffix) for path in found if path.name[0] != "."))


def kept_file(project: Path, kind: str, name: str) -> Path:
    """Give the file of a result by its name, looked up among those that are there. InputError."""
    if name not in kept_names(project, kind):
        raise InputError(kind, name[:80], "there is none of this name in the project", "choose another")
    return PLACES[kind].file(project, name)


def publish(project: Path, folder: JobFolder, order: Order) -> tuple[JobResult, ...]:
    """Copy what a job made into its places in the project. OSError.

    A table, what was measured of it and what a rig has taught replace those of the same name; buttons and
    recordings never do.
    """
    files = {kind: folder.result(kind) for kind in PLACES} | {"recording": folder.recording}
    names = dict.fromkeys(PLACES, order.name) | {"rig": rig_name(order)}
    return tuple(
        _put(project, kind, names[kind], file.read_bytes()) for kind, file in files.items() if file.exists()
    )


def rig_name(order: Order) -> str:
    """Name the rig that an order works on, as what it has taught is kept."""
    if isinstance(order, CaptureOrder):
        return order.device
    simulated = isinstance(order, CompensateOrder) and not pressed_by_person(order.device)
    where = order.device.rpartition("/")[2] if "/" in order.device else order.device.replace(":", "-")
    return f"{where}-{order.rig}" if simulated else where


def _put(project: Path, kind: str, name: str, content: bytes) -> JobResult:
    place = PLACES[kind]
    free = _free(project, place, name) if place.fresh else name
    write_atomic(place.file(project, free), content)
    return JobResult(kind, free)  # type: ignore[arg-type]  # the keys of PLACES are its kinds


def _free(project: Path, place: Place, name: str) -> str:
    found, count = name, 1
    while place.file(project, found).exists():
        count += 1
        found = f"{name} {count}"
    return found
