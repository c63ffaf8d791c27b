"""Do the landmarks of real files lie where the files show them?

    python -m benchmarks.true_to_file [FOLDER]

FOLDER (../shared/data) holds a folder for every bench, as library_likeness reads them. One function of ROWS
asks one question; it gets all files that can be read, and yields lines: what was found and wanted, whether it
is met. Marks of bottom-out are in true_to_file_marks.csv, made by eye; files that FOLDER lacks are not
judged. Half of the files, by a hash of their names, may set thresholds; the other half only judges.
"""

from __future__ import annotations

import csv
import re
import sys
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from pathlib import Path

import numpy as np

from benchmarks.button_lines import Line
from benchmarks.library_likeness import BENCHES
from fdvv.button.fit import FitSettings, MeasuredParts, ModelFit, fit_force_file, measured_parts
from fdvv.button.kind import kind_of
from fdvv.errors import FdvvError
from fdvv.formats.force.read import read_force_file
from fdvv.formats.force.types import ForceFile
from fdvv.model.bump import STOP_LEAST_cN_mm, find_contact_mm
from fdvv.model.curve import Stroke
from fdvv.model.landmarks import landmarks
from fdvv.model.model import FDVVModel
from fdvv_studio.library.catalog import source_files
from fdvv_studio.library.figures import polyline_model

MARKS = Path(__file__).with_name("true_to_file_marks.csv")
CLOSE_mm = 0.05
RISE_mm = 0.05
DOMES = re.compile("Topre|Rubber Dome|Korean Dome|Lenovo P51")


@dataclass(frozen=True)
class RealFile:
    """A file that could be read; its key is the path below FOLDER."""

    key: str
    path: Path
    force_file: ForceFile

    @cached_property
    def parts(self) -> MeasuredParts:
        return measured_parts(self.force_file)

    @cached_property
    def fit(self) -> ModelFit:
        return fit_force_file(self.force_file, FitSettings(), self.path.name)

    @cached_property
    def model(self) -> FDVVModel:
        """The measured strokes, joined by lines: no fit is between a file and its landmarks."""
        return polyline_model(self.parts, self.path.stem)

    @property
    def switch(self) -> str:
        """The name that files of one switch share."""
        return self.path.parent.name if "buddyog" in self.key else self.path.stem.split("__")[0]

    @property
    def judges(self) -> bool:
        """Whether the file is of the half that sets no threshold."""
        return zlib.crc32(self.key.encode()) % 2 == 1


def real_files(folder: Path) -> Iterator[RealFile]:
    """Read every file from whose measurements a model can be made."""
    for file in source_files([folder / bench for bench in BENCHES if (folder / bench).is_dir()]):
        try:
            found = RealFile(file.path.relative_to(folder).as_posix(), file.path, read_force_file(file.path))
            found.model  # noqa: B018, raises where no stroke is left
        except FdvvError:
            continue
        yield found


def marks() -> dict[str, tuple[float, float]]:
    """Read the marks: bottom-out and its doubt in mm of the file, by key; NaN where there is no stop."""
    lines = (line for line in MARKS.read_text().splitlines() if not line.startswith("#"))
    return {
        row["file"]: (float(row["bottom_out_mm"] or "nan"), float(row["doubt_mm"] or "nan"))
        for row in csv.DictReader(lines)
    }


def bottom_out(files: Sequence[RealFile]) -> Iterator[Line]:
    """Compare bottom-out with the marks."""
    known = marks()
    of = [(file, *known[file.key]) for file in files if file.key in known]
    for what, some in (("all", of), ("judging half", [one for one in of if one[0].judges])):
        off = {file.key: _off_mm(file, mark) for file, mark, _ in some}
        close = sum(value <= CLOSE_mm for value in off.values())
        doubtful = sum(off[file.key] <= max(CLOSE_mm, doubt) or off[file.key] == 0 for file, _, doubt in some)
        worst = max(off, key=lambda key: off[key], default="none")
        got = f"{close} of {len(off)} within {CLOSE_mm} mm, {doubtful} within that or the mark's doubt; "
        got += f"farthest {off.get(worst, 0):.2f} mm, {worst}"
        yield Line(f"bottom-out, {what}", got, ">= 98 %", close >= 0.98 * len(off))


def _off_mm(file: RealFile, mark_mm: float) -> float:
    """Return how far bottom-out is from a mark; 0 if both say that there is no stop."""
    no_stop = any("no stop found" in warning for warning in file.parts.warnings)
    if mark_mm != mark_mm or no_stop:
        return 0.0 if no_stop and mark_mm != mark_mm else float("inf")
    return abs(file.parts.zero_mm + file.parts.travel_mm - mark_mm)


def peaks(files: Sequence[RealFile]) -> Iterator[Line]:
    """Count peaks in the stop: deeper than half the travel, and reached by a tenth at a stop's slope."""
    inside = []
    for file in files:
        if file.model.of(Stroke.PRESS):
            found, press = landmarks(file.model), file.model.nearest(Stroke.PRESS)
            if press and found.peak_mm and found.peak_mm > 0.5 * found.bottom_out_mm:
                before_cN, peak_cN = map(float, press.force_cN([found.peak_mm - RISE_mm, found.peak_mm]))
                steep = peak_cN - before_cN > max(STOP_LEAST_cN_mm * RISE_mm, 0.1 * peak_cN)
                inside += [file.key] if steep else []
    yield Line("peaks in the stop", f"{len(inside)} {' '.join(inside[:3])}", "0", not inside)


def touches(files: Sequence[RealFile]) -> Iterator[Line]:
    """Put one sample of 13 cN into the air 0.135 mm before contact: does contact stay?"""
    moved, tried = [], 0
    for file in files:
        for cycle in file.force_file.cycles[:1]:
            press = cycle.press
            at = press and np.searchsorted(press.displacement_mm, find_contact_mm(press) - 0.135)
            if press is None or not at or at < 3:
                continue
            force = press.force_cN.copy()
            force[at] = 13.0
            tried += 1
            off_mm = find_contact_mm(replace(press, force_cN=force)) - find_contact_mm(press)
            moved += [file.key] if abs(off_mm) > 0.01 else []
    got = f"moved in {len(moved)} of {tried} files {' '.join(moved[:3])}"
    yield Line("contact, one sample of 13 cN in the air", got, "0", not moved)


def kinds(files: Sequence[RealFile]) -> Iterator[Line]:
    """Judge what the curve suggests by what is stated: labels of ThereminGoat, domes by their collection."""
    labels = _labels(files)
    seen = {file.switch for file in files if not file.judges}
    of = [(file, kind) for file in files if (kind := _true_kind(file, labels))]
    halves = {
        "all": of,
        "judging half": [one for one in of if one[0].judges],
        "judging half, no other file of the switch in the first": [
            one for one in of if one[0].judges and one[0].switch not in seen
        ],
    }
    for kind in ("clicky", "dome"):
        for what, some in halves.items():
            called = [str(kind_of(file.model).kind).rstrip("?") == kind for file, _ in some]
            true = [label == kind for _, label in some]
            hits = sum(a and b for a, b in zip(called, true, strict=True))
            got = f"found {hits} of {sum(true)}, right for {hits} of {sum(called)} of {len(some)} files"
            met = hits >= 0.8 * sum(true) and hits >= 0.9 * sum(called)
            yield Line(f"{kind}, {what}", got, "recall >= 80 %, precision >= 90 %", met)


def _labels(files: Sequence[RealFile]) -> dict[str, str]:
    """Read the table of types beside the files of ThereminGoat; empty if it is not there."""
    folders = {Path(str(file.path)[: -len(file.key)]) for file in files}
    tables = [folder / "tg-strokes" / "switchmeta.csv" for folder in folders]
    lines = [line for table in tables if table.is_file() for line in table.read_text().splitlines()]
    return {row[0].strip(): row[1].strip() for row in csv.reader(lines) if len(row) == 2}


def _true_kind(file: RealFile, labels: dict[str, str]) -> str:
    bench = file.key.partition("/")[0]
    if bench == "buddyog-topre" or (bench == "haata" and DOMES.search(file.key)):
        return "dome"
    kind = labels.get(file.switch, "") if bench == "tg-tidy" else ""
    return kind if kind in ("linear", "tactile", "clicky") else ""


ROWS: tuple[Callable[[Sequence[RealFile]], Iterator[Line]], ...] = (bottom_out, peaks, touches, kinds)


def main(folder: str = "../shared/data") -> None:
    """Print the table."""
    files = list(real_files(Path(folder).resolve()))
    print(f"{len(files)} files of {folder}")
    for row in ROWS:
        for line in row(files):
            print(f"{'met    ' if line.met else 'NOT MET'} {line.what}: {line.got} (wanted {line.wanted})")


if __name__ == "__main__":
    main(*sys.argv[1:2])
