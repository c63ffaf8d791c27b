"""Ways to spoil a file of force curves: what people and programs do to tables, and what disks do to bytes."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from numpy.random import Generator

NUMBER = re.compile(r'"?-?\d+(\.\d+)?([eE][-+]?\d+)?"?')


@dataclass(frozen=True)
class Table:
    """A text file taken apart: lines of its head, cells of its rows, columns of displacement and force."""

    head: list[str]
    rows: list[list[str]]
    pairs: list[tuple[int, int]]

    def text(self) -> str:
        return "\n".join([*self.head, *(",".join(row) for row in self.rows)]) + "\n"

    def column(self, at: int) -> list[float]:
        """Return the numbers of a column; not a number where a cell holds none."""
        cells = (row[at].strip('"') if at < len(row) else "" for row in self.rows)
        return [float(cell) if NUMBER.fullmatch(cell) else np.nan for cell in cells]

    def put(self, at: int, values: np.ndarray) -> Table:
        """Replace the numbers of a column; blank cells stay blank."""
        old, rows = self.column(at), [list(row) for row in self.rows]
        for row, was, value in zip(rows, old, values, strict=True):
            if not np.isnan(was):
                row[at] = f"{value:.6g}"
        return replace(self, rows=rows)

    def change(self, which: int, how: Callable[[np.ndarray], np.ndarray]) -> Table:
        """Change the displacements (0) or the forces (1) of every pair of columns."""
        table = self
        for at in {pair[which] for pair in self.pairs}:
            table = table.put(at, how(np.array(table.column(at))))
        return table


def table_of(path: Path) -> Table | None:
    """Take a file of a known layout apart; None for one of another."""
    lines = path.read_text(encoding="utf-8", errors="replace").split("\n")
    lines = [line.rstrip("\r") for line in lines if line.strip()]
    first = lines[0].lower().replace('"', "")
    head, pairs = lines[:1], [(0, 1)]
    if first.startswith("force,displacement"):
        pairs = [(1, 0)]
    elif first.startswith("millis"):
        pairs = [(2, 4)]
    elif first.startswith("press 1, x"):
        pairs = [(i, i + 1) for i in range(0, lines[0].count('","') + 1, 2)]
    elif ".downstroke." in path.name:
        head = []
    elif not first.startswith("x_um,"):
        return None
    return Table(head, [line.split(",") for line in lines[len(head) :]], pairs)


def swapped(t: Table, _rng: Generator) -> str:
    for x, force in t.pairs:
        a, b = np.array(t.column(x)), np.array(t.column(force))
        t = t.put(x, b).put(force, a)
    return t.text()


def swapped_half(t: Table, rng: Generator) -> str:
    part = int(len(t.rows) * rng.uniform(0.2, 0.8))
    for x, force in t.pairs:
        a, b = np.array(t.column(x)), np.array(t.column(force))
        later = np.arange(a.size) >= part
        t = t.put(x, np.where(later, b, a)).put(force, np.where(later, a, b))
    return t.text()


def scaled(which: int, factor: float) -> Mutilation:
    return lambda t, _rng: t.change(which, lambda v: v * factor).text()


def constant(which: int) -> Mutilation:
    return lambda t, rng: t.change(which, lambda v: 0 * v + rng.uniform(1, 80)).text()


def random_force(t: Table, rng: Generator) -> str:
    return t.change(1, lambda v: rng.uniform(0, 100, v.size)).text()


def noisy_force(t: Table, rng: Generator) -> str:
    return t.change(1, lambda v: v + rng.normal(0, 15, v.size)).text()


def shuffled_force(t: Table, rng: Generator) -> str:
    return t.change(1, rng.permutation).text()


def reversed_rows(t: Table, _rng: Generator) -> str:
    return replace(t, rows=t.rows[::-1]).text()


def shuffled_rows(t: Table, rng: Generator) -> str:
    return replace(t, rows=[t.rows[i] for i in rng.permutation(len(t.rows))]).text()


def shifted(t: Table, rng: Generator) -> str:
    by = int(rng.choice([-1, 1]) * rng.uniform(0.05, 0.3) * len(t.rows))
    return t.change(1, lambda v: np.roll(v, by)).text()


def truncated(t: Table, rng: Generator) -> str:
    text = t.text()
    return text[: int(rng.uniform(0.01, 0.95) * len(text))]


def beheaded(t: Table, rng: Generator) -> str:
    return replace(t, rows=t.rows[int(rng.uniform(0.05, 0.9) * len(t.rows)) :]).text()


def no_head(t: Table, _rng: Generator) -> str:
    return replace(t, head=[]).text()


def not_numbers(t: Table, rng: Generator) -> str:
    word, part = (
        rng.choice(["NaN", "nan", "", "#N/A", "inf", "--", "1e999"]),
        rng.choice([0.02, 0.2, 0.45, 0.7]),
    )
    rows = [list(row) for row in t.rows]
    for row in rows:
        if rng.random() < part:
            row[t.pairs[0][int(rng.integers(2))]] = str(word)
    return replace(t, rows=rows).text()


def decimal_commas(t: Table, _rng: Generator) -> str:
    return replace(t, rows=[[cell.replace(".", ",") for cell in row] for row in t.rows]).text()


def semicolons(t: Table, _rng: Generator) -> str:
    head = [line.replace(",", ";") for line in t.head]
    return "\n".join([*head, *(";".join(c.replace(".", ",") for c in row) for row in t.rows)]) + "\n"


def repeated_rows(t: Table, rng: Generator) -> str:
    rows = [row for row in t.rows for _ in range(int(rng.integers(1, 4)))]
    return replace(t, rows=rows).text()


def thinned(t: Table, rng: Generator) -> str:
    return replace(t, rows=[row for row in t.rows if rng.random() < rng.choice([0.02, 0.1, 0.5])]).text()


def gap(t: Table, rng: Generator) -> str:
    at = int(rng.uniform(0.05, 0.8) * len(t.rows))
    return replace(t, rows=t.rows[:at] + t.rows[at + int(0.15 * len(t.rows)) :]).text()


def same_time(t: Table, _rng: Generator) -> str:
    # only a log has a clock; elsewhere a column of equal times is added
    if t.head and t.head[0].startswith("Millis"):
        return replace(t, rows=[["7000", *row[1:]] for row in t.rows]).text()
    return replace(t, head=[h + ",time_s" for h in t.head], rows=[[*row, "1.5"] for row in t.rows]).text()


def negated(which: int) -> Mutilation:
    return lambda t, _rng: t.change(which, lambda v: -v).text()


def overflowing(t: Table, rng: Generator) -> str:
    rows = [list(row) for row in t.rows]
    for at in rng.integers(0, len(rows), 8):
        rows[at][t.pairs[0][int(rng.integers(2))]] = str(rng.choice(["1e308", "-1e300", "9" * 300, "1e13"]))
    return replace(t, rows=rows).text()


Mutilation = Callable[[Table, Generator], str | bytes]

GF = {
    "pounds": 453.59237,
    "ounces": 28.349523,
    "kilograms": 1000.0,
    "newtons": 101.97,
    "millinewtons": 0.10197,
}

OF_TABLES: dict[str, Mutilation] = {
    "exchanged columns": swapped,
    "columns exchanged half-way": swapped_half,
    "displacement x 1000": scaled(0, 1000.0),
    "displacement / 1000": scaled(0, 0.001),
    "force x 1000": scaled(1, 1000.0),
    "force / 1000": scaled(1, 0.001),
    **{f"{unit} read as gram-force": scaled(1, factor) for unit, factor in GF.items()},
    "constant force": constant(1),
    "constant displacement": constant(0),
    "random force": random_force,
    "force and noise": noisy_force,
    "shuffled force": shuffled_force,
    "shuffled rows": shuffled_rows,
    "reversed rows": reversed_rows,
    "shifted force": shifted,
    "truncated": truncated,
    "beheaded": beheaded,
    "without a header": no_head,
    "no numbers": not_numbers,
    "decimal commas": decimal_commas,
    "semicolons": semicolons,
    "repeated rows": repeated_rows,
    "thinned": thinned,
    "a gap": gap,
    "one time": same_time,
    "negative force": negated(1),
    "negative displacement": negated(0),
    "overflow": overflowing,
}


def flipped(data: bytes, rng: Generator) -> bytes:
    out = bytearray(data)
    for at in rng.integers(0, len(out), int(rng.choice([1, 20, 1000]))):
        out[at] = int(rng.integers(256))
    return bytes(out)


def cut(data: bytes, rng: Generator) -> bytes:
    return data[: int(rng.random() * len(data))]


def recoded(encoding: str) -> Callable[[bytes, Generator], bytes]:
    return lambda data, _rng: data.decode("utf-8", errors="replace").encode(encoding, errors="replace")


def prefixed(data: bytes, rng: Generator) -> bytes:
    marks = [
        b"\x89PNG\r\n\x1a\n",
        b"PK\x03\x04",
        b"\x1f\x8b\x08",
        b"%PDF-1.7",
        b"\x00" * 64,
        b"\xff\xfe",
        b"{",
        b"<",
    ]
    return marks[int(rng.integers(len(marks)))] + data


OF_BYTES: dict[str, Callable[[bytes, Generator], bytes]] = {
    "flipped bytes": flipped,
    "cut bytes": cut,
    "UTF-16": recoded("utf-16"),
    "UTF-16 without a mark": recoded("utf-16-le"),
    "UTF-32": recoded("utf-32"),
    "a foreign mark": prefixed,
    "written twice": lambda data, _rng: data + data,
}


def deep_json(rng: Generator) -> bytes:
    depth = int(rng.choice([1000, 100_000, 5_000_000]))
    start, end = ((b"[", b"]"), (b'{"down_x":', b"}"))[int(rng.integers(2))]
    return start * depth + b"1" + end * int(rng.choice([0, depth]))


def noise_bytes(rng: Generator) -> bytes:
    return rng.bytes(int(rng.choice([0, 1, 100, 100_000])))


def huge_rows(rng: Generator) -> bytes:
    row = [b"0.105,43.2\n", b"1,2\n", b"nan,nan\n", b"0.1,,,,,,\n"][int(rng.integers(4))]
    lines = int(rng.choice([290_000, 15 * 2**20 // len(row)]))
    return b"displacement_mm,force_cN\n" + row * lines


def huge_ramp(_rng: Generator) -> bytes:
    x = np.linspace(0, 4, 290_000)
    return b"displacement_mm,force_cN\n" + b"\n".join(b"%.7f,%.4f" % (a, 30 + 9 * a) for a in x)


def wide(rng: Generator) -> bytes:
    names = b",".join(b"press_%d_force_cN" % i for i in range(int(rng.choice([1000, 100_000]))))
    return b"displacement_mm," + names + b"\n" + b"1," * 200_000


def too_large(_rng: Generator) -> bytes:
    return b"displacement_mm,force_cN\n" + b"1,1\n" * (17 * 2**20)


OUT_OF_NOTHING: dict[str, Callable[[Generator], bytes]] = {
    "deep JSON": deep_json,
    "random bytes": noise_bytes,
    "huge, of equal rows": huge_rows,
    "huge, a ramp": huge_ramp,
    "wide": wide,
    "beyond the limit": too_large,
}
