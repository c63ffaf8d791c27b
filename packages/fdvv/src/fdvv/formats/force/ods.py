"""The Open Switch Curve Meter's .ods sheets: raw columns of microns, gf and contact, in three layouts.

Layout A has one header row and an index column, B two header rows, C the same without contact or tare;
comparison sheets repeat a raw group per button. In all of them a raw group is two neighbouring columns
titled X (microns) and Force (gf), and that is what is looked for.
"""

from __future__ import annotations

import io
import re
import zipfile
from collections.abc import Sequence
from pathlib import Path
from typing import Any
from xml.parsers import expat

import numpy as np

from fdvv.formats.force.text import LARGEST, LEAST_SAMPLES, refusal
from fdvv.formats.force.types import Notes, RawCycle, Reading, Track
from fdvv.units import cN_from_gf

LARGEST_CONTENT = 64 * 2**20
MOST_CELLS = 3_000_000
"""The largest real sheet unpacks to 3.6 MB and holds 100,000 cells."""
_X = re.compile(r"^(raw )?x \((microns|um|µm|μm)\)$", re.IGNORECASE)
_FORCE = re.compile(r"^(raw )?force \(gf?\)$", re.IGNORECASE)
_CLOSED = re.compile(r"^actuated ?\?$", re.IGNORECASE)
_ROW = re.compile(rb"<table:table-row")
_REPEAT = re.compile(rb'number-(rows|columns)-repeated="(\d{1,9})"')

Cells = Sequence[Sequence[Any]]


def is_ods(content: bytes) -> bool:
    """Recognise a zip archive; whether it is a spreadsheet shows when it is opened."""
    return content.startswith(b"PK")


def read_ods(source: Path, content: bytes, notes: Notes) -> Reading:
    """Read every raw group of every sheet."""
    _check_archive(source, content)
    cycles: list[RawCycle] = []
    reasons: list[str] = []
    for name, rows in _sheets(source, content):
        found = _raw_cycles(rows, notes)
        if found:
            cycles += found
        else:
            reasons.append(f"sheet {name[:30].replace(':', ' ')!r}: {_why_nothing(rows)}")
    if not cycles:
        place, reason = reasons[0].split(": ", 1) if reasons else ("whole file", "it holds no sheet")
        raise refusal(source, place, reason, "give a sheet with columns X (microns) and Force (gf)")
    for reason in reasons:
        notes.say(f"{reason}; it was not read")
    if len(cycles) > 1:
        notes.say(
            f"{len(cycles)} measurements side by side, perhaps of different buttons; "
            "each was kept as a cycle of its own"
        )
    return Reading("bluepylons-ods", source.stem.replace("-", " "), cycles)


def _check_archive(source: Path, content: bytes) -> None:
    """Refuse a bomb or a damaged archive before it is parsed."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            names = archive.namelist()
            if "content.xml" not in names:
                raise refusal(source, "whole file", "it is a zip archive but no .ods spreadsheet")
            size = sum(info.file_size for info in archive.infolist())
            if size > LARGEST_CONTENT or len(names) > 1000:
                reason = f"it unpacks to {size / 2**20:.0f} MiB; at most 64 are read"
                raise refusal(source, "whole file", reason)
            xml = archive.read("content.xml")
    except (zipfile.BadZipFile, zipfile.LargeZipFile, NotImplementedError, EOFError, OSError) as error:
        raise refusal(source, "whole file", f"the .ods archive is damaged ({error})") from None
    except (RuntimeError, ValueError, zipfile.zlib.error) as error:  # type: ignore[attr-defined]
        raise refusal(source, "whole file", f"the .ods archive cannot be unpacked ({error})") from None
    parser = expat.ParserCreate()
    try:
        parser.Parse(xml, True)  # the other parser goes on for ever where some elements are not closed
    except expat.ExpatError as error:
        raise refusal(source, "content.xml", f"it is not well formed ({error})") from None
    cells = _count_cells(xml)
    if cells > MOST_CELLS:
        reason = f"its repeats unfold to {cells} cells; at most {MOST_CELLS} are read"
        raise refusal(source, "content.xml", reason)


def _count_cells(xml: bytes) -> int:
    """Bound the cells that repeated rows and columns unfold to; rows without a value cost nothing."""
    total = 0
    for row in _ROW.split(xml)[1:]:
        if b"office:value" not in row and b"<text:p" not in row:
            continue
        repeats = {b"rows": 1, b"columns": 0}
        for kind, count in _REPEAT.findall(row):
            repeats[kind] = max(1, int(count)) if kind == b"rows" else repeats[kind] + int(count)
        total += repeats[b"rows"] * (repeats[b"columns"] + row.count(b"<table:table-cell"))
    return total


def _sheets(source: Path, content: bytes) -> list[tuple[str, Cells]]:
    """Parse the archive; the parser's own failures, panics included, become one line."""
    import python_calamine

    try:
        book = python_calamine.load_workbook(io.BytesIO(content))
        return [(name, book.get_sheet_by_name(name).to_python()) for name in book.sheet_names]
    except (KeyboardInterrupt, SystemExit, MemoryError):
        raise
    except BaseException as error:  # a panic of the parser is no Exception
        message = str(error)[:80] or type(error).__name__
        raise refusal(source, "whole file", f"the .ods cannot be parsed ({message})") from None


def _why_nothing(rows: Cells) -> str:
    titles = [str(cell) for row in rows[:4] for cell in row if isinstance(cell, str) and cell]
    if not titles and len(rows) == 0:
        return "it is empty"
    if any(_X.match(title.strip()) for title in titles):
        return "its raw columns hold no numbers (an empty template)"
    if any("corrected" in title.lower() for title in titles):
        return "it has corrected columns only, no raw X (microns) and Force (gf)"
    return "it has no columns X (microns) and Force (gf)"


def _raw_cycles(rows: Cells, notes: Notes) -> list[RawCycle]:
    for at, row in enumerate(rows[:4]):
        titles = [cell.strip() if isinstance(cell, str) else "" for cell in row]
        groups = [i for i in range(len(titles) - 1) if _X.match(titles[i]) and _FORCE.match(titles[i + 1])]
        if groups:
            above = rows[at - 1] if at else []
            found = [_group(rows, at + 1, i, titles, _label(above, titles, i), notes) for i in groups]
            cycles = [cycle for cycle in found if cycle is not None]
            # a single group needs no label
            return cycles if len(cycles) > 1 else [RawCycle("", run=c.run) for c in cycles]
    return []


def _label(above: Sequence[Any], titles: list[str], column: int) -> str:
    words = [str(above[i]).strip() for i in (column, column + 1) if i < len(above) and str(above[i]).strip()]
    return " ".join(word for word in words if word.lower() not in ("raw", "raw data")) or titles[column]


def _group(
    rows: Cells, start: int, column: int, titles: list[str], label: str, notes: Notes
) -> RawCycle | None:
    """Read one raw group; rows with text among the numbers are left out with a note."""
    contact = column + 2 < len(titles) and bool(_CLOSED.match(titles[column + 2]))
    picks = range(column, column + (3 if contact else 2))
    kept: list[list[float]] = []
    bad: list[tuple[int, int, Any]] = []
    for offset, row in enumerate(rows[start:]):
        values = [row[i] for i in picks]
        if all(value == "" or value is None for value in values[:2]):
            continue
        wrong = [i for i, value in zip(picks, values, strict=True) if not _is_number(value)]
        if wrong:
            bad.append((start + offset + 1, wrong[0] + 1, row[wrong[0]]))
        else:
            kept.append([float(value) for value in values])
    if bad:
        line, place, value = bad[0]
        notes.say(
            f"row {line}, column {place}: {str(value)[:20]!r} is no usable number; {len(bad)} such rows of "
            f"{len(bad) + len(kept)} were left out"
        )
    if len(kept) < LEAST_SAMPLES:
        return None
    x, force, *closed = np.array(kept, dtype=np.float64).T
    return RawCycle(label, run=Track("run", np.round(x * 1e-3, 9), cN_from_gf(force), None, *closed))


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) <= LARGEST
