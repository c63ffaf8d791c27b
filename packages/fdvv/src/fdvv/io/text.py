"""Text files of foreign programs: from bytes to lines, from lines to cells."""

from __future__ import annotations

import codecs
import csv
import re

from fdvv.errors import InputError

BINARY = {
    b"\x89PNG": "a PNG image",
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF8": "a GIF image",
    b"%PDF": "a PDF document",
    b"\x1f\x8b": "a gzip archive",
    b"\xd0\xcf\x11\xe0": "an old Office document",
    b"\x93NUMPY": "a NumPy array",
    b"\x89HDF": "an HDF5 file",
}
"""How files begin that are no text, and what each is."""


def decode_lines(source: object, content: bytes, remedy: str) -> tuple[list[str], list[str]]:
    """Decode a text file into lines without their endings (LF, CRLF or CR), and what was repaired.

    UTF-8 with or without a byte-order mark and marked UTF-16 are read as such, anything else as
    Latin-1 with a warning. Raises InputError for an empty or a binary file.
    """
    for magic, kind in BINARY.items():
        if content.startswith(magic):
            raise InputError(source, "whole file", f"it is {kind}, whatever its name says", remedy)
    text, warnings = _to_text(source, content, remedy)
    if not text.strip("\x00\ufeff \t\r\n\v\f"):
        raise InputError(source, "whole file", "it is empty", remedy)
    return text.replace("\r\n", "\n").replace("\r", "\n").split("\n"), warnings


def _to_text(source: object, content: bytes, remedy: str) -> tuple[str, list[str]]:
    if content.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return content.decode("utf-16", errors="replace"), []
    head = content[:4096]
    if sum(byte < 9 or 13 < byte < 32 for byte in head) > 0.02 * len(head):
        raise InputError(source, "whole file", "it is a binary file of no kind known here", remedy)
    try:
        return content.decode("utf-8-sig"), []
    except UnicodeDecodeError as error:
        return content.decode("latin-1"), [f"byte {error.start}: not UTF-8; the file was read as Latin-1"]


def cells(line: str, separator: str) -> list[str]:
    """Split one line into its cells; quotes may hold separators."""
    if separator == " ":
        return line.split()
    if '"' not in line:
        return line.split(separator)
    try:
        return next(csv.reader([line.replace("\x00", " ")], delimiter=separator))
    except (csv.Error, StopIteration):
        return [line]


def sniff_separator(line: str) -> str:
    """Return the separator of a line: tab, semicolon, comma, else blanks; those in quotes do not count."""
    bare = re.sub(r'"[^"]*"', "", line)
    return next((mark for mark in ("\t", ";", ",") if mark in bare), " ")
