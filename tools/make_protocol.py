"""Turn protocol/*.toml into the C headers of the firmware and the Python tables of fdvv and fdvv-strip.

fdvv.toml becomes protocol.h and fdvv.protocol.tables; force_loop.toml, which extends it, a header of its own
and part of the same tables; strip.toml, whose `stem` is part of every name made from it, strip_protocol.h and
fdvv_strip.tables. All but fdvv.protocol.tables are committed; hatch_build.py writes that. It loads this file
by its path, so only the standard library is imported.
"""

from __future__ import annotations

import hashlib
import json
import sys
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

ROOT = Path(__file__).resolve().parents[1]
SOURCE = ROOT / "protocol" / "fdvv.toml"
HEADER = ROOT / "firmware" / "core" / "protocol.h"
TABLES = ROOT / "packages/fdvv/src/fdvv/protocol/tables.py"
LOOP_SOURCE = ROOT / "protocol" / "force_loop.toml"
LOOP_HEADER = ROOT / "firmware" / "force_loop" / "loop_protocol.h"
STRIP_SOURCE = ROOT / "protocol" / "strip.toml"
STRIP_HEADER = ROOT / "firmware" / "core" / "strip_protocol.h"
STRIP_TABLES = ROOT / "extras" / "fdvv-strip" / "src" / "fdvv_strip" / "tables.py"
SIZES = {"u8": 1, "i8": 1, "u16": 2, "i16": 2, "u32": 4, "i32": 4, "f32": 4}
C_TYPES = {kind: f"{'u' if kind[0] == 'u' else ''}int{kind[1:]}_t" for kind in SIZES} | {"f32": "float"}
NOTES = ("about", "class")
"""Keys of a definition that carry no meaning for the other side."""
FORMATS = {"u8": "B", "i8": "b", "u16": "H", "i16": "h", "u32": "I", "i32": "i", "f32": "f"}
MEANING = 5
"""Of a field's row, so many elements carry meaning: not the prose, nor the value in older files."""


@dataclass(frozen=True)
class Field:
    """One number, or a run of bytes or numbers, of a structure; default: in files from before it."""

    name: str
    kind: str
    count: int
    unit: str
    low: float
    high: float
    about: str
    default: float | list[float] | None = None

    @classmethod
    def of(cls, row: list[Any]) -> Field:
        """Read [name, type, unit, low, high, about] and, where there is one, the default."""
        name, kind, *rest = row
        kind, _, count = kind.partition("[")
        return cls(name, kind, int(count.rstrip("]") or 0), *rest)

    @property
    def size(self) -> int:
        """Bytes."""
        return SIZES[self.kind] * max(1, self.count)

    @property
    def is_bytes(self) -> bool:
        """Whether it is a run of bytes, which no range is checked for."""
        return self.count > 0 and self.kind != "f32"

    @property
    def members(self) -> list[str]:
        """Names of its numbers in C."""
        return [f"{self.name}[{i}]" for i in range(self.count)] if self.count else [self.name]

    @property
    def text(self) -> str:
        """Unit, range and reason, for a comment."""
        words = [w for w in (self.unit, f"{self.low} to {self.high}" if self.high else "", self.about) if w]
        return "; ".join(words)


def fields_of(name: str, rows: list[list[Any]], widened: dict[str, list[float]]) -> list[Field]:
    """Read a structure with its widened ranges; fail where a field does not lie at a multiple of its size."""
    unwidened = [Field.of(row) for row in rows]
    fields = [_widen(name, field, *widened.get(field.name, (field.low, field.high))) for field in unwidened]
    unknown = set(widened) - {field.name for field in fields}
    if unknown:
        raise SystemExit(f"{name} has no field {', '.join(sorted(unknown))} to widen")
    offset = 0
    for field in fields:
        if offset % SIZES[field.kind]:
            raise SystemExit(f"{name}.{field.name} lies at {offset}, no multiple of its size")
        offset += field.size
    if fields and offset % max(SIZES[f.kind] for f in fields):
        raise SystemExit(f"{name} has {offset} bytes, no multiple of its widest field")
    return fields


def _widen(name: str, field: Field, low: float, high: float) -> Field:
    if low > field.low or high < field.high:
        raise SystemExit(f"{name}.{field.name} is narrowed, which older boards and files would not know")
    return replace(field, low=low, high=high)


def structures(source: dict[str, Any]) -> dict[str, list[Field]]:
    """Return every structure by name: the named ones, and NAME_request and NAME_reply of the messages."""
    wide = source.get("widened", {})
    by_name = {n: fields_of(n, body["fields"], wide.get(n, {})) for n, body in source["structs"].items()}
    for name, body in source["messages"].items():
        for part, key in (("request", "fields"), ("reply", "reply")):
            if isinstance(body.get(key), list) and body[key]:
                by_name[f"{name}_{part}"] = fields_of(name, body[key], {})
    return by_name


def extended(source: dict[str, Any], *extensions: dict[str, Any]) -> dict[str, Any]:
    """Return a definition with its extensions in it, for tables; the hash is that of the definition alone."""
    whole = {**source, "hash": meaning_hash(source)}
    for more in extensions:
        for key in ("constants", "structs", "messages", "defaults"):
            whole[key] = {**whole[key], **more[key]}
        for key in ("enums", "flags"):
            whole[key] = {**whole[key]}
            for name, body in more[key].items():
                known = whole[key].get(name)
                whole[key][name] = {**known, **_values(body)} if known else body
        whole["extensions"] = {**whole.get("extensions", {}), more["name"]: meaning_hash(more)}
    return whole


def _values(body: dict[str, Any]) -> dict[str, int]:
    return {key: value for key, value in body.items() if key not in NOTES}


def stem_of(source: dict[str, Any]) -> str:
    """Return the prefix of every name of a definition: "" or "strip_"."""
    return f"{source['stem']}_" if "stem" in source else ""


def file_of(source: dict[str, Any]) -> str:
    return f"protocol/{source.get('stem', source.get('name', 'fdvv'))}.toml"


def about(source: dict[str, Any], name: str) -> str:
    if name in source["structs"]:
        return str(source["structs"][name]["about"])
    base, _, part = name.rpartition("_")
    return f"{source['messages'][base]['about']} ({part})"


def meaning_hash(source: dict[str, Any]) -> int:
    """Return 32 bits of the SHA-256 of names, types, order, ranges and numbers.

    Neither prose nor widened ranges count: they do not change what bytes mean.
    """
    if "hash" in source:
        return int(source["hash"])
    plain = {key: value for key, value in source.items() if key not in ("version", "defaults", "widened")}

    def strip(node: Any) -> Any:
        if isinstance(node, dict):
            return {key: strip(value) for key, value in node.items() if key not in NOTES}
        if isinstance(node, list) and len(node) > MEANING and isinstance(node[0], str):
            return node[:MEANING]
        return [strip(item) for item in node] if isinstance(node, list) else node

    digest = hashlib.sha256(json.dumps(strip(plain), sort_keys=True).encode()).digest()
    return int.from_bytes(digest[:4], "little")


def sizes(source: dict[str, Any], structs: dict[str, list[Field]], name: str, key: str) -> int:
    """Return the bytes of a message's request or reply."""
    body = source["messages"][name].get(key, [])
    fields = structs[body] if isinstance(body, str) else structs.get(f"{name}_{_part(key)}", [])
    return sum(field.size for field in fields)


def _part(key: str) -> str:
    return "request" if key == "fields" else "reply"


# -- C ------------------------------------------------------------------------------------------------------


def header(source: dict[str, Any]) -> str:
    """Write the C header."""
    structs, stem = structures(source), _c_stem(source)
    stem += f"{source['name']}_".upper() if "extends" in source else ""
    lines = [
        f"/* Made by tools/make_protocol.py from {file_of(source)}; do not edit. */",
        f"#ifndef {stem}PROTOCOL_H",
        f"#define {stem}PROTOCOL_H",
        "",
        "#include <stdint.h>",
        "",
        *(['#include "protocol.h"', ""] if "extends" in source else []),
        f"#define {stem}PROTOCOL_VERSION {source['version']}",
        f"#define {stem}PROTOCOL_HASH 0x{meaning_hash(source):08x}u",
        "",
    ]
    lines += [
        f"#define {stem}{k.upper()} {v['value']} /* {v['about']} */" for k, v in source["constants"].items()
    ]
    for kind in ("enums", "flags"):
        for name, body in source[kind].items():
            lines += ["", f"/* {body['about']} */", "enum {", *_c_members(source, kind, name), "};"]
    for name, fields in structs.items():
        lines += ["", *_c_struct(source, name, fields)]
    lines += ["", *_c_messages(source, structs), *_c_defaults(source), "#endif", ""]
    return "\n".join(lines)


def _c_stem(source: dict[str, Any]) -> str:
    return f"FDVV_{stem_of(source)}".upper()


def _c_members(source: dict[str, Any], kind: str, name: str) -> list[str]:
    values, stem = _values(source[kind][name]), f"{_c_stem(source)}{name.upper()}"
    if kind == "flags":
        return [f"    {stem}_FLAG_{k.upper()} = 1 << {v}," for k, v in values.items()]
    # of an enumeration that begins elsewhere the count would be wrong
    count = [f"    {stem}S = {len(values)},"] if min(values.values()) == 0 else []
    return [*(f"    {stem}_{k.upper()} = {v}," for k, v in values.items()), *count]


def _c_struct(source: dict[str, Any], name: str, fields: list[Field]) -> list[str]:
    lines = [f"/* {about(source, name)} */", "typedef struct {"]
    for field in fields:
        array = f"[{field.count}]" if field.count else ""
        lines.append(f"    {C_TYPES[field.kind]} {field.name}{array}; /* {field.text} */")
    total = sum(field.size for field in fields)
    c_name, macro = f"fdvv_{stem_of(source)}{name}", f"{_c_stem(source)}{name.upper()}"
    lines += [
        f"}} {c_name};",
        f"typedef char {c_name}_has_{total}_bytes[sizeof({c_name}) == {total} ? 1 : -1];",
    ]
    ranged = [f for f in fields if not f.is_bytes and not _full(f)]
    lines.append(f"#define {macro}_RANGES(X) \\")
    lines += [f"    X({name}, {_c(f, f.low)}, {_c(f, f.high)}) \\" for f in ranged for name in f.members]
    if name in source["defaults"]:  # a refusal names the field by its number
        members = (f"    {macro}_FIELD_{f.name}," for f in fields)
        lines += ["", "enum {", *members, f"    {macro}_FIELDS,", "};"]
    return [*lines, ""]


def _c(field: Field, number: float) -> str:
    return f"{float(number)!r}f" if field.kind == "f32" else str(number)


def _full(field: Field) -> bool:
    if field.kind == "f32":
        return False
    bits = 8 * SIZES[field.kind]
    low, high = (0, 2**bits - 1) if field.kind[0] == "u" else (-(2 ** (bits - 1)), 2 ** (bits - 1) - 1)
    return field.low <= low and field.high >= high


def _c_messages(source: dict[str, Any], structs: dict[str, list[Field]]) -> list[str]:
    name = f"{source['name']}_".upper() if "extends" in source else ""
    lines = ["/* name, id, bytes of the request (or of what is sent unasked), bytes of the reply */"]
    lines.append(f"#define {_c_stem(source)}{name}MESSAGES(X) \\")
    for name, body in source["messages"].items():
        counts = (sizes(source, structs, name, key) for key in ("fields", "reply"))
        lines.append(f"    X({name.upper()}, 0x{body['id']:02x}, {', '.join(map(str, counts))}) \\")
    lines += ["", "enum {"]
    lines += [
        f"    {_c_stem(source)}MSG_{k.upper()} = 0x{v['id']:02x}, /* {v['about']} */"
        for k, v in source["messages"].items()
    ]
    return [*lines, "};", ""]


def _c_defaults(source: dict[str, Any]) -> list[str]:
    lines = []
    for name, values in source["defaults"].items():
        order = [Field.of(row).name for row in source["structs"][name]["fields"]]
        lines += [f"#define {_c_stem(source)}{name.upper()}_DEFAULTS \\", "    { \\"]
        lines += [f"        {values[field]}, /* {field} */ \\" for field in order]
        lines += ["    }", ""]
    return lines


# -- Python -------------------------------------------------------------------------------------------------


def tables(source: dict[str, Any]) -> str:
    """Write the Python module."""
    structs, stem = structures(source), stem_of(source).upper()
    lines = [
        f'"""Made by tools/make_protocol.py from {file_of(source)}; do not edit."""',
        "",
        "from __future__ import annotations",
        "",
        "from dataclasses import dataclass",
        "from enum import IntEnum, IntFlag",
        "from typing import ClassVar",
        "",
        f"from fdvv.protocol.record import Limits, {'Reals, ' if 'extensions' in source else ''}Record",
        "",
        f"{stem}VERSION = {source['version']}",
        '"""Of the definition."""',
        f"{stem}HASH = 0x{meaning_hash(source):08X}",
        '"""Of what the definition means; host and firmware compare it on connecting."""',
    ]
    for name, value in source.get("extensions", {}).items():
        lines += [f"{name.upper()}_HASH = 0x{value:08X}", f'"""The same of protocol/{name}.toml."""']
    lines += [""]
    for name, body in source["constants"].items():
        lines += [f"{stem}{name.upper()} = {body['value']}", f'"""{_sentence(body["about"])}"""']
    for kind in ("enums", "flags"):
        for name, body in source[kind].items():
            lines += _py_enum(kind, f"{stem_of(source)}{name}", body)
    lines += _py_messages(source, structs)
    for name, fields in structs.items():
        lines += _py_record(source, name, fields)
    return "\n".join(lines) + "\n"


def camel(name: str) -> str:
    """Turn image_header into ImageHeader."""
    return "".join(word.capitalize() for word in name.split("_"))


def _sentence(text: str) -> str:
    return text[0].upper() + text[1:].rstrip(".") + "."


def _py_enum(kind: str, name: str, body: dict[str, Any]) -> list[str]:
    values = _values(body)
    title = body.get("class", camel(name) + ("Flag" if kind == "flags" else ""))
    lines = [
        "",
        "",
        f"class {title}({'IntFlag' if kind == 'flags' else 'IntEnum'}):",
        f'    """{_sentence(body["about"])}"""',
        "",
    ]
    return lines + [f"    {k.upper()} = {f'1 << {v}' if kind == 'flags' else v}" for k, v in values.items()]


def _py_messages(source: dict[str, Any], structs: dict[str, list[Field]]) -> list[str]:
    enum = camel(f"{stem_of(source)}message")
    lines = ["", "", f"class {enum}(IntEnum):", '    """Numbers of the messages."""', ""]
    for name, body in source["messages"].items():
        lines += [f"    {name.upper()} = 0x{body['id']:02X}", f'    """{_sentence(body["about"])}"""']
    lines += [""]
    for key in ("fields", "reply"):
        title = stem_of(source).upper() + ("REQUEST_BYTES" if key == "fields" else "REPLY_BYTES")
        lines += ["", f"{title} = {{"]
        lines += [f"    {enum}.{n.upper()}: {sizes(source, structs, n, key)}," for n in source["messages"]]
        lines += ["}", f'"""Bytes of every {"request" if key == "fields" else "reply"}."""']
    return lines


def _py_record(source: dict[str, Any], name: str, fields: list[Field]) -> list[str]:
    form = "<" + "".join(f"{f.count}s" if f.is_bytes else (f.count or 1) * FORMATS[f.kind] for f in fields)
    title = source["structs"].get(name, {}).get("class", camel(stem_of(source) + name))
    lines = ["", "", "@dataclass(frozen=True, kw_only=True)", f"class {title}(Record):"]
    lines += [f'    """{_sentence(about(source, name))}', "", "    Attributes", "    ----------"]
    lines += [f"    {f.name} : {f.text or 'zero'}" for f in fields]
    lines += ['    """', "", f'    FORMAT: ClassVar[str] = "{form}"', "    LIMITS: ClassVar[Limits] = {"]
    lines += [f'        "{f.name}": ({f.low}, {f.high}),' for f in fields if not f.count and f.kind != "f32"]
    lines += ["    }"]
    reals = [f'        "{f.name}": ({f.low}, {f.high}),' for f in fields if f.kind == "f32"]
    lines += ["    REALS: ClassVar[Reals] = {", *reals, "    }"] if reals else []
    runs = ", ".join(f'"{f.name}": {f.count}' for f in fields if f.count and not f.is_bytes)
    lines += [f"    RUNS: ClassVar[dict[str, int]] = {{{runs}}}"] if runs else []
    lines += [""]
    defaults = source["defaults"].get(name, {})
    return lines + [_py_field(field, defaults) for field in fields]


def _py_field(field: Field, defaults: dict[str, int]) -> str:
    kind = "float" if field.kind == "f32" else "int"
    kind = "bytes" if field.is_bytes else "tuple[float, ...]" if field.count else kind
    if field.default is not None:
        value = tuple(field.default) if isinstance(field.default, list) else field.default
        return f"    {field.name}: {kind} = {value}"
    if field.name in defaults:
        return f"    {field.name}: {kind} = {defaults[field.name]}"
    return f"    {field.name}: {kind}" + (" = 0" if field.name.startswith("spare") else "")


def write_tables(path: Path = TABLES) -> Path:
    """Write the Python tables that the build makes to a path; return it."""
    _write(path, tables(extended(_load(SOURCE), _load(LOOP_SOURCE))))
    return path


def write_committed() -> list[Path]:
    """Write the C headers of all definitions and the strip's Python tables; return their paths."""
    strip = _load(STRIP_SOURCE)
    _write(HEADER, header(_load(SOURCE)))
    _write(LOOP_HEADER, header(_load(LOOP_SOURCE)))
    _write(STRIP_HEADER, header(strip))
    _write(STRIP_TABLES, tables(strip))
    return [HEADER, LOOP_HEADER, STRIP_HEADER, STRIP_TABLES]


def _load(path: Path) -> dict[str, Any]:
    return tomllib.loads(path.read_text(encoding="utf-8"))


def _write(path: Path, text: str) -> None:
    """Leave an equal file untouched, so that make rebuilds nothing."""
    if not path.exists() or path.read_text(encoding="utf-8") != text:
        path.write_text(text, encoding="utf-8", newline="\n")


if __name__ == "__main__":
    for written in (*write_committed(), write_tables()):
        sys.stdout.write(f"{written.relative_to(ROOT)}\n")
