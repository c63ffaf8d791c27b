"""Is any garbage taken for a button, does any file end in a traceback, or take long, or much memory?

    python -m benchmarks.mutilated [FILES] [FOLDER] [SET] [SEED]

FILES (1000) are spoilt, with fixed seeds, out of the measured files of FOLDER (by default ../shared/data or
FDVV_SHARED if there is one, and the shipped example), in turn by every way of SET: `first` is that of
`benchmarks.mutilations`, `second` that of `benchmarks.mutilations_second`; then `fdvv fit` reads each. A file
that is accepted is compared with the one it was made of, which no gate knows: every stroke must lie within
5 cN or 5 % of its range (RMS) of the stroke that was measured, aligned at contact, and no travel may be
longer. Less than half of the travel needs a warning. Two buttons in one file may not be accepted.
"""

from __future__ import annotations

import os
import resource
import sys
import tempfile
import time
from collections import Counter
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from benchmarks import mutilations, mutilations_second
from benchmarks.mutilations import OUT_OF_NOTHING, Mutilation, Table, table_of
from fdvv.button.fit import MeasuredParts, ModelFit, fit_file, measured_files, measured_parts
from fdvv.errors import FdvvError
from fdvv.formats.force.read import read_force_file
from fdvv.model.curve import MeasuredCurve

ROOT = Path(__file__).parents[1]
EXAMPLES = ROOT / "packages/fdvv/src/fdvv/button/examples"
SHARED = Path(os.environ.get("FDVV_SHARED", ROOT.parent / "shared")) / "data"
TWO = "two buttons in one"
OFF_cN, OFF_ratio, LONGER_mm = 5.0, 0.05, 0.3
SPRINGS = ("huge, a ramp",)
"""Made of nothing, and yet what a bare spring looks like."""
LONGEST_s, MOST_MB = 10.0, 1000.0
SUFFIXES = (".csv", ".json", ".txt")


@dataclass(frozen=True)
class Ways:
    """A set of ways to spoil a file, and the seed of its first file."""

    of_tables: Mapping[str, Mutilation]
    of_bytes: Mapping[str, Callable[[bytes, np.random.Generator], bytes]]
    others: Sequence[str]
    seed: int

    @property
    def kinds(self) -> list[str]:
        return [*self.of_tables, *self.of_bytes, *self.others]


WAYS = {
    "first": Ways(mutilations.OF_TABLES, mutilations.OF_BYTES, [TWO, *OUT_OF_NOTHING], 0),
    "second": Ways(mutilations_second.OF_TABLES, mutilations_second.OF_BYTES, [], 1_000_000),
}


@dataclass
class Found:
    """What became of the files."""

    kinds: Counter[str] = field(default_factory=Counter)
    accepted: Counter[str] = field(default_factory=Counter)
    garbage: list[str] = field(default_factory=list)
    tracebacks: list[str] = field(default_factory=list)
    unclear: list[str] = field(default_factory=list)
    slow: list[str] = field(default_factory=list)
    longest_s: float = 0.0
    most_MB: float = 0.0


def originals(folder: Path | None) -> list[tuple[Path, MeasuredParts]]:
    """Read what is to be spoilt; what cannot be read is passed over."""
    folders = [EXAMPLES, *([folder] if folder else [SHARED] if SHARED.is_dir() else [])]
    found = []
    for path in (path for folder in folders for path in measured_files(folder)):
        if path.suffix.lower() not in SUFFIXES:
            continue
        try:
            found.append((path, measured_parts(read_force_file(path))))
        except FdvvError:
            continue
    return found


def spoilt(
    files: Sequence[tuple[Path, MeasuredParts]],
    numbers: range,
    cheap: bool = False,
    ways: Ways = WAYS["first"],
) -> Iterator[tuple[str, str, bytes, MeasuredParts | None]]:
    """Make files: kind, name, content and what was measured (None where nothing was).

    cheap : leave out what takes a second or more to make and read.
    """
    kinds = ways.kinds
    if cheap:
        kinds = [
            kind
            for kind in kinds
            if "huge" not in kind and kind not in ("wide", "beyond the limit", "deep JSON")
        ]
    for number in numbers:
        kind, rng = kinds[number % len(kinds)], np.random.default_rng(ways.seed + number)
        if kind in OUT_OF_NOTHING:
            suffix = ".json" if "JSON" in kind else ".csv"
            yield kind, f"made{suffix}", OUT_OF_NOTHING[kind](rng), None
            continue
        path, parts, content = _one(kind, files, rng, ways)
        yield kind, path.name, content, parts


def _one(
    kind: str, files: Sequence[tuple[Path, MeasuredParts]], rng: np.random.Generator, ways: Ways
) -> tuple[Path, MeasuredParts, bytes]:
    while True:
        path, parts = files[int(rng.integers(len(files)))]
        if kind in ways.of_bytes:
            return path, parts, ways.of_bytes[kind](path.read_bytes(), rng)
        table = table_of(path)
        if table is None:
            continue
        if kind != TWO:
            made = ways.of_tables[kind](table, rng)
            return path, parts, made if isinstance(made, bytes) else made.encode()
        return path, parts, _joined(table, _other(table, parts, files, rng), rng)


def _other(
    table: Table, parts: MeasuredParts, files: Sequence[tuple[Path, MeasuredParts]], rng: np.random.Generator
) -> Table:
    """Choose another button of the same layout; without one, the same made stiffer."""
    for at in rng.permutation(len(files)):
        path, others = files[at]
        second = None if _alike(parts, others) else table_of(path)
        if second and second.pairs == table.pairs:
            return second
    return table.change(1, lambda force: 1.6 * force)


def _joined(table: Table, second: Table, rng: np.random.Generator) -> bytes:
    head = "\n".join(second.head) + "\n" if rng.random() < 0.5 else ""
    rows = second.text().removeprefix("\n".join(second.head)).lstrip("\n")
    return f"{table.text()}{head}{rows}".encode()


def _alike(a: MeasuredParts, b: MeasuredParts) -> bool:
    return a is b or abs(_work(a.strokes[0]) / _work(b.strokes[0]) - 1) < 0.4


def _work(stroke: MeasuredCurve) -> float:
    return float(np.trapezoid(stroke.force_cN, stroke.displacement_mm))


def verdict(kind: str, made: ModelFit, parts: MeasuredParts | None) -> str:
    """Say what is wrong with an accepted file; empty if it is what was measured."""
    if parts is None:
        return "" if kind in SPRINGS else "made of nothing"
    if kind == TWO:
        return "two buttons"
    if made.model.travel_mm > parts.travel_mm + LONGER_mm:
        return f"travel {made.model.travel_mm:.2f} mm instead of {parts.travel_mm:.2f} mm"
    if made.model.travel_mm < 0.5 * parts.travel_mm and not made.warnings:
        return f"travel {made.model.travel_mm:.2f} mm instead of {parts.travel_mm:.2f} mm, without a warning"
    return next((off for stroke in made.measured if (off := _off(stroke, parts))), "")


def _off(stroke: MeasuredCurve, parts: MeasuredParts) -> str:
    """Compare with the measured stroke nearest to it, contact on contact or as the file has it."""
    known = [s for s in parts.strokes if s.stroke is stroke.stroke]
    if not known:
        return f"a {stroke.stroke} that was not measured"
    x, force, _ = stroke.by_displacement()
    least = float("inf")
    for other in known:
        back, true, _ = other.by_displacement()
        for shift in (0.0, float(back[0] - x[0]), float(back[-1] - x[-1])):
            apart = force - np.interp(x + shift, back, true)
            least = min(
                least, float(np.sqrt(np.mean(apart**2))) / max(OFF_cN, OFF_ratio * float(np.ptp(true)))
            )
    return f"the {stroke.stroke} is {least:.1f} times the bound from what was measured" if least > 1 else ""


def run(numbers: range, folder: Path | None = None, cheap: bool = False, ways: Ways = WAYS["first"]) -> Found:
    """Spoil and fit; every file of its own is written, read and removed."""
    found = Found()
    files = originals(folder)
    with tempfile.TemporaryDirectory() as place:
        for kind, name, content, parts in spoilt(files, numbers, cheap, ways):
            path = Path(place) / name
            path.write_bytes(content)
            del content
            _fit(found, kind, path, parts)
            path.unlink()
    found.most_MB = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024
    return found


def _fit(found: Found, kind: str, path: Path, parts: MeasuredParts | None) -> None:
    label, began = f"{kind}: {path.name}", time.process_time()
    found.kinds[kind] += 1
    try:
        made = fit_file(path)
    except FdvvError as error:
        if "\n" in str(error) or not str(error).startswith(str(path)):
            found.unclear.append(f"{label}: {error}")
    except Exception as error:  # what the benchmark is for
        found.tracebacks.append(f"{label}: {type(error).__name__}: {error}"[:200])
    else:
        found.accepted[kind] += 1
        wrong = verdict(kind, made, parts)
        if wrong:
            found.garbage.append(f"{label}: {wrong}")
    took = time.process_time() - began
    found.longest_s = max(found.longest_s, took)
    if took > LONGEST_s:
        found.slow.append(f"{label}: {took:.1f} s")


def main(count: str = "1000", folder: str = "", of: str = "first", seed: str = "") -> None:
    """Print the figures."""
    ways = replace(WAYS[of], seed=int(seed)) if seed else WAYS[of]
    found = run(range(int(count)), Path(folder) if folder else None, ways=ways)
    print(f"{'way':32s} {'files':>6s} {'accepted':>9s}")
    for kind, number in found.kinds.items():
        print(f"{kind:32s} {number:6d} {found.accepted[kind]:9d}")
    for what in ("tracebacks", "garbage", "unclear", "slow"):
        lines = getattr(found, what)
        print(f"{what}: {len(lines)}", *(f"  {line}" for line in lines), sep="\n")
    print(f"longest: {found.longest_s:.1f} s of processor; most memory: {found.most_MB:.0f} MB")
    bad = found.tracebacks or found.garbage or found.unclear or found.slow or found.most_MB > MOST_MB
    raise SystemExit(1 if bad else 0)


if __name__ == "__main__":
    main(*sys.argv[1:5])
