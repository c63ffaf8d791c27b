"""Damaged files of every format: a valid curve or one line of refusal, nothing else."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from fdvv.capture import average_cycles, read_force_file, reader_names
from fdvv.errors import InputError

Damage = Callable[[bytes], bytes]
JUNK = [
    b"abc",
    b"nan",
    b"-inf",
    b"inf",
    b"1e308",
    b"-1e999",
    b"9" * 400,
    b"\x00",
    b"",
    b'"',
    b",",
    b";",
    b"--",
]
JUNK += ["µ".encode(), b"\xff\xfe", b"1_0", b"0x1F", b"{}", b"[[[", b"\n\n", b"\r", b"\x0b", b"1e5", b"-999"]


def truncate(part: float) -> Damage:
    return lambda data: data[: int(part * len(data))]


def drop_lines(start: float, count: int) -> Damage:
    def damage(data: bytes) -> bytes:
        lines = data.split(b"\n")
        at = int(start * len(lines))
        return b"\n".join(lines[:at] + lines[at + count :])

    return damage


def repeat_lines(start: float, count: int) -> Damage:
    def damage(data: bytes) -> bytes:
        lines = data.split(b"\n")
        at = int(start * len(lines))
        return b"\n".join(lines[: at + count] + lines[at:])

    return damage


def shuffle_lines(seed: int) -> Damage:
    def damage(data: bytes) -> bytes:
        lines = data.split(b"\n")
        return b"\n".join(lines[i] for i in np.random.default_rng(seed).permutation(len(lines)))

    return damage


def swap_columns(rows: float) -> Damage:
    def damage(data: bytes) -> bytes:
        lines = data.split(b"\n")
        end = int(rows * len(lines)) + 1
        swapped = [b",".join(reversed(line.split(b",", 1))) for line in lines[:end]]
        return b"\n".join(swapped + lines[end:])

    return damage


def insert(place: float, junk: bytes) -> Damage:
    return lambda data: data[: int(place * len(data))] + junk + data[int(place * len(data)) :]


def replace_cell(place: float, junk: bytes) -> Damage:
    def damage(data: bytes) -> bytes:
        cells = data.split(b",")
        cells[int(place * (len(cells) - 1))] = junk
        return b",".join(cells)

    return damage


def flip(place: float, byte: int) -> Damage:
    def damage(data: bytes) -> bytes:
        at = int(place * max(len(data) - 1, 0))
        return data[:at] + bytes([byte]) + data[at + 1 :]

    return damage


def recode(encoding: str) -> Damage:
    return lambda data: data.decode("utf-8", errors="replace").encode(encoding, errors="replace")


PLACE = st.floats(0.0, 1.0)
DAMAGES = st.one_of(
    st.builds(truncate, PLACE),
    st.builds(drop_lines, PLACE, st.integers(1, 400)),
    st.builds(repeat_lines, PLACE, st.integers(1, 200)),
    st.builds(shuffle_lines, st.integers(0, 99)),
    st.builds(swap_columns, PLACE),
    st.builds(insert, PLACE, st.sampled_from(JUNK)),
    st.builds(replace_cell, PLACE, st.sampled_from(JUNK)),
    st.builds(flip, PLACE, st.integers(0, 255)),
    st.builds(recode, st.sampled_from(["utf-16", "utf-16-le", "utf-8-sig", "latin-1", "utf-32"])),
)


def check(path: Path) -> None:
    """Read a file: what comes out is valid, or one line says why nothing does."""
    refused = ""
    try:
        file = read_force_file(path)
    except InputError as error:
        refused = str(error)
    if refused:
        assert "\n" not in refused
        assert refused.startswith(str(path))
        return
    assert file.cycles
    assert all("\n" not in warning for warning in file.warnings)
    # a MeasuredCurve cannot be built wrong; that there is at least one is to be checked
    assert all(cycle.press is not None or cycle.release is not None for cycle in file.cycles)
    averaged = average_cycles(file)
    assert averaged.used
    assert len(averaged.used) + len(averaged.left_out) == len(file.cycles)


@pytest.mark.parametrize("name", [name for name in reader_names() if name != "bluepylons-ods"])
@given(damages=st.lists(DAMAGES, min_size=1, max_size=3))
@settings(
    max_examples=int(os.environ.get("FDVV_EXAMPLES", "60")),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_a_mutilated_text_file_is_read_or_refused(
    name: str, files: Any, tmp_path: Path, damages: list[Damage]
) -> None:
    filename, text = files.TEXTS[name]
    data = text().encode()
    for damage in damages:
        data = damage(data)
    check(files.write(tmp_path, filename, data))


@given(damages=st.lists(DAMAGES, min_size=1, max_size=2), inside=st.booleans())
@settings(
    max_examples=int(os.environ.get("FDVV_EXAMPLES", "60")),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_a_mutilated_spreadsheet_is_read_or_refused(
    files: Any, tmp_path: Path, damages: list[Damage], inside: bool
) -> None:
    rows = "".join(
        "<table:table-row>" + "".join(files._cell(value) for value in row) + "</table:table-row>\n"
        for row in files.raw_rows("A")[:120]
    ).encode()
    if inside:
        for damage in damages:
            rows = damage(rows)
    data = files.ods_from_xml(rows.decode("utf-8", errors="replace"))
    if not inside:
        for damage in damages:
            data = damage(data)
    check(files.write(tmp_path, "a.ods", data))


@given(data=st.binary(max_size=300))
@settings(
    max_examples=int(os.environ.get("FDVV_EXAMPLES", "150")),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_any_bytes_at_all_are_read_or_refused(files: Any, tmp_path: Path, data: bytes) -> None:
    check(files.write(tmp_path, "a.csv", data))


HEADERS = [
    "x_mm,force_cN",
    "x,force_N",
    "Press 1, x;y",
    "force,displacement,judge,name",
    "time_s,x_um,F_gf,closed",
]
CELL = st.one_of(st.floats(width=32).map(repr), st.sampled_from(["", "a", "1,5", '"', "NaN", "1e400", "-0"]))


@given(header=st.sampled_from(HEADERS), rows=st.lists(st.lists(CELL, max_size=5), max_size=40))
@settings(
    max_examples=int(os.environ.get("FDVV_EXAMPLES", "150")),
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
def test_any_numbers_under_a_header_are_read_or_refused(
    files: Any, tmp_path: Path, header: str, rows: list[list[str]]
) -> None:
    check(files.write(tmp_path, "a.csv", "\n".join([header, *(",".join(row) for row in rows)])))
