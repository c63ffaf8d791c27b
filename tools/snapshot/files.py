"""What a command printed or wrote, as text: by the kind of the file."""

from __future__ import annotations

import csv
import io
import json
import re
from itertools import groupby
from pathlib import Path
from typing import Any

from tools.snapshot.normalise import Normaliser
from tools.snapshot.pages import page_text
from tools.snapshot.values import digest, lines_of, list_lines

LONG_lines = 60
HEAD_lines = 20
TABLE_rows = 12
PAGES = (".html", ".svg")


def text_of(name: str, data: bytes, normaliser: Normaliser) -> str:
    """Return a file as text."""
    suffix = Path(name).suffix
    if suffix == ".npz":
        return value_text(arrays(data), normaliser)
    if suffix == ".parquet":
        return value_text(columns(data), normaliser)
    try:
        text = data.decode()
    except UnicodeDecodeError:
        return f"{len(data)} bytes {digest(data)}"
    if suffix == ".jsonl":
        return journal_text(text, normaliser)
    if text.startswith(("{", "[")):
        try:
            return value_text(json.loads(text), normaliser)
        except json.JSONDecodeError:
            pass
    if suffix == ".csv" and text.count("\n") > TABLE_rows and (table := table_of(text)):
        return value_text(table, normaliser)
    return plain_text(suffix, normaliser.text(text))


def value_text(value: object, normaliser: Normaliser) -> str:
    return "\n".join(lines_of(normaliser.value(value)))


def arrays(data: bytes) -> dict[str, Any]:
    """Return the arrays of an .npz file as lists."""
    import numpy as np

    with np.load(io.BytesIO(data)) as archive:
        return {name: archive[name].tolist() for name in archive.files}


def columns(data: bytes) -> dict[str, Any]:
    """Return the columns of a Parquet file."""
    import pyarrow.parquet

    table = pyarrow.parquet.read_table(io.BytesIO(data))
    return {name: table[name].to_pylist() for name in table.column_names}


def journal_text(text: str, normaliser: Normaliser) -> str:
    """Return a journal: the kinds of its lines in their order, then the lines of each kind."""
    records = [normaliser.value(json.loads(line)) for line in text.splitlines()]
    kinds: dict[str, list[object]] = {}
    for record in records:
        kinds.setdefault(kind_of(record), []).append(record)
    runs = [(kind, len(list(group))) for kind, group in groupby(map(kind_of, records))]
    order = ", ".join(f"{kind} x{count}" if count > 1 else kind for kind, count in runs[:HEAD_lines])
    lines = [f"order: {order}{f', ... {len(runs)} runs {digest(runs)}' if len(runs) > HEAD_lines else ''}"]
    for kind, values in kinds.items():
        lines += [f"{kind}:", *(f"  {line}" for line in list_lines(values))]
    return "\n".join(lines)


def kind_of(line: object) -> str:
    """Return the kind of a journal's line: the first field of its record."""
    record = line.get("record", line) if isinstance(line, dict) else {}
    return next(iter(record), "?") if isinstance(record, dict) else "?"


def plain_text(suffix: str, text: str) -> str:
    """Return a page as what it shows; another long text by its head and its digest."""
    if suffix in PAGES:
        return page_text(text)
    lines = text.splitlines()
    if suffix == ".dxf":  # ezdxf writes the classes in the order of a set
        lines = sorted(lines)
    if len(lines) > LONG_lines:
        return "\n".join([*lines[:HEAD_lines], f"... {len(lines)} lines {digest(lines)}"])
    return "\n".join(line.rstrip() for line in lines)


def table_of(text: str) -> dict[str, list[Any]] | None:
    """Return the columns of a CSV file with a head; None where rows differ in length."""
    head, *rows = csv.reader(io.StringIO(text))
    if len(set(head)) < len(head) or any(len(row) != len(head) for row in rows):
        return None
    return {name: [cell_of(row[place]) for row in rows] for place, name in enumerate(head)}


def cell_of(text: str) -> str | float:
    """Return a cell as a number where it is one in the form that Python writes."""
    if re.fullmatch(r"-?\d+(\.\d+)?(e[-+]?\d+)?", text):
        return float(text) if re.search(r"[.e]", text) else int(text)
    return text
