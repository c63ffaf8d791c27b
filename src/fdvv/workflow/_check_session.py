"""Check what sessions and recorded devices leave on file, press by press."""

from __future__ import annotations

import base64
import binascii
import zlib
from collections import Counter
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from fdvv.device import read_session, unpack_press, unpack_surface
from fdvv.errors import InputError
from fdvv.recording import FileCheck, Problem, unusable
from fdvv.workflow._receipt import RECEIPT, read_receipt
from fdvv.workflow._session_file import Run
from fdvv.workflow._session_log import PRESSES, Entry, read_log
from fdvv.workflow._session_manifest import MANIFEST, Manifest, read_manifest

A_SESSION, A_DEVICE_RECORDING = "a session", "a recording of a device"
GO_ON = "run the session's command again, which goes on"


def check_session(folder: Path) -> FileCheck:
    """Read a session's folder with every column of every press."""
    try:
        manifest = read_manifest(folder / MANIFEST)
        there = (folder / PRESSES).is_file()
        runs, entries, end = read_log(folder / PRESSES) if there else ([], [], 0)
        finished = (folder / RECEIPT).is_file()
        if finished:
            read_receipt(folder)
    except InputError as error:
        return unusable(folder, A_SESSION, error)
    problems = []
    if there and end < (folder / PRESSES).stat().st_size:
        reason = f"the last record is not whole and is left out; presses kept: {len(entries)}"
        problems.append(Problem(PRESSES, reason, GO_ON))
    if not entries:
        problems.append(Problem(PRESSES, "holds no press", GO_ON))
    notes = () if finished else ("not finished: there is no receipt yet",)
    return FileCheck(folder, A_SESSION, _facts(manifest, runs, entries), tuple(problems), notes)


def _facts(manifest: Manifest, runs: Sequence[Run], entries: Sequence[Entry]) -> dict[str, Any]:
    return {
        "version": manifest.version,
        "task": manifest.task,
        "name": manifest.model.name,
        "device": manifest.device.get("name"),
        "method": manifest.method,
        "simulated": manifest.simulated,
        "velocities_mm_s": manifest.velocities_mm_s,
        "runs": len(runs),
        "presses": len(entries),
        "presses_used": sum(entry.used for entry in entries),
        "begun": runs[0].started if runs else manifest.created,
        "last_press": entries[-1].made if entries else None,
    }


def check_device_recording(path: Path) -> FileCheck:
    """Read the last session of a recorded device with every column of every press."""
    head, *lines = read_session(path)
    problems: list[Problem] = []
    held: Counter[str] = Counter()
    for number, line in enumerate(lines, 1):
        key = next(iter(line), "")
        held[key] += 1
        try:
            _unpacked(key, line.get(key))
        except (ValueError, TypeError, KeyError, AttributeError, zlib.error, binascii.Error) as error:
            place = f"record {number} of the last session"
            problems.append(Problem(place, f"{key or 'nothing'}: {error}", "record it again"))
    if not path.read_bytes().endswith(b"\n"):
        reason = "the last line is not whole and is left out"
        problems.append(Problem("end of file", reason, "record further, which goes on behind it"))
    info = head.get("info", {})
    facts = {
        "version": head["format"],
        "device": info.get("name"),
        "simulated": info.get("simulated"),
        "uploads": held["upload"],
        "programs": held["program"],
        "presses": held["press"],
        "errors": held["error"],
    }
    return FileCheck(path, A_DEVICE_RECORDING, facts, tuple(problems))


def _unpacked(key: str, found: Any) -> None:
    """Read a record as a replay would; ValueError and its like if it cannot be."""
    if key == "press":
        unpack_press(found)
    elif key == "upload":
        unpack_surface(found["surface"])
    elif key == "program":
        base64.b64decode(found, validate=True)
    elif key not in ("settings", "error"):
        raise ValueError("is no record of a session")
