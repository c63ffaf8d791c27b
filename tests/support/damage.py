"""Damages that files of text and bytes suffer, drawn at random."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from hypothesis import strategies as st

Damage = Callable[[bytes], bytes]
WORDS = (b"abc", b"nan", b"-inf", b"inf", b"1e308", b"-1e999", b"1e5", b"-999", b"1_0", b"0x1F", b"9" * 400)
SIGNS = (
    b"\x00",
    b"",
    b'"',
    b",",
    b";",
    b"--",
    b"{}",
    b"[[[",
    b"\n\n",
    b"\r",
    b"\x0b",
    b"\xff\xfe",
    "µ".encode(),
)
JUNK = (*WORDS, *SIGNS)


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
