"""The rigs of a project: shipped simulated ones, identified once, and a person's own files."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from threading import Event, Lock
from typing import Literal, cast

from fdvv.compensation.feasibility.limits import AchievableStroke, Motion, minimum_jerk
from fdvv.compensation.identification.balance import true_runs
from fdvv.compensation.identification.rig_file import load_rig, save_rig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.contract import DeviceInfo
from fdvv.device.twin import TwinDevice
from fdvv.errors import DeviceError, InputError
from fdvv.io.files import write_atomic
from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.protocol.tables import Settings
from fdvv.rendering.compensate import compensate
from fdvv.rendering.feasibility import CurveFeasibility, feasibility
from fdvv.rendering.session_run import PressDone
from fdvv.twin.files import OLD_RIG_NAMES, current_rig_name
from fdvv.twin.files import load_rig as load_plant

SHIPPED_RIGS = {
    "recommended": "the rig to build: load cell in the cap, current drive, mover of 12 g, loop of 10 kHz",
    "light": "current drive, mover of 6 g, loop of 10 kHz, no load cell",
    "paper": "one that could have been the paper's: current drive, 12 g, loop of 1 kHz, no load cell",
    "voltage": "voltage drive, mover of 20 g, loop of 1 kHz, no load cell",
}
"""Rigs that come with the package, and what each is; the first unless there is a reason for another."""
OWN_RIG = "voltage"
"""Settings of a rig of one's own are taken from here: the slowest loop promises nothing that it cannot do."""
OWN_ABOUT = "your rig file; limits of force and time are those of the shipped rig voltage"
SUFFIX, SIMULATED = ".rig.json", ".simulated.rig.json"
IDENTIFIED_ON, IDENTIFIED_AT_mm_s, IDENTIFIED_SEED = "mx-clear", (50.0, 100.0, 150.0, 200.0), 1
"""Button, speeds and seed that identify a shipped rig."""


@dataclass(frozen=True)
class RigEntry:
    """One rig that can be chosen.

    Attributes
    ----------
    rig_id : "shipped:NAME" or "own:NAME".
    about : what it is, in a few words.
    simulated : its numbers come from presses of the twin.
    known : it is identified already.
    """

    rig_id: str
    about: str
    simulated: bool
    known: bool


@dataclass(frozen=True, eq=False)
class AvailableRig:
    """An identified rig with the settings of its device.

    Attributes
    ----------
    known : the model of the rig. settings, info : of the device; for a person's own file, which holds no
        settings, those of the shipped OWN_RIG.
    """

    entry: RigEntry
    known: RigModel
    settings: Settings
    info: DeviceInfo


class RigCatalog:
    """The rigs of a project folder, looked up by id; models are stored in ``<project>/rigs``."""

    def __init__(self, project: Path) -> None:
        self._folder = project / "rigs"
        self._found: dict[str, AvailableRig] = {}
        self._lock = Lock()
        self._closed = Event()

    def entries(self) -> tuple[RigEntry, ...]:
        """List the shipped rigs, then a person's own files by name."""
        files = self._files()
        shipped = [
            RigEntry(f"shipped:{name}", about, True, f"{name}{SIMULATED}" in files)
            for name, about in SHIPPED_RIGS.items()
        ]
        own = [
            RigEntry(f"own:{file.removesuffix(SUFFIX)}", OWN_ABOUT, False, True)
            for file in sorted(files)
            if not file.endswith(SIMULATED)
        ]
        return (*shipped, *own)

    def rig(self, rig_id: str) -> AvailableRig:
        """Return a rig by its id; a shipped one is identified at first use, which takes a few seconds.

        Raises InputError on an unknown id and on a file that cannot be read.
        """
        rig_id = _current_id(rig_id)
        with self._lock:
            entry = next((e for e in self.entries() if e.rig_id == rig_id), None)
            if entry is None:
                names = ", ".join(e.rig_id for e in self.entries())
                raise InputError("rig", rig_id, "no such rig in this project", f"choose one of {names}")
            if rig_id not in self._found:
                self._found[rig_id] = self._load(entry)
            return self._found[rig_id]

    def close(self) -> None:
        """End an identification that is under way with its next press."""
        self._closed.set()

    def _go_on(self, _done: PressDone) -> None:
        if self._closed.is_set():
            raise DeviceError("the rig is not identified: the studio was closed meanwhile")

    def lend(self, rig_id: str, project: Path) -> None:
        """Copy the file of a rig to another project. Raises InputError on an unknown id, OSError."""
        file = _file_of(self.rig(rig_id).entry.rig_id)
        write_atomic(project / "rigs" / file, self._files()[file].read_bytes())

    def _load(self, entry: RigEntry) -> AvailableRig:
        """Read a rig's file; a shipped rig without one is identified by simulated presses, and saved."""
        plant = entry.rig_id.removeprefix("shipped:") if entry.simulated else OWN_RIG
        device = TwinDevice(load_plant(plant), seed=IDENTIFIED_SEED)
        file = _file_of(entry.rig_id)
        if path := self._files().get(file):
            return AvailableRig(entry, load_rig(path), device.settings(), device.info())
        # a file holds what the loop leaves alone, which the first press at each speed has shown
        law = RigAware(rounds=1) if device.load_cell else RigAware()
        model = load_builtin(IDENTIFIED_ON)
        learned = compensate(device, model, IDENTIFIED_AT_mm_s, law, self._go_on).learned_rig
        assert learned is not None  # RigAware always returns one
        save_rig(learned, self._folder / file)
        return AvailableRig(entry, learned.rig, device.settings(), device.info())

    def _files(self) -> dict[str, Path]:
        """Return the rig files by name; an id is looked up here, never made into a path."""
        if not self._folder.is_dir():
            return {}
        files = {p.name: p for p in self._folder.iterdir() if p.name.endswith(SUFFIX) and p.is_file()}
        for old, name in OLD_RIG_NAMES.items():
            if path := files.pop(f"{old}{SIMULATED}", None):
                files.setdefault(f"{name}{SIMULATED}", path)
        return files


def _current_id(rig_id: str) -> str:
    kind, _, name = rig_id.partition(":")
    return f"{kind}:{current_rig_name(name)}" if kind == "shipped" else rig_id


def _file_of(rig_id: str) -> str:
    kind, _, name = rig_id.partition(":")
    return f"{name}{SIMULATED if kind == 'shipped' else SUFFIX}"


Limit = Literal["force", "slew"]
DEFAULT_SPEED_mm_s = 50.0
"""Speed of curves of unknown velocity."""
STEPS, STEPS_A_TICK = 2500, 8
"""Largest number of time steps of a stroke; a report takes eight per tick, too slow for an editor."""


@dataclass(frozen=True)
class LimitedRange:
    """Where a limit cuts: from start to end, mm; limit is "force" (or duty) or "slew"."""

    start_mm: float
    end_mm: float
    limit: Limit


def ranges_at_limit(reached: AchievableStroke) -> list[LimitedRange]:
    x, cuts = reached.displacement_mm, {"force": reached.saturated, "slew": reached.slewed}
    return [
        LimitedRange(float(x[a]), float(x[b - 1]), cast(Limit, limit))
        for limit, rows in cuts.items()
        for a, b in true_runs(rows)
    ]


def achievable(
    model: FDVVModel, rig: AvailableRig, velocities_mm_s: Sequence[float | None]
) -> tuple[CurveFeasibility, ...]:
    """Return what a rig renders of both strokes of a model at these speeds, in about 10 ms per speed.

    velocities_mm_s : of the changed curves; None, an unknown velocity, is judged at 50 mm/s.
    Raises InputError on invalid speeds, ModelError on a model without a press curve.
    """
    speeds = list(dict.fromkeys(DEFAULT_SPEED_mm_s if v is None else float(v) for v in velocities_mm_s))
    motions = {(stroke, v): _motion(stroke, model, rig, v) for stroke in Stroke for v in speeds}
    return feasibility(model, rig.known, rig.settings, speeds, info=rig.info, motions=motions).curves


def _motion(stroke: Stroke, model: FDVVModel, rig: AvailableRig, velocity_mm_s: float) -> Motion:
    """Return a stroke as a report does, in fewer steps if it is slow."""
    coarse_s = STEPS_A_TICK * model.travel_mm / velocity_mm_s / STEPS
    return minimum_jerk(stroke, model.travel_mm, velocity_mm_s, max(1e-6 * rig.settings.tick_us, coarse_s))
