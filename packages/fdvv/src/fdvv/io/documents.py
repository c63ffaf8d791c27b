"""Versioned JSON documents that people may edit: how they are laid out, and what is said of a broken one."""

from __future__ import annotations

import json
import math
import re
import tomllib
from collections.abc import Callable, Collection, Iterable, Iterator, Mapping
from dataclasses import Field, dataclass, fields, is_dataclass
from enum import Enum
from functools import cache
from pathlib import Path
from typing import Any, TypeVar

import msgspec
from msgspec.inspect import (
    DataclassType,
    FloatType,
    ListType,
    Metadata,
    StructType,
    Type,
    UnionType,
    VarTupleType,
    type_info,
)

from fdvv.errors import InputError
from fdvv.io.files import open_plain, read_limited

Read = TypeVar("Read")
NEWLINE = b"\n"
"""End of a line, on every system."""


@dataclass(frozen=True)
class Kind:
    """A kind of document.

    Attributes
    ----------
    format, version : what its head must say.
    oldest : the first version that is still read; by default only the newest is.
    name : with its article, for people.
    remedy : what to do about one that cannot be read.
    """

    format: str
    version: int
    name: str
    remedy: str
    oldest: int | None = None

    @property
    def versions(self) -> range:
        """The versions that are read."""
        return range(self.version if self.oldest is None else self.oldest, self.version + 1)


class Head(msgspec.Struct):
    """What is looked at first, whatever else the file holds."""

    format: object = None
    version: object = None


def read_document(
    text: str | bytes,
    source: object,
    kind: Kind,
    read: Callable[[bytes], Read],
    choices: Callable[[str], Iterable[str] | None] = lambda _place: None,
) -> Read:
    """Read a document whose head says that it is one of that kind.

    read : decodes the bytes with msgspec; choices : the words allowed at a place, None for any.
    Raises InputError that names source, the place in it and the remedy.
    """
    data = text.encode(errors="surrogatepass") if isinstance(text, str) else text
    try:
        head = msgspec.json.decode(data, type=Head)
        check_head(head, source, kind)
        return read(data)
    except msgspec.ValidationError as error:
        reason, _, path = str(error).partition(" - at ")
        place = path.strip("`") or "$"
        words = choices(place)
        expected = f", expected one of {', '.join(words)}" if words else ""
        raise InputError(source, place, reason + expected, kind.remedy) from error
    except (msgspec.DecodeError, UnicodeError, RecursionError) as error:
        place = _place(data, str(error))
        raise InputError(source, place, f"not valid JSON ({error})", kind.remedy) from error


def check_head(head: Head, source: object, kind: Kind, at: str = "$") -> None:
    """Raise InputError unless a head is of that kind, and of a version that is read; at : its place."""
    if head.format != kind.format:
        reason = f'not {kind.name} ("format" must be "{kind.format}")'
        raise InputError(source, f"{at}.format", reason, kind.remedy)
    if type(head.version) is not int or head.version not in kind.versions:
        reads = " or ".join(map(str, kind.versions))
        reason = f"file version {head.version!r:.40}, this fdvv reads version {reads}"
        raise InputError(source, f"{at}.version", reason, "install the fdvv that wrote it, or a newer one")


def read_record(path: Path, kind: Kind, record: type[Read], largest_bytes: int) -> Read:
    """Read a file of one record, which no words restrict. Raises InputError."""
    text = read_limited(path, largest_bytes, kind.remedy)
    return read_document(text, path, kind, lambda data: decode(data, record))


def read_toml(data: bytes | str, source: object, remedy: str) -> dict[str, Any]:
    """Read the text of a TOML file. InputError that names source and, where it can, line and column."""
    try:
        text = data if isinstance(data, str) else data.decode()
        return tomllib.loads(text.removeprefix("\ufeff"))
    except UnicodeDecodeError as error:
        raise InputError(source, f"byte {error.start}", "is not UTF-8 text", "save it as UTF-8") from error
    except tomllib.TOMLDecodeError as error:
        found = re.fullmatch(r"(.*) \(at (.*)\)", str(error), re.DOTALL)
        reason, place = (found[1], found[2]) if found else (str(error), "whole file")
        raise InputError(source, place, f"not valid TOML ({reason})", remedy) from error
    except RecursionError as error:
        raise InputError(source, "whole file", "TOML that is nested too deeply", remedy) from error


def _place(data: bytes, reason: str) -> str:
    """Return line and column from the byte a decoder stumbled over; without one the text ended early."""
    found = re.search(r"\(byte (\d+)\)", reason)
    if not found:
        return "end of file" if "truncated" in reason else "whole file"
    before = data[: int(found[1])]
    return f"line {before.count(NEWLINE) + 1}, column {len(before) - before.rfind(NEWLINE)}"


_ENCODER = json.JSONEncoder(ensure_ascii=False, allow_nan=False)
"""Made once: json.dumps makes one for every number."""


def pretty(value: object, one_line: Collection[str] = (), indent: str = "") -> str:
    """Indent objects and lists of them; keep on one line a list of plain values, and an object of nothing
    but the keys one_line.
    """
    deeper = indent + "  "
    if isinstance(value, dict) and set(value) - set(one_line):
        items = [f"{deeper}{json.dumps(k)}: {pretty(v, one_line, deeper)}" for k, v in value.items()]
        return "{\n" + ",\n".join(items) + f"\n{indent}}}"
    if isinstance(value, list) and any(isinstance(v, dict | list) for v in value):
        return "[\n" + ",\n".join(deeper + pretty(v, one_line, deeper) for v in value) + f"\n{indent}]"
    return _ENCODER.encode(value)


def finite(value: Any) -> Any:
    """Put null in the place of every number that JSON cannot hold, however deep."""
    if isinstance(value, dict):
        return {k: finite(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [finite(v) for v in value]
    return None if isinstance(value, float) and not math.isfinite(value) else value


@dataclass(frozen=True)
class Layout:
    """What the records of a file look like there, beyond their declaration.

    Attributes
    ----------
    last : names of fields that follow the others, in this order; long ones are easier to read there.
    needed : names of fields that a file must state, although their record has a default.
    beside : places of further fields, which no record holds.
    """

    last: tuple[str, ...] = ()
    needed: Collection[str] = ()
    beside: Collection[str] = ("$.format", "$.version")

    def sort(self, names: Collection[str]) -> list[str]:
        """Return the names of fields as they follow each other in a file."""
        return sorted(names, key=lambda name: self.last.index(name) + 1 if name in self.last else 0)


PLAIN = Layout()


def decode(data: bytes, record: type[Read], layout: Layout = PLAIN) -> Read:
    """Decode a file of one record. Raises msgspec.ValidationError with the place, also for unknown fields.

    Structs see to their own fields; msgspec lets a dataclass have unknown ones.
    """
    value = msgspec.json.decode(data, type=record)
    _check_fields(msgspec.json.decode(data), record, layout)
    return value


def convert(plain: Any, record: type[Read], layout: Layout = PLAIN) -> Read:
    """Make a record of plain values. Raises as `decode`."""
    value = msgspec.convert(plain, record)
    _check_fields(plain, record, layout)
    return value


def _check_fields(plain: Any, record: Any, layout: Layout) -> None:
    """Raise msgspec.ValidationError for an unknown field, or a missing one that the layout needs."""
    _check(plain, _info(record), layout, "$")


_info = cache(type_info)


def _check(plain: Any, kind: Type, layout: Layout, place: str) -> None:
    for part in _alternatives(kind):
        if isinstance(part, DataclassType | StructType) and isinstance(plain, dict):
            if isinstance(part, DataclassType):
                _check_names(plain, [field.name for field in part.fields], layout, place)
            for field in part.fields:
                if field.name in plain:
                    _check(plain[field.name], field.type, layout, f"{place}.{field.name}")
        elif isinstance(part, ListType | VarTupleType) and not isinstance(part.item_type, FloatType):
            for i, item in enumerate(plain or ()):
                _check(item, part.item_type, layout, f"{place}[{i}]")


def _check_names(plain: Collection[str], names: Collection[str], layout: Layout, place: str) -> None:
    unknown = [name for name in plain if name not in names and f"{place}.{name}" not in layout.beside]
    missing = [name for name in names if name in layout.needed and name not in plain]
    for what, wrong in (("contains unknown", unknown), ("missing required", missing)):
        if wrong:
            at = "" if place == "$" else f" - at `{place}`"  # in msgspec's own words
            raise msgspec.ValidationError(f"Object {what} field `{wrong[0]}`{at}")


def _alternatives(kind: Type) -> Iterator[Type]:
    if isinstance(kind, Metadata):
        yield from _alternatives(kind.type)
    elif isinstance(kind, UnionType):
        for part in kind.types:
            yield from _alternatives(part)
    else:
        yield kind


def to_plain(
    value: Any,
    layout: Layout = PLAIN,
    keep: Callable[[Field[Any], Any], bool] = lambda _field, _value: True,
    special: Callable[[Any], Any] = lambda value: value,
) -> Any:
    """Turn a record into plain values: objects, lists, numbers, words.

    keep : whether a field with this value is written. special : replaces values that JSON holds in their own
    form; by default an array becomes lists.
    """
    value = special(value)
    if is_dataclass(value):
        held = {f.name: part for f in fields(value) if keep(f, part := getattr(value, f.name))}
        return {name: to_plain(held[name], layout, keep, special) for name in layout.sort(held)}
    if isinstance(value, Mapping):
        return {str(name): to_plain(part, layout, keep, special) for name, part in value.items()}
    if isinstance(value, list | tuple):
        return [to_plain(part, layout, keep, special) for part in value]
    if isinstance(value, Enum):
        return value.value
    return value.tolist() if hasattr(value, "tolist") else value


def document(record: object, kind: Kind, version: int | None = None, **how: Any) -> dict[str, Any]:
    """Return the document of a record with its head; how : as for `to_plain`."""
    return {"format": kind.format, "version": version or kind.version, **to_plain(record, **how)}


MODEL, ACTUATION = "an FDVV model", "an actuation"
MARKS = {
    b'"fdvv-model"': MODEL,
    b'"fdvv-actuation"': ACTUATION,
    b'"fdvv-session"': "a session",
    b'"fdvv-receipt"': "a receipt",
}
HEAD_bytes = 200
"""The format is the first field of the files that fdvv writes."""


def own_kind(path: Path) -> str | None:
    """Return what a file holds if fdvv wrote it; None for anything else and for what cannot be read."""
    if path.suffix.lower() != ".json":
        return None
    try:
        with open_plain(path) as stream:
            head = stream.read(HEAD_bytes)
    except (OSError, InputError):
        return None
    return next((kind for mark, kind in MARKS.items() if mark in head), None)
