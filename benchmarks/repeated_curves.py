"""Thousands of files of force curves out of real ones, each a fresh repeat with the noise of real repeats.

What repeats on one bench differ by is taken from files that hold several cycles of one button, those that
capture averages: force of a cycle less the mean of all, over the travel, and how far contacts lie apart. A
copy of a file is its strokes with one such difference, forward or turned over, stretched over its travel,
and a shift. Nothing is smoothed or made up. Where no file holds repeats, the difference of a curve from its
own mean over 50 um stands in, and the run says so. Copies are written in the layout the original was read
from, or the nearest there is a writer of.
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from fdvv.button.fit import measured_files
from fdvv.errors import FdvvError
from fdvv.formats.force.average import average_by_velocity
from fdvv.formats.force.read import read_force_file
from fdvv.formats.force.types import Cycle, ForceFile
from fdvv.model.bump import find_contact_mm, running_mean
from fdvv.model.curve import MeasuredCurve, Stroke
from fdvv.model.file import builtin_names, load_builtin
from fdvv.model.fit import active_part
from fdvv.units import FloatArray

GF_cN = 0.980665
POINTS = 401
LARGEST_cN = 10.0
"""Root mean square: cycles further apart than this are sheets that compare different buttons side by side."""


@dataclass(frozen=True, eq=False)
class RepeatNoise:
    """Differences of repeats: press and release over parts of the travel, (n, 2, 401); shifts, (m,)."""

    force_cN: FloatArray
    shift_mm: FloatArray
    from_repeats: bool

    def draw(self, random: np.random.Generator) -> tuple[FloatArray, float]:
        """Draw one repeat's difference and shift."""
        at = int(random.integers(len(self.force_cN)))
        return self.force_cN[at] * random.choice((-1.0, 1.0)), float(random.choice(self.shift_mm))


def readable(folder: Path) -> list[ForceFile]:
    """Read what can be read of a folder's measured files, with a press and a release in the first cycle."""
    found = []
    for path in measured_files(folder):
        try:
            file = read_force_file(path)
        except FdvvError:
            continue
        if file.cycles[0].press is not None and file.cycles[0].release is not None:
            found.append(file)
    return found


def shipped() -> list[ForceFile]:
    """Return the built-in buttons as files, sampled every 5 um, for where there are no measurements."""
    found = []
    for name in builtin_names():
        model = load_builtin(name)
        x = np.arange(0.0, model.travel_mm + 0.05, 0.005)
        press, release = (MeasuredCurve(x, model.of(s)[0].force_cN(x), s) for s in Stroke)
        found.append(ForceFile(name, "plain-csv", (Cycle(press, release),)))
    return found


def repeat_noise(files: Sequence[ForceFile]) -> RepeatNoise:
    """Take the differences of repeats out of the files that hold some."""
    forces, shifts = [], [0.0]
    for file in files:
        used = {label for group in average_by_velocity(file) for label in group.used}
        kept = [cycle for cycle in file.cycles if cycle.label in used]
        strokes = [pair for cycle in kept if (pair := _aligned(cycle)) is not None]
        if len(strokes) < 2:
            continue
        table = np.array([force for force, _ in strokes])
        apart = (table - table.mean(axis=0)) * np.sqrt(len(table) / (len(table) - 1))
        whole = np.sqrt(np.mean(apart**2, axis=(1, 2)))
        if whole.max() > LARGEST_cN:
            continue
        forces += list(apart)
        contacts = np.array([contact for _, contact in strokes])
        shifts += (contacts - contacts.mean()).tolist()
    if forces:
        return RepeatNoise(np.array(forces), np.array(shifts), from_repeats=True)
    table = np.array([pair[0] for file in files if (pair := _aligned(file.cycles[0])) is not None])
    places = np.linspace(0.0, 0.01 * (POINTS - 1), POINTS)
    smooth = np.array([[running_mean(places, s, 0.05) for s in pair] for pair in table])
    return RepeatNoise(table - smooth, np.zeros(1), from_repeats=False)


def _aligned(cycle: Cycle) -> tuple[FloatArray, float] | None:
    """Return force of press and release over parts of the active travel, (2, 401), and where contact lies."""
    if cycle.press is None or cycle.release is None:
        return None
    try:
        parts = [active_part(stroke) for stroke in (cycle.press, cycle.release)]
        contact = find_contact_mm(cycle.press)
    except FdvvError:
        return None
    forces = []
    for part in parts:
        x, force, _ = part.by_displacement()
        forces.append(np.interp(np.linspace(0, 0.97, POINTS), (x - x[0]) / (x[-1] - x[0]), force))
    return np.array(forces), contact


def repeated(file: ForceFile, noise: RepeatNoise, random: np.random.Generator) -> ForceFile:
    """Measure a file's button once more."""
    cycles = []
    for cycle in file.cycles:
        force, shift = noise.draw(random)
        press, release = _again(cycle.press, force[0], shift), _again(cycle.release, force[1], shift)
        closes, opens = (None if p is None else p + shift for p in (cycle.actuation_mm, cycle.reset_mm))
        cycles.append(Cycle(press, release, closes, opens, cycle.label))
    return ForceFile(file.name, file.format, tuple(cycles))


def _again(stroke: MeasuredCurve | None, force_cN: FloatArray, shift_mm: float) -> MeasuredCurve | None:
    if stroke is None:
        return None
    x = stroke.displacement_mm
    try:
        begin, end = find_contact_mm(stroke), float(x.max())
    except FdvvError:
        begin, end = float(x.min()), float(x.max())
    part = (x - begin) / max(end - begin, 0.1)
    extra = np.interp(part, np.linspace(0, 1, POINTS), force_cN, left=0.0, right=float(force_cN[-1]))
    return MeasuredCurve(x + shift_mm, stroke.force_cN + extra, stroke.stroke, stroke.velocity_mm_s)


def write(file: ForceFile, stem: Path) -> int:
    """Write a file in its layout; give its bytes."""
    writer = {"haata": _haata, "bluepylons-ods": _ods}.get(file.format, _tidy)
    ending = ".ods" if writer is _ods else ".csv"
    content = writer(file)
    path = stem.with_name(stem.name + ending)
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content)
    return len(content)


def _run(cycle: Cycle) -> list[tuple[float, float]]:
    """Return displacement in mm and force in gf along press and release."""
    rows: list[tuple[float, float]] = []
    for stroke, step in ((cycle.press, 1), (cycle.release, -1)):
        if stroke is not None:
            pairs = zip(stroke.displacement_mm.tolist(), (stroke.force_cN / GF_cN).tolist(), strict=True)
            rows += list(pairs)[::step]
    return rows


def _tidy(file: ForceFile) -> bytes:
    lines = [f"{f:.1f},{x:.3f},{int(f > 200)},{file.name.replace(',', ' ')}" for x, f in _run(file.cycles[0])]
    return ("force,displacement,judge,name\n" + "\n".join(lines) + "\n").encode()


def _haata(file: ForceFile) -> bytes:
    heads, columns = [], []
    for number, cycle in enumerate(file.cycles, 1):
        for word, stroke in (("Press", cycle.press), ("Release", cycle.release)):
            if stroke is not None:
                heads += [f"{word} {number}, x", f"{word} {number}, y"]
                columns += [stroke.displacement_mm.tolist(), (stroke.force_cN / GF_cN).tolist()]
    rows = [heads]
    for i in range(max(map(len, columns))):
        rows += [[f"{c[i]:.4f}" if i < len(c) else "" for c in columns]]
    return "\r\n".join(",".join(f'"{cell}"' for cell in row) for row in rows).encode()


def _ods(file: ForceFile) -> bytes:
    """Write a spreadsheet of the least there is: X in microns beside force in gf."""
    cell = (
        '<table:table-cell office:value-type="float" office:value="{0:g}">'
        "<text:p>{0:g}</text:p></table:table-cell>"
    )
    text = '<table:table-cell office:value-type="string"><text:p>{}</text:p></table:table-cell>'
    head = text.format("X (microns)") + text.format("Force (gf)")
    rows = [cell.format(round(1000 * x)) + cell.format(round(f, 2)) for x, f in _run(file.cycles[0])]
    table = "".join(f"<table:table-row>{row}</table:table-row>" for row in (head, *rows))
    names = "".join(
        f' xmlns:{short}="urn:oasis:names:tc:opendocument:xmlns:{long}:1.0"'
        for short, long in (("office", "office"), ("table", "table"), ("text", "text"))
    )
    content = (
        f'<?xml version="1.0" encoding="UTF-8"?><office:document-content{names}><office:body>'
        f'<office:spreadsheet><table:table table:name="Sheet1">{table}</table:table></office:spreadsheet>'
        "</office:body></office:document-content>"
    )
    kind = "application/vnd.oasis.opendocument.spreadsheet"
    manifest = (
        '<?xml version="1.0" encoding="UTF-8"?><manifest:manifest '
        'xmlns:manifest="urn:oasis:names:tc:opendocument:xmlns:manifest:1.0">'
        f'<manifest:file-entry manifest:full-path="/" manifest:media-type="{kind}"/></manifest:manifest>'
    )
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("mimetype", kind)
        archive.writestr("META-INF/manifest.xml", manifest)
        archive.writestr("content.xml", content)
    return buffer.getvalue()


def write_many(
    files: Sequence[ForceFile], folder: Path, count: int, seed: int = 0
) -> tuple[RepeatNoise, int]:
    """Write so many files below a folder, a hundred in each; give the noise that was used and all bytes."""
    noise, random = repeat_noise(files), np.random.default_rng(seed)
    size = 0
    for i in range(count):
        original = files[i % len(files)]
        name = "".join(c if c.isalnum() or c in " -_" else "_" for c in original.name)[:60]
        stem = folder / f"repeat {i // len(files):03}" / f"{name} {i:05}"
        size += write(repeated(original, noise, random), stem)
    return noise, size
