"""Checks of session folders and device recordings, and the binned force of a press."""

from __future__ import annotations

import base64
import binascii
import zlib
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm, split_strokes
from fdvv.compensation.tables import bin_force, grid_mm
from fdvv.device.recording import read_session, unpack_press, unpack_surface
from fdvv.errors import InputError
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import Jnds
from fdvv.model.press import Press
from fdvv.recording.check import FileCheck, FileProblem, unusable
from fdvv.rendering.run_summary import RECEIPT, read_run_summary
from fdvv.rendering.session import MANIFEST, Manifest, read_manifest
from fdvv.rendering.session_log import PRESSES, PressEntry, PressLog, SessionRun
from fdvv.units import FloatArray

A_SESSION, A_DEVICE_RECORDING = "a session", "a recording of a device"
GO_ON = "run the session's command again, which goes on"


def check_session(folder: Path) -> FileCheck:
    """Read a session's folder with every column of every press."""
    try:
        manifest = read_manifest(folder / MANIFEST)
        there = (folder / PRESSES).is_file()
        runs, entries, end = PressLog.read(folder / PRESSES) if there else ([], [], 0)
        finished = (folder / RECEIPT).is_file()
        if finished:
            read_run_summary(folder)
    except InputError as error:
        return unusable(folder, A_SESSION, error)
    problems = []
    if there and end < (folder / PRESSES).stat().st_size:
        reason = f"the last record is not whole and is left out; presses kept: {len(entries)}"
        problems.append(FileProblem(PRESSES, reason, GO_ON))
    if not entries:
        problems.append(FileProblem(PRESSES, "holds no press", GO_ON))
    notes = () if finished else ("not finished: there is no receipt yet",)
    return FileCheck(folder, A_SESSION, _facts(manifest, runs, entries), tuple(problems), notes)


def _facts(manifest: Manifest, runs: Sequence[SessionRun], entries: Sequence[PressEntry]) -> dict[str, Any]:
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
    problems: list[FileProblem] = []
    held: Counter[str] = Counter()
    for number, line in enumerate(lines, 1):
        key = next(iter(line), "")
        held[key] += 1
        try:
            _try_unpack(key, line.get(key))
        except (ValueError, TypeError, KeyError, AttributeError, zlib.error, binascii.Error) as error:
            place = f"record {number} of the last session"
            problems.append(FileProblem(place, f"{key or 'nothing'}: {error}", "record it again"))
    if not path.read_bytes().endswith(b"\n"):
        reason = "the last line is not whole and is left out"
        problems.append(FileProblem("end of file", reason, "record further, which goes on behind it"))
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


def _try_unpack(key: str, body: Any) -> None:
    """Read a record as a replay would; ValueError and its like if it cannot be."""
    if key == "press":
        unpack_press(body)
    elif key == "upload":
        unpack_surface(body["surface"])
    elif key == "program":
        base64.b64decode(body, validate=True)
    elif key not in ("settings", "error"):
        raise ValueError("is no record of a session")


BIN_mm = 0.05  # the paper's bin of displacement (docs/explanation/paper-law.md)


@dataclass(frozen=True, eq=False)
class RenderedPress:
    """Force of both strokes on a grid of true displacement.

    Attributes
    ----------
    displacement_mm : (n,) bins of 0.05 mm over the travel.
    press_cN, release_cN : (n,); NaN where the stroke was not.
    """

    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray


def bin_press(press: Press, travel_mm: float) -> RenderedPress:
    """Bin the force on the finger of both strokes; a press that turned early has what it has."""
    grid = grid_mm(travel_mm, BIN_mm)
    x, force = press.displacement_mm, press.force_cN
    down, up = (bin_force(x[rows], force[rows], grid) for rows in split_strokes(x, travel_mm))
    return RenderedPress(grid, down, up)


def target_press(model: FDVVModel, velocity_mm_s: float) -> RenderedPress:
    """Return what a model intends at a speed, on the grid of bin_press."""
    grid = grid_mm(model.travel_mm, BIN_mm)
    # without a release curve the press serves for both, as on a device
    served = (stroke if model.of(stroke) else Stroke.PRESS for stroke in Stroke)
    down, up = (model.force_cN(grid, velocity_mm_s, stroke) for stroke in served)
    return RenderedPress(grid, down, up)


def noticeable_cN(model: FDVVModel, velocity_mm_s: float, jnds: Jnds) -> tuple[float, float]:
    """Return the just noticeable difference of force, press and release: its mean over the judged places."""
    wanted = target_press(model, velocity_mm_s)
    judged = (wanted.displacement_mm >= FROM_mm) & (wanted.displacement_mm <= model.travel_mm - STOP_GUARD_mm)
    forces = (wanted.press_cN, wanted.release_cN)
    down, up = (float(jnds.force_cN(row[judged]).mean()) for row in forces)
    return down, up
