"""Write the tables of the wire protocols from protocol/fdvv.toml and protocol/strip.toml, for the site."""

from __future__ import annotations

import tomllib
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "protocol" / "fdvv.toml"
LOOP_SOURCE = ROOT / "protocol" / "force_loop.toml"
STRIP_SOURCE = ROOT / "protocol" / "strip.toml"
SIZES = {"u8": 1, "i8": 1, "u16": 2, "i16": 2, "u32": 4, "i32": 4, "f32": 4}


def size_of(kind: str) -> int:
    """Count the bytes of a type such as u16 or u8[10]."""
    base, _, count = kind.partition("[")
    return SIZES[base] * int(count.rstrip("]") or 1)


def fields(rows: list[list[Any]], widened: dict[str, list[float]] | None = None) -> list[str]:
    """Write a structure as a table; widened: ranges of later firmware."""
    lines, place = ["| at | field | type | unit | range | meaning |", "|---|---|---|---|---|---|"], 0
    for name, kind, unit, low, high, about, *_default in rows:
        span = "0" if low == high == 0 else f"{low} to {high}"
        if name in (widened or {}):
            span = "{} to {}; older firmware {}".format(*(widened or {})[name], span)
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


def rig_tables() -> str:
    """Return the tables of the rig's protocol, and of what the force loop adds to it."""
    loop = f"\n{tables(LOOP_SOURCE)}".replace("\n### ", "\n#### ").replace("\n## ", "\n### ")
    return f"{tables(SOURCE)}\n## The force loop\n{loop}"


def strip_tables() -> str:
    """Return the tables of the protocol of the LED strip's board."""
    return tables(STRIP_SOURCE)


def tables(place: Path) -> str:
    """Return all tables of a definition."""
    source = tomllib.loads(place.read_text())
    lines = ["## Messages", ""]
    for name, body in source["messages"].items():
        lines += message(name, body)
    lines += ["## Structures", ""] if source["structs"] else []
    for name, body in source["structs"].items():
        lines += [
            f"### {name}",
            "",
            sentence(body["about"]),
            "",
            *fields(body["fields"], source.get("widened", {}).get(name)),
        ]
    lines += ["## Numbers", ""]
    for kind in ("enums", "flags"):
        for name, body in source[kind].items():
            lines += numbers(name, body, kind == "flags")
    if not source["constants"]:
        return "\n".join(lines) + "\n"
    lines += ["## Limits", "", "| name | value | meaning |", "|---|---|---|"]
    lines += [f"| {name} | {body['value']} | {body['about']} |" for name, body in source["constants"].items()]
    return "\n".join(lines) + "\n"
