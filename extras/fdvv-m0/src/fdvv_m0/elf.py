"""The loadable parts and the symbols of a 32-bit little-endian ELF file (System V ABI, chapters 4 and 5)."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from pathlib import Path

from fdvv.errors import InputError

LOADABLE, SYMBOLS = 1, 2
ARM = 40


@dataclass(frozen=True)
class Program:
    """The bytes to put at their load addresses, and where names lie."""

    parts: tuple[tuple[int, bytes], ...]
    symbols: dict[str, int]


def read_elf(path: Path) -> Program:
    """Read an ELF file for 32-bit ARM; raises InputError if it is missing or something else."""
    try:
        data = path.read_bytes()
    except OSError as error:
        raise InputError(path, "whole file", str(error), "build it with make firmware") from error
    if len(data) < 52 or data[:6] != b"\x7fELF\x01\x01" or struct.unpack_from("<H", data, 18)[0] != ARM:
        raise InputError(path, "byte 0", "not an ELF file for 32-bit ARM", "give the .elf, not .bin or .uf2")
    try:
        return Program(tuple(_parts(data)), _symbols(data))
    except (struct.error, IndexError) as error:
        raise InputError(path, "whole file", f"truncated ({error})", "build it again") from error


def _parts(data: bytes) -> list[tuple[int, bytes]]:
    start, size, count = struct.unpack_from("<I", data, 28)[0], *struct.unpack_from("<HH", data, 42)
    parts = []
    for at in range(start, start + count * size, size):
        kind, offset, _virtual, load, file_bytes = struct.unpack_from("<5I", data, at)
        if kind == LOADABLE and file_bytes:
            parts.append((load, data[offset : offset + file_bytes]))
    return parts


def _symbols(data: bytes) -> dict[str, int]:
    start, size, count = struct.unpack_from("<I", data, 32)[0], *struct.unpack_from("<HH", data, 46)
    sections = [struct.unpack_from("<10I", data, start + i * size) for i in range(count)]
    names: dict[str, int] = {}
    for _name, kind, _flags, _address, offset, length, link, *_rest in sections:
        if kind == SYMBOLS:
            texts = sections[link][4]
            for at in range(offset, offset + length, 16):
                text, value = struct.unpack_from("<2I", data, at)
                names[data[texts + text : data.index(b"\0", texts + text)].decode()] = value & ~1
    return names
