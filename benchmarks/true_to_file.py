"""Do the landmarks of real files lie where the files show them?

    python -m benchmarks.true_to_file [FOLDER]

FOLDER (../shared/data) holds a folder for every bench, as library_likeness reads them. One function of ROWS
asks one question; it gets all files that can be read, and yields lines: what was found and wanted, whether it
is met. Marks of bottom-out are in true_to_file_marks.csv, made by eye; files that FOLDER lacks are not
judged. Half of the files, by a hash of their names, may set thresholds; the other half only judges.
"""

from __future__ import annotations

import csv
import sys
import zlib
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from benchmarks.button_lines import Line
from benchmarks.library_likeness import BENCHES
from fdvv.button.fit import FitSettings, MeasuredParts, ModelFit, fit_force_file, measured_parts
from fdvv.errors import FdvvError
from fdvv.formats.force.read import read_force_file
from fdvv.formats.force.types import ForceFile
from fdvv.library.catalog import source_files

MARKS = Path(__file__).with_name("true_to_file_marks.csv")
CLOSE_mm = 0.05


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

    @property
    def judges(self) -> bool:
        """Whether the file is of the half that sets no threshold."""
        return zlib.crc32(self.key.encode()) % 2 == 1


def real_files(folder: Path) -> Iterator[RealFile]:
    """Read every file from whose measurements a model can be made."""
    for file in source_files([folder / bench for bench in BENCHES if (folder / bench).is_dir()]):
        try:
            found = RealFile(file.path.relative_to(folder).as_posix(), file.path, read_force_file(file.path))
            found.parts  # noqa: B018, raises where no stroke is left
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
        worst = max(off, key=lambda key: off[key], default="none")
        got = f"{close} of {len(off)} within {CLOSE_mm} mm; farthest {off.get(worst, 0):.2f} mm, {worst}"
        yield Line(f"bottom-out, {what}", got, ">= 98 %", close >= 0.98 * len(off))


def _off_mm(file: RealFile, mark_mm: float) -> float:
    """Return how far bottom-out is from a mark; 0 if both say that there is no stop."""
    no_stop = any("no stop found" in warning for warning in file.parts.warnings)
    if mark_mm != mark_mm or no_stop:
        return 0.0 if no_stop and mark_mm != mark_mm else float("inf")
    return abs(file.parts.zero_mm + file.parts.travel_mm - mark_mm)


ROWS: tuple[Callable[[Sequence[RealFile]], Iterator[Line]], ...] = (bottom_out,)


def main(folder: str = "../shared/data") -> None:
    """Print the table."""
    files = list(real_files(Path(folder)))
    print(f"{len(files)} files of {folder}")
    for row in ROWS:
        for line in row(files):
            print(f"{'met    ' if line.met else 'NOT MET'} {line.what}: {line.got} (wanted {line.wanted})")


if __name__ == "__main__":
    main(*sys.argv[1:2])
