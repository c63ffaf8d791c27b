"""More ways to spoil a file, written after the gates: what amplifiers, stages, merges and editors do.

The first run over these, before any gate knew them (1,025 files of ../shared/data), accepted 199 of which a
person would say that they are spoilt, and ended in 9 tracebacks.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
from numpy.random import Generator

from benchmarks.mutilations import NUMBER, Mutilation, Table
from fdvv.units import FloatArray

INCH_mm, POUND_N = 25.4, 4.4482216


def turn_of(x: FloatArray) -> int:
    """Return the row where a run turns: its greatest displacement."""
    return int(np.nanargmax(x)) if np.isfinite(x).any() else 0


def columns(t: Table) -> list[tuple[int, int, FloatArray, FloatArray]]:
    """Return the indices and the numbers of every pair of columns."""
    return [(x, f, np.array(t.column(x)), np.array(t.column(f))) for x, f in t.pairs]


def force_of(how: Callable[[FloatArray, FloatArray, Generator], FloatArray]) -> Mutilation:
    """Change the force of every pair of columns, given displacement, force and a generator."""

    def mutilate(t: Table, rng: Generator) -> str:
        seed = int(rng.integers(2**31))
        for _, at, x, force in columns(t):
            t = t.put(at, how(x, force, np.random.default_rng(seed)))
        return t.text()

    return mutilate


def block(size: int, rng: Generator, part: tuple[float, float] = (0.08, 0.25)) -> slice:
    """Choose a stretch of rows."""
    length = max(3, int(rng.uniform(*part) * size))
    first = int(rng.uniform(0.05, 0.9 - length / size) * size)
    return slice(first, first + length)


def saturated(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    return np.minimum(force, rng.uniform(0.3, 0.9) * np.nanmedian(force[force > 0.3 * np.nanmedian(force)]))


def coarse(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    step = rng.choice([20.0, 40.0])
    return np.asarray(step * np.round(force / step))


def drifting(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    return np.asarray(force + rng.choice([-1, 1]) * rng.uniform(20, 60) * np.arange(force.size) / force.size)


def humming(x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    return force + rng.uniform(10, 20) * np.sin(2 * np.pi * x / rng.uniform(0.05, 0.4))


def stuck_cell(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    rows, held = block(force.size, rng), force.copy()
    held[rows] = force[rows.start]
    return held


def negative_half(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    rows, out = block(force.size, rng, (0.2, 0.5)), force.copy()
    out[rows] = -out[rows]
    return out


def lost_tare(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    later = np.arange(force.size) > rng.uniform(0.15, 0.85) * force.size
    return np.asarray(force + rng.choice([-1, 1]) * rng.uniform(20, 80) * later)


def rectified(_x: FloatArray, force: FloatArray, _rng: Generator) -> FloatArray:
    return np.abs(force - np.nanmedian(force))


def logarithm(_x: FloatArray, force: FloatArray, _rng: Generator) -> FloatArray:
    return 20 * np.log10(np.maximum(np.abs(force), 0.01))


def differences(_x: FloatArray, force: FloatArray, _rng: Generator) -> FloatArray:
    return np.concatenate([[0.0], np.diff(force)])


def inverted(_x: FloatArray, force: FloatArray, _rng: Generator) -> FloatArray:
    return np.nanmax(force) - force


def bursts(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    out = force.copy()
    for _ in range(int(rng.integers(2, 6))):
        rows = block(force.size, rng, (0.01, 0.04))
        out[rows] += rng.normal(0, 80, out[rows].size)
    return out


def wrapped(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    most = rng.choice([32.0, 64.0])
    return np.asarray(np.mod(force + most, 2 * most) - most)


def lagging(_x: FloatArray, force: FloatArray, rng: Generator) -> FloatArray:
    rows = int(rng.uniform(0.05, 0.15) * force.size)
    return np.concatenate([np.full(rows, force[0]), force[: force.size - rows]])


def shuffled_blocks(t: Table, rng: Generator) -> str:
    parts = np.array_split(np.arange(len(t.rows)), int(rng.integers(5, 40)))
    order = np.concatenate([parts[i] for i in rng.permutation(len(parts))])
    return replace(t, rows=[t.rows[i] for i in order]).text()


def repeated_half(which: int) -> Mutilation:
    """Write half of the rows once more at the end, their displacement (0) or force (1) moved."""

    def mutilate(t: Table, rng: Generator) -> str:
        half = replace(
            t, rows=t.rows[: len(t.rows) // 2] if rng.random() < 0.5 else t.rows[len(t.rows) // 2 :]
        )
        by = rng.choice([-1, 1]) * (rng.uniform(0.5, 2) if which == 0 else rng.uniform(20, 60))
        return replace(t, rows=[*t.rows, *half.change(which, lambda v: v + by).rows]).text()

    return mutilate


def exchanged_strokes(t: Table, _rng: Generator) -> str:
    """Exchange press and release: force of the one at displacements of the other."""
    if len(t.pairs) > 1:
        for (_, a, _, press), (_, b, _, release) in zip(columns(t)[::2], columns(t)[1::2], strict=False):
            both = min(np.isfinite(press).sum(), np.isfinite(release).sum())
            press[:both], release[:both] = release[:both][::-1], press[:both][::-1].copy()
            t = t.put(a, press).put(b, release)
        return t.text()
    _, at, _, force = columns(t)[0]
    return t.put(at, force[::-1]).text()


def reversed_release(which: str) -> Mutilation:
    """Turn the rows of the release, or its forces alone, around."""

    def mutilate(t: Table, _rng: Generator) -> str:
        for number, (x, at, place, force) in enumerate(columns(t)):
            start = turn_of(place) + 1 if len(t.pairs) == 1 else 0 if number % 2 else force.size
            end = start + int(np.isfinite(force[start:]).sum())
            force[start:end] = force[start:end][::-1]
            place[start:end] = place[start:end][::-1]
            t = t.put(at, force)
            t = t.put(x, place) if which == "rows" else t
        return t.text()

    return mutilate


def units_midway(which: int, *factors: float) -> Mutilation:
    def mutilate(t: Table, rng: Generator) -> str:
        factor, part = rng.choice(factors), rng.uniform(0.1, 0.9)
        return t.change(which, lambda v: np.where(np.arange(v.size) > part * v.size, factor * v, v)).text()

    return mutilate


def empty_bursts(t: Table, rng: Generator) -> str:
    rows = [list(row) for row in t.rows]
    for _ in range(int(rng.integers(2, 7))):
        for row in rows[block(len(rows), rng, (0.01, 0.06))]:
            row[t.pairs[0][1]] = str(rng.choice(["NaN", "", "OL", "ERR"]))
    return replace(t, rows=rows).text()


def zero_bursts(t: Table, rng: Generator) -> str:
    for _, at, _, force in columns(t):
        for _ in range(int(rng.integers(1, 4))):
            force[block(force.size, rng, (0.01, 0.06))] = 0.0
        t = t.put(at, force)
    return t.text()


def stuck_stage(t: Table, rng: Generator) -> str:
    for at, _, x, _ in columns(t):
        rows = block(x.size, rng)
        x[rows] = x[rows.start]
        t = t.put(at, x)
    return t.text()


def slipping_stage(t: Table, rng: Generator) -> str:
    """Lose steps: from three places on the displacement is off by as much again."""
    for at, _, x, _ in columns(t):
        for place in rng.uniform(0.1, 0.9, 3):
            x = x + np.where(np.arange(x.size) > place * x.size, rng.uniform(0.2, 0.6), 0.0)
        t = t.put(at, x)
    return t.text()


def row_numbers(t: Table, _rng: Generator) -> str:
    return t.change(0, lambda v: 0 * v + np.arange(v.size)).text()


def fewer_decimals(t: Table, _rng: Generator) -> str:
    rows = [[_cut_decimals(cell) for cell in row] for row in t.rows]
    return replace(t, rows=rows).text()


def _cut_decimals(cell: str) -> str:
    bare = cell.strip('"')
    return bare[: max(bare.find(".") + 1, len(bare) - 2)] if NUMBER.fullmatch(cell) and "." in bare else cell


def no_points(t: Table, _rng: Generator) -> str:
    return replace(t, rows=[[cell.replace(".", "") for cell in row] for row in t.rows]).text()


def commas_midway(t: Table, rng: Generator) -> str:
    part = rng.uniform(0.2, 0.8) * len(t.rows)
    rows = [[c.replace(".", ",") for c in row] if i > part else row for i, row in enumerate(t.rows)]
    return replace(t, rows=rows).text()


def thousands(t: Table, _rng: Generator) -> str:
    """Write numbers as '1 234,5' between semicolons."""
    rows = [";".join(cell.strip('"').replace(".", ",").rjust(6) for cell in row) for row in t.rows]
    return "\n".join([line.replace(",", ";") for line in t.head] + rows) + "\n"


def sorted_force(t: Table, _rng: Generator) -> str:
    """Sort one column of a sheet and not the other."""
    return t.change(1, lambda v: np.concatenate([np.sort(v[np.isfinite(v)]), v[~np.isfinite(v)]])).text()


def missing_cells_up(t: Table, rng: Generator) -> str:
    """Delete cells of the force and move what is below up."""

    def moved(v: FloatArray) -> FloatArray:
        rows = block(v.size, rng)
        return np.concatenate([v[: rows.start], v[rows.stop :], v[rows]])

    return t.change(1, moved).text()


def alternating(t: Table, rng: Generator) -> str:
    """Let every second row be of a stiffer button."""
    factor = rng.uniform(1.4, 2.0)
    return t.change(1, lambda v: np.where(np.arange(v.size) % 2, factor * v, v)).text()


OF_TABLES: dict[str, Mutilation] = {
    "blocks of rows shuffled": shuffled_blocks,
    "half once more, moved": repeated_half(0),
    "half once more, with an offset": repeated_half(1),
    "strokes exchanged": exchanged_strokes,
    "release turned around": reversed_release("rows"),
    "force of the release turned around": reversed_release("force"),
    "force in other units half-way": units_midway(1, 9.80665, POUND_N, 1 / POUND_N, 0.00980665, 101.97),
    "displacement in other units half-way": units_midway(0, INCH_mm, 1 / INCH_mm, 1000.0, 0.001),
    "saturated": force_of(saturated),
    "steps of 20 or 40": force_of(coarse),
    "drift": force_of(drifting),
    "hum": force_of(humming),
    "load cell hangs": force_of(stuck_cell),
    "a part negative": force_of(negative_half),
    "tare lost half-way": force_of(lost_tare),
    "rectified": force_of(rectified),
    "decibels": force_of(logarithm),
    "differences": force_of(differences),
    "upside down": force_of(inverted),
    "bursts of noise": force_of(bursts),
    "converter wraps around": force_of(wrapped),
    "force lags": force_of(lagging),
    "bursts without a number": empty_bursts,
    "bursts of zeros": zero_bursts,
    "stage hangs": stuck_stage,
    "stage slips": slipping_stage,
    "row numbers for displacements": row_numbers,
    "two decimals lost": fewer_decimals,
    "decimal points lost": no_points,
    "decimal commas half-way": commas_midway,
    "semicolons and blanks": thousands,
    "force sorted": sorted_force,
    "cells moved up": missing_cells_up,
    "every second row of another": alternating,
}


def two_encodings(data: bytes, rng: Generator) -> bytes:
    at = data.find(b"\n", int(rng.uniform(0.2, 0.8) * len(data))) + 1
    second = str(rng.choice(["utf-16", "utf-16-le", "utf-32", "cp500"]))
    return data[:at] + data[at:].decode("utf-8", errors="replace").encode(second, errors="replace")


def nul_bytes(data: bytes, rng: Generator) -> bytes:
    at = int(rng.random() * len(data))
    return data[:at] + b"\x00" * int(rng.choice([1, 512, 4096])) + data[at:]


def lost_pages(data: bytes, rng: Generator) -> bytes:
    out, size = bytearray(data), int(rng.choice([64, 512, 4096]))
    at = int(rng.random() * max(1, len(out) - size))
    out[at : at + size] = b"\x00" * len(out[at : at + size])
    return bytes(out)


def exchanged_pages(data: bytes, rng: Generator) -> bytes:
    size = 512
    pages = [data[i : i + size] for i in range(0, len(data), size)]
    a, b = rng.integers(len(pages), size=2)
    pages[a], pages[b] = pages[b], pages[a]
    return b"".join(pages)


def dropped_bytes(data: bytes, rng: Generator) -> bytes:
    keep = rng.random(len(data)) > rng.choice([0.0005, 0.005, 0.05])
    return bytes(np.frombuffer(data, np.uint8)[keep])


OF_BYTES: dict[str, Callable[[bytes, Generator], bytes]] = {
    "two encodings": two_encodings,
    "NUL bytes": nul_bytes,
    "a page of zeros": lost_pages,
    "pages exchanged": exchanged_pages,
    "bytes lost": dropped_bytes,
    "line ends lost": lambda data, _rng: data.replace(b"\n", b""),
    "line ends doubled": lambda data, _rng: data.replace(b"\n", b"\r\r\n"),
}
