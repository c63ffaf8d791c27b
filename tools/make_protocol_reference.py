"""Write docs/reference/protocol.md from protocol/fdvv.toml, and strip-protocol.md from strip.toml."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "protocol" / "fdvv.toml"
PAGE = ROOT / "docs" / "reference" / "protocol.md"
STRIP_SOURCE = ROOT / "protocol" / "strip.toml"
STRIP_PAGE = ROOT / "docs" / "reference" / "strip-protocol.md"
SIZES = {"u8": 1, "i8": 1, "u16": 2, "i16": 2, "u32": 4, "i32": 4}

INTRODUCTION = """# The wire

Made from `protocol/fdvv.toml` by `tools/make_protocol_reference.py`; do not edit. How it is used and why it
is so: [the link](../explanation/link.md).

All numbers are little-endian integers, every one at a multiple of its size. Units are the last part of a
name: um16 is 1/16 µm, mm_s16 1/16 mm/s, cN64 1/64 cN, q8 to q16 a ratio times 2^8 to 2^16.

## Frames

| part | bytes | meaning |
|---|---|---|
| message | 1 | number of the message; a reply has its request's plus 0x80 |
| sequence | 1 | a reply has its request's; what the device sends unasked counts on its own |
| payload | 0 to 228 | the message's structure |
| checksum | 2 | CRC-16 of all before it: polynomial 0x1021, start 0xffff, not reflected |

A frame is stuffed (consistent overhead byte stuffing), so that it holds no zero, and ended by a zero. Empty
frames mean nothing. One example of every message, bytes and meaning, is in `protocol/golden.json`.
"""

STRIP_INTRODUCTION = """# The wire of the LED strip's board

Made from `protocol/strip.toml` by `tools/make_protocol_reference.py`; do not edit. The board and what it is
for: [the LED strip](led-strip.md). Frames, stuffing and checksum are those of [the wire](protocol.md#frames),
with a payload of 0 to 60 bytes; the serial line has 115,200 Bd, 8 bits, no parity.
"""


def size_of(kind: str) -> int:
    """Count the bytes of a type such as u16 or u8[10]."""
    base, _, count = kind.partition("[")
    return SIZES[base] * int(count.rstrip("]") or 1)


def fields(rows: list[list[Any]]) -> list[str]:
    """Write a structure as a table."""
    lines, place = ["| at | field | type | unit | range | meaning |", "|---|---|---|---|---|---|"], 0
    for name, kind, unit, low, high, about in rows:
        span = "0" if low == high == 0 else f"{low} to {high}"
        lines.append(f"| {place} | `{name}` | {kind} | {unit} | {span} | {about} |")
        place += size_of(kind)
    return [*lines, "", f"{place} bytes.", ""]


def part(title: str, body: list[list[Any]] | str) -> list[str]:
    """Write the request or reply of a message."""
    if isinstance(body, str):
        return [f"{title}: the structure [{body}](#{body}).", ""]
    if not body:
        return [f"{title}: no payload.", ""]
    return [f"{title}:", "", *fields(body)]


def message(name: str, body: dict[str, Any]) -> list[str]:
    """Write one message."""
    lines = [f"### {name} (0x{body['id']:02x})", "", f"{sentence(body['about'])}", ""]
    if body["id"] >= 0xC0:
        return [*lines, *part("Sent", body["fields"])]
    if name != "refused":
        lines += part("Request", body["fields"])
    return [*lines, *part("Reply", body["reply"])]


def sentence(text: str) -> str:
    """Begin with a capital and end with a stop."""
    return text[0].upper() + text[1:].rstrip(".") + "."


def numbers(name: str, body: dict[str, Any], bits: bool) -> list[str]:
    """Write an enumeration or a set of flags."""
    values = {k: v for k, v in body.items() if k != "about"}
    head = "bit" if bits else "number"
    lines = [f"### {name}", "", sentence(body["about"]), "", f"| {head} | name |", "|---|---|"]
    return [*lines, *(f"| {value} | {key} |" for key, value in values.items()), ""]


def reference() -> str:
    """Give the page's text."""
    return page(INTRODUCTION, SOURCE)


def strip_reference() -> str:
    """Give the text of the page of the strip's board."""
    return page(STRIP_INTRODUCTION, STRIP_SOURCE)


def page(introduction: str, place: Path) -> str:
    """Write a definition's page."""
    source = tomllib.loads(place.read_text())
    lines = [introduction, "## Messages", ""]
    for name, body in source["messages"].items():
        lines += message(name, body)
    lines += ["## Structures", ""] if source["structs"] else []
    for name, body in source["structs"].items():
        lines += [f"### {name}", "", sentence(body["about"]), "", *fields(body["fields"])]
    lines += ["## Numbers", ""]
    for kind in ("enums", "flags"):
        for name, body in source[kind].items():
            lines += numbers(name, body, kind == "flags")
    lines += ["## Limits", "", "| name | value | meaning |", "|---|---|---|"]
    lines += [f"| {name} | {body['value']} | {body['about']} |" for name, body in source["constants"].items()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    PAGE.write_text(reference())
    STRIP_PAGE.write_text(strip_reference())
