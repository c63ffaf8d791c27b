"""What others rely on: public names, messages on the wire, every command's help, shipped files."""

from __future__ import annotations

import importlib
import inspect
import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from types import ModuleType
from typing import Any

import msgspec
from msgspec import inspect as types
from tools.snapshot.commands import ROOT, Commands
from tools.snapshot.values import digest
from tools.snapshot.worker import PACKAGES

PLAIN: dict[type[types.Type], str] = {
    types.AnyType: "anything",
    types.NoneType: "null",
    types.BoolType: "boolean",
    types.IntType: "integer",
    types.FloatType: "number",
    types.StrType: "text",
    types.BytesType: "base64",
    types.RawType: "anything",
}
BOUNDS = ("gt", "ge", "lt", "le", "min_length", "max_length", "pattern")
NOT_DATA = {".py", ".pyc", ".so", ".dylib", ".dll", ".c", ".h", ".typed", ""}
"""Sources and compiled code change; the studio's page, in static, is built and tested from web/."""


def facade() -> str:
    """Return the public names of each package with their signatures; of a class with those of its members."""
    packages = map(importlib.import_module, PACKAGES)
    return "\n".join(
        line
        for package in packages
        for name in sorted(getattr(package, "__all__", ()))
        for line in public_lines(package, name)
    )


def public_lines(package: ModuleType, name: str) -> Iterator[str]:
    value = getattr(package, name)
    if name == "__version__":
        return
    yield f"{type(value).__name__} {name}{signature(value)}"
    if inspect.isclass(value):
        for member in sorted(vars(value)):
            if not member.startswith("_"):
                held = inspect.getattr_static(value, member)
                yield f"  {type(held).__name__} {member}{signature(getattr(value, member))}"


def signature(value: object) -> str:
    """Return the signature of what can be called; of others nothing."""
    try:
        return re.sub(r" at 0x\w+", "", str(inspect.signature(value))) if callable(value) else ""
    except ValueError:
        return ""


def wire() -> str:
    """Return every message of the studio and of fdvv serve, as JSON has it: without the names of records."""
    parts = importlib.import_module("fdvv_studio.studio.parts").load_parts()
    lines = []
    for call in sorted(parts.calls.values(), key=lambda call: str(call.name)):
        lines += [f"call {call.name}", *message("asks", call.ask), *message("answers", call.answer)]
    for channel in sorted(parts.channels.values(), key=lambda channel: str(channel.name)):
        lines += [f"channel {channel.name}"]
        lines += [line for kind in channel.asks for line in message("asks", kind)]
        lines += [line for kind in channel.tells for line in message("tells", kind)]
    requests = importlib.import_module("fdvv_campaigns.serve.messages").REQUESTS
    answers = vars(importlib.import_module("fdvv_campaigns.serve.answers"))
    base = requests[0].__mro__[-4]
    lines += ["serve", *(line for kind in requests for line in message("asks", kind))]
    lines += [
        line
        for kind in answers.values()
        if inspect.isclass(kind) and issubclass(kind, base) and kind is not base
        for line in message("tells", kind)
    ]
    return "\n".join(lines)


def message(role: str, kind: type[Any]) -> list[str]:
    first, *others = type_lines(types.type_info(kind), ())
    return [f"  {role} {first}", *(f"  {line}" for line in others)]


def type_lines(kind: types.Type, outer: Sequence[type[Any]]) -> list[str]:
    """Return the JSON of a type: of a record a line for each field. outer : records that it is within."""
    if isinstance(kind, types.Metadata):
        return type_lines(kind.type, outer)
    if isinstance(kind, types.StructType | types.DataclassType):
        return record_lines(kind, outer)
    if isinstance(kind, types.UnionType):
        return joined([type_lines(one, outer) for one in kind.types])
    if isinstance(kind, types.DictType):
        return prefixed("by name: ", type_lines(kind.value_type, outer))
    if isinstance(kind, types.TupleType):
        return prefixed("in turn: ", joined([type_lines(one, outer) for one in kind.item_types]))
    if isinstance(kind, types.ListType | types.VarTupleType | types.SetType | types.FrozenSetType):
        return prefixed("list of ", type_lines(kind.item_type, outer))
    if isinstance(kind, types.EnumType):
        return [" | ".join(repr(member.value) for member in kind.cls)]
    if isinstance(kind, types.LiteralType):
        return [" | ".join(map(repr, kind.values))]
    bounds = [f"{name} {value}" for name in BOUNDS if (value := getattr(kind, name, None)) is not None]
    return [PLAIN[type(kind)] + (f" ({', '.join(bounds)})" if bounds else "")]


def record_lines(kind: types.StructType | types.DataclassType, outer: Sequence[type[Any]]) -> list[str]:
    if kind.cls in outer:
        return ["record as above"]
    tag = f" {kind.tag_field}={kind.tag!r}" if isinstance(kind, types.StructType) and kind.tag_field else ""
    lines = [f"record{tag}"]
    for field in kind.fields:
        type_, *others = type_lines(field.type, (*outer, kind.cls))
        lines += [f"  {field.encode_name}: {type_}{default_of(field)}", *(f"  {line}" for line in others)]
    return lines


def default_of(field: types.Field) -> str:
    """Return the value of a field that may be left out; nothing of one that may not."""
    if field.required:
        return ""
    value = field.default if field.default_factory is msgspec.NODEFAULT else field.default_factory()
    return f" = {msgspec.json.encode(value).decode()}"


def prefixed(prefix: str, lines: list[str], others: str = "") -> list[str]:
    return [prefix + lines[0], *(others + line for line in lines[1:])]


def joined(alternatives: list[list[str]]) -> list[str]:
    if all(len(lines) == 1 for lines in alternatives):
        return [" | ".join(line for lines in alternatives for line in lines)]
    return ["any of", *(line for lines in alternatives for line in prefixed("  - ", lines, "    "))]


def helps(commands: Commands, words: tuple[str, ...] = ()) -> str:
    """Return the help of a command and of those below it."""
    text = commands.run([*words, "--help"], ROOT).output.decode()
    plain = re.sub(
        r"\n {20,}(?=\S)|(?<=\S) {2,}", " ", text
    )  # options in one line, however wide the terminal
    parts = [f"== $ {' '.join((*words, '--help'))}\n{plain}"]
    if "COMMAND" in text.partition("\n")[0]:
        sections = re.findall(r"^(\S.*):\n((?:  .*\n)+)", text, flags=re.MULTILINE)
        listed = "".join(body for title, body in sections if title != "Options")
        parts += [helps(commands, (*words, name)) for name in re.findall(r"^  (\S+)  ", listed, re.MULTILINE)]
    return "\n".join(parts)


def files() -> str:
    """Return a digest of each data file that is shipped, by its bare name, and of what defines the wire."""
    sources = sorted(ROOT.glob("packages/*/src"))
    shipped = [path for source in sources for path in source.rglob("*") if is_data(path)]
    defined = [path for path in (ROOT / "protocol").iterdir() if path.is_file()]
    hashes = [
        f"{name} {value}"
        for header in sorted((ROOT / "firmware").rglob("*protocol.h"))
        for name, value in re.findall(r"#define (\w*PROTOCOL_HASH) (\w+)", header.read_text())
    ]
    return "\n".join([*file_lines(shipped), *file_lines(defined), *hashes])


def is_data(path: Path) -> bool:
    return path.is_file() and path.suffix not in NOT_DATA and not {"static", "__pycache__"} & set(path.parts)


def file_lines(paths: list[Path]) -> list[str]:
    return sorted(f"{path.name} {digest(path.read_bytes())}" for path in paths)
