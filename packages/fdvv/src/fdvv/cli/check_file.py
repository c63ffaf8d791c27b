"""Check any file that fdvv writes or reads: what it is, and whether it is whole."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path

from fdvv import extras
from fdvv.compensation.identification.rig_file import load_rig
from fdvv.errors import BuildError, FdvvError, InputError
from fdvv.formats.force.read import read_force_file
from fdvv.io.files import open_plain
from fdvv.model.file import load_model
from fdvv.model.jnd_file import load_jnds
from fdvv.program.check import check_program
from fdvv.program.describe import describe
from fdvv.program.file import load_program
from fdvv.recording.check import CheckedJournal, FileCheck, FileProblem, check_recording, facts_of, unusable
from fdvv.recording.read import read_log
from fdvv.rendering.actuation_file import load_actuation
from fdvv.rendering.press_check import A_SESSION, check_device_recording, check_session
from fdvv.rendering.session import MANIFEST
from fdvv.rendering.session_log import PRESSES

HEAD_bytes = 400  # twice that of io.documents: marks stand in the first field; other spacing is assumed
IMAGE = b"FDVP"
REMEDY = "name a file that fdvv wrote, the folder of a session, or a log of a bench"


def check_file(path: Path | str, rate_Hz: float | None = None) -> FileCheck:
    """Check what a file is by its content, and whether it is whole.

    Models, programs and their images, rigs, JNDs, actuations, recordings, folders of sessions and what they
    hold, recordings of devices, and the journals of other packages. Anything else may be a log that read_log
    reads, or a file of force curves. Never raises for what stands in a file. Raises InputError where
    there is none, or what it holds is not known. rate_Hz : of a log of bare numbers.
    """
    path = Path(path)
    if path.is_dir():
        if (path / MANIFEST).is_file() or (path / PRESSES).is_file():
            return check_session(path)
        raise InputError(path, "folder", f"holds no {MANIFEST}", REMEDY)
    head = _head(path)
    for mark, kind, check in KINDS:
        if mark in head:
            return _guarded(path, kind, check)
    return _log(path, rate_Hz)


def _head(path: Path) -> bytes:
    try:
        with open_plain(path) as stream:
            return stream.read(HEAD_bytes)
    except OSError as error:
        reason = error.strerror or str(error)
        raise InputError(path, "whole file", reason, "check the path and its permissions") from error


def _guarded(path: Path, kind: str, check: Callable[[Path, str], FileCheck]) -> FileCheck:
    try:
        return check(path, kind)
    except InputError as error:
        return unusable(path, kind, error)
    except FdvvError as error:
        return unusable(path, kind, InputError(path, "whole file", str(error), "make it again"))


def _model(path: Path, kind: str) -> FileCheck:
    model = load_model(path)
    facts = {
        "version": 1,
        "name": model.name,
        "simulated": model.provenance.simulated,
        **{name: getattr(model, name) for name in ("travel_mm", "actuation_mm", "reset_mm")},
        "curves": [{"stroke": str(c.stroke), "velocity_mm_s": c.velocity_mm_s} for c in model.curves],
        "vibrations": len(model.vibrations),
    }
    return FileCheck(path, kind, facts, notes=tuple(model.provenance.assumptions))


def _program(path: Path, kind: str) -> FileCheck:
    program = load_program(path)
    facts = {
        "version": 1,
        "name": program.name,
        "travel_mm": program.travel_mm,
        "states": [state.name for state in program.states],
        **{name: len(getattr(program, name)) for name in ("surfaces", "signals", "vibrations")},
    }
    report = check_program(program)
    remedy = "change it; fdvv program check tells more"
    problems = tuple(FileProblem(f.state or f.place, str(f), remedy) for f in report.refused)
    return FileCheck(path, kind, facts, problems, tuple(map(str, report.warnings)))


def _image(path: Path, kind: str) -> FileCheck:
    held = describe(path.read_bytes(), path)
    facts = {name: getattr(held, name) for name in ("name", "size_bytes", "travel_mm")}
    return FileCheck(path, kind, {**facts, "states": len(held.states)})


def _rig(path: Path, kind: str) -> FileCheck:
    rig = asdict(load_rig(path))
    facts = {name: list(value) if isinstance(value, tuple) else value for name, value in rig.items()}
    return FileCheck(path, kind, {"version": 1, **facts})


def _jnds(path: Path, kind: str) -> FileCheck:
    facts = load_jnds(path).to_dict()
    return FileCheck(path, kind, {"version": 1, "of": facts.pop("origin"), **facts})


def _actuation(path: Path, kind: str) -> FileCheck:
    found = load_actuation(path)
    facts = {
        "method": found.method,
        "name": found.model_name,
        "device": found.device_name,
        "simulated": found.simulated,
        "travel_mm": found.travel_mm,
        "velocities_mm_s": found.surface.velocity_mm_s.tolist(),
        "curves": len(found.outcome.curves),
        "presses_skipped": len(found.skipped),
        "receipt": found.receipt is not None,
    }
    return FileCheck(path, kind, facts)


def _curves(path: Path) -> FileCheck:
    """Check a file of force curves. InputError on one that is none."""
    found = read_force_file(path)
    speeds = {c.velocity_mm_s for cycle in found.cycles for c in (cycle.press, cycle.release) if c}
    facts = {
        "name": found.name,
        "cycles": len(found.cycles),
        "presses": sum(cycle.press is not None for cycle in found.cycles),
        "releases": sum(cycle.release is not None for cycle in found.cycles),
        "velocities_mm_s": sorted(speed for speed in speeds if speed is not None),
        "size_bytes": path.stat().st_size,
    }
    return FileCheck(path, f"force curves ({found.format})", facts, (), found.warnings)


def _journal(path: Path, _kind: str) -> FileCheck:
    if path.name == PRESSES and (path.parent / MANIFEST).is_file():
        return check_session(path.parent)
    head = _head(path)[:80]
    for name in extras.installed("kinds"):
        journal: CheckedJournal = extras.load("kinds", name)
        if any(f'"record": {{"{key}": '.encode() in head for key in journal.first):
            return _guarded(path, journal.kind, journal.check)
    return check_recording(path)


def _log(path: Path, rate_Hz: float | None) -> FileCheck:
    try:
        found = read_log(path, rate_Hz=rate_Hz)
    except BuildError as error:
        raise InputError(path, "whole file", str(error), "install it and look again") from error
    except InputError as error:
        with suppress(InputError):
            return _curves(path)
        if "none of the known formats" in error.reason:
            raise InputError(path, "whole file", "is nothing that fdvv writes or reads", REMEDY) from None
        return unusable(path, "a log", error)
    form = found.sources[0].format if found.sources else ""
    facts = {"size_bytes": path.stat().st_size, **facts_of(found)}
    return FileCheck(path, f"a log ({form})", facts, (), found.warnings)


KINDS: tuple[tuple[bytes, str, Callable[[Path, str], FileCheck]], ...] = (
    (b'{"crc32": ', "a recording", _journal),
    (b'{"fdvv": "session"', "a recording of a device", lambda path, _kind: check_device_recording(path)),
    (b'"fdvv-model"', "an FDVV model", _model),
    (b'"fdvv-program"', "a program", _program),
    (b'"fdvv-rig"', "a known rig", _rig),
    (b'"fdvv-jnds"', "JNDs of a study", _jnds),
    (b'"fdvv-actuation"', "an actuation", _actuation),
    (b'"fdvv-session"', A_SESSION, lambda path, _kind: check_session(path.parent)),
    (b'"fdvv-receipt"', A_SESSION, lambda path, _kind: check_session(path.parent)),
    (IMAGE, "a program's image", _image),
)
"""The first bytes of each kind, and the function that checks it."""
