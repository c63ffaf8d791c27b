"""The rigs a project knows: the shipped simulated ones, met once, and a person's own files."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from threading import Lock

from fdvv.compensate import KnownRig, RigAware, load_rig, save_rig
from fdvv.device import DeviceInfo, TwinDevice
from fdvv.errors import InputError
from fdvv.files import write_atomic
from fdvv.model import load_builtin
from fdvv.protocol import Settings
from fdvv.twin import load_rig as load_plant
from fdvv.workflow._compensate import compensate

SHIPPED_RIGS = {
    "default": "voltage drive, mover of 20 g",
    "paper": "one that could have been the paper's: current drive, 12 g",
    "light": "current drive, mover of 6 g, loop of 10 kHz",
}
"""Rigs that come with the package, and what each is."""
OWN_ABOUT = "your rig file; limits of force and time are those of the shipped default rig"
SUFFIX, SIMULATED = ".rig.json", ".simulated.rig.json"
MET_ON, MET_AT_mm_s, MET_SEED = "mx-clear", (50.0, 100.0, 150.0, 200.0), 1
"""Which button, speeds and seed a shipped rig is met with."""


@dataclass(frozen=True)
class RigEntry:
    """One rig that can be chosen.

    Attributes
    ----------
    rig_id : "shipped:NAME" or "own:NAME".
    about : what it is, in a few words.
    simulated : its numbers come from presses of the twin.
    known : nothing needs to be learned before it answers.
    """

    rig_id: str
    about: str
    simulated: bool
    known: bool


@dataclass(frozen=True, eq=False)
class RigOnShelf:
    """A rig whose numbers are known, with what its firmware lets through.

    Attributes
    ----------
    known : its effective numbers. settings, info : of the device they were told of; for a person's own file,
        which holds no settings, those of the shipped default rig.
    """

    entry: RigEntry
    known: KnownRig
    settings: Settings
    info: DeviceInfo


class RigShelf:
    """The rigs of a project folder, looked up by id; what is learned is kept in ``<project>/rigs``."""

    def __init__(self, project: Path) -> None:
        self._folder = project / "rigs"
        self._found: dict[str, RigOnShelf] = {}
        self._lock = Lock()

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

    def rig(self, rig_id: str) -> RigOnShelf:
        """Give a rig by its id; a shipped one that was never met is met first, which takes about a second.

        Raises InputError on an unknown id and on a file that cannot be read.
        """
        with self._lock:
            entry = next((e for e in self.entries() if e.rig_id == rig_id), None)
            if entry is None:
                names = ", ".join(e.rig_id for e in self.entries())
                raise InputError("rig", rig_id, "no such rig in this project", f"choose one of {names}")
            if rig_id not in self._found:
                self._found[rig_id] = self._load(entry)
            return self._found[rig_id]

    def lend(self, rig_id: str, project: Path) -> None:
        """Copy what is known of a rig to another project. InputError on an unknown id, OSError."""
        self.rig(rig_id)
        kind, _, name = rig_id.partition(":")
        file = f"{name}{SIMULATED if kind == 'shipped' else SUFFIX}"
        write_atomic(project / "rigs" / file, self._files()[file].read_bytes())

    def _load(self, entry: RigEntry) -> RigOnShelf:
        kind, _, name = entry.rig_id.partition(":")
        device = TwinDevice(load_plant(name if kind == "shipped" else "default"), seed=MET_SEED)
        files = self._files()
        path = files.get(f"{name}{SIMULATED if kind == 'shipped' else SUFFIX}")
        known = load_rig(path) if path else self._meet(device, name)
        return RigOnShelf(entry, known, device.settings(), device.info())

    def _meet(self, device: TwinDevice, name: str) -> KnownRig:
        """Press a shipped rig until it is known, and keep what it taught."""
        memory = compensate(device, load_builtin(MET_ON), MET_AT_mm_s, RigAware()).memory
        assert memory is not None  # RigAware always remembers
        save_rig(memory, self._folder / f"{name}{SIMULATED}")
        return memory.known

    def _files(self) -> dict[str, Path]:
        """Give the rig files there are, by name; an id is looked up here, never made into a path."""
        if not self._folder.is_dir():
            return {}
        return {p.name: p for p in self._folder.iterdir() if p.name.endswith(SUFFIX) and p.is_file()}
