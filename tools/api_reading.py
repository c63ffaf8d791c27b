"""What every room of the package offers, and what is said of it: signatures, fields, meanings, units."""

from __future__ import annotations

import dataclasses
import enum
import importlib
import inspect
import pkgutil
import re
import tomllib
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from types import ModuleType
from typing import Any, Literal

import msgspec
from tools.api_docstrings import Said, named, read
from tools.api_signatures import annotation, call, default, parameters, plain, returned, short, unit_of
from tools.api_source import Assigned, class_body, constants, home

import fdvv

WORDS_FILE = Path(__file__).with_name("api_words.toml")
WORDS: dict[str, dict[str, str]] = tomllib.loads(WORDS_FILE.read_text(encoding="utf-8"))
"""What names of parameters and fields mean where nothing else is said of them, by room; EVERYWHERE in all."""
EVERYWHERE = "everywhere"

Kind = Literal["record", "enumeration", "error", "contract", "class", "function", "value"]


@dataclass(frozen=True)
class Part:
    """A parameter of a function, a field of a record or a member of an enumeration.

    Attributes
    ----------
    name : in the code. type : as it is written there; of a member its value; "" if none.
    default : as code; "" if it is needed.
    meaning : what it is; "" if the text around it tells.
    told : whether anything tells what it is: itself, the text around it, the words of its room or its type.
    """

    name: str
    type: str
    default: str
    meaning: str
    told: bool

    @property
    def unit(self) -> str:
        """Give the unit that the name ends in, "" if it has none."""
        return unit_of(self.name)


@dataclass(frozen=True)
class Thing:
    """A public name, or a method of one.

    Attributes
    ----------
    name : in the code. room : where people import it from. kind : what it is.
    signature : how it is called, or the value of a constant. said : its docstring; None if it has none.
    parts : parameters, fields or members. methods : of a class, in the order of its source.
    """

    name: str
    room: str
    kind: Kind
    signature: str
    said: Said | None
    parts: tuple[Part, ...] = ()
    methods: tuple[Thing, ...] = ()


def rooms() -> list[str]:
    """Give the names of all public modules of the package, the ground among them."""
    found = (module.name for module in pkgutil.iter_modules(fdvv.__path__, "fdvv."))
    return [name for name in found if not name.rpartition(".")[2].startswith("_")]


@cache
def things(room: str) -> tuple[Thing, ...]:
    """Give every public name of a room, by name."""
    module = importlib.import_module(room)
    return tuple(_thing(name, room, getattr(module, name)) for name in public(module))


def public(module: ModuleType) -> list[str]:
    """Give the names a module offers: its ``__all__``, else what it defines itself without underscore."""
    listed = getattr(module, "__all__", None)
    found = set(listed) if listed is not None else _own(module)
    return sorted(found, key=lambda name: (name.lower(), name))


def _own(module: ModuleType) -> set[str]:
    defined = {n for n, value in vars(module).items() if getattr(value, "__module__", "") == module.__name__}
    found = (set(constants(module.__name__)) | defined) - set(map(str, _type_variables(module)))
    return {name for name in found if not name.startswith("_")}


def _type_variables(module: ModuleType) -> list[str]:
    return [n for n, value in vars(module).items() if type(value).__name__ in ("TypeVar", "ParamSpec")]


def _thing(name: str, room: str, found: Any) -> Thing:
    if inspect.isclass(found) and found.__module__.startswith("fdvv"):
        return class_thing(name, room, found)
    if inspect.isroutine(found) or hasattr(found, "__wrapped__"):
        return _function(name, room, found)
    there, own_name = home(room, name)
    told = constants(there).get(own_name, Assigned())
    return Thing(name, room, "value", f"{name} = {short(told.value)}", read(told.text, ())[0])


def class_thing(name: str, room: str, found: type[Any]) -> Thing:
    """Read a class of the package, whether it is offered to everybody or not."""
    made = (found.__doc__ or "").startswith(f"{found.__name__}(")  # by dataclass, where there is none
    doc = "" if made else inspect.cleandoc(found.__doc__ or "")
    kind = _kind(found)
    said, parts = (_members if kind == "enumeration" else _fields)(room, found, doc)
    shown = f"class {name}" + (call(found, "") if kind in ("record", "class") else "")
    fields = {part.name for part in parts}
    own = [
        key for key, value in vars(found).items() if key[0] != "_" and _is_own(value) and key not in fields
    ]
    methods = tuple(_function(key, room, vars(found)[key], parts, doc) for key in own)
    return Thing(name, room, kind, shown, said, parts, methods)


def _kind(found: type[Any]) -> Kind:
    if dataclasses.is_dataclass(found) or issubclass(found, msgspec.Struct):
        return "record"
    if issubclass(found, enum.Enum):
        return "enumeration"
    if issubclass(found, BaseException):
        return "error"
    return "contract" if getattr(found, "_is_protocol", False) else "class"


def _is_own(value: Any) -> bool:
    function = plain(value)
    return inspect.isfunction(function) and function.__module__.startswith("fdvv")


def _function(
    name: str, room: str, found: Any, around: tuple[Part, ...] = (), said_around: str = ""
) -> Thing:
    """Read a function; around : fields of the class that it belongs to; said_around : its docstring."""
    function = plain(found)
    doc = inspect.cleandoc(function.__doc__ or "")
    is_property = function is not found and not isinstance(found, classmethod | staticmethod)
    given = [] if is_property else parameters(function)
    said, entries = read(doc, tuple(p.name for p in given))
    own = {part.name: part.meaning for part in around if part.meaning} | entries
    parts = tuple(_part(room, p, own, f"{doc}\n{said_around}") for p in given)
    shown = returned(function, ": ") if is_property else call(function, returned(function))
    return Thing(name, room, "function", f"{name}{shown}", said, parts)


def _fields(room: str, found: type[Any], doc: str) -> tuple[Said | None, tuple[Part, ...]]:
    """Give text and fields of a record, or the parameters that a class is made with."""
    if _kind(found) in ("error", "contract"):
        return read(doc, ())[0], ()
    made = None if dataclasses.is_dataclass(found) else vars(found).get("__init__")
    more = inspect.cleandoc(made.__doc__ or "") if made is not None else ""  # None has words of its own
    whole = f"{doc}\n\n{more}".strip()
    given = parameters(found)
    said, entries = read(whole, tuple(p.name for p in given))
    return said, tuple(_part(room, p, _field_texts(found) | entries, whole) for p in given)


def _part(room: str, p: inspect.Parameter, own: dict[str, str], text: str) -> Part:
    type_ = annotation(p.annotation)
    meaning = own.get(p.name) or word(room, p.name, type_)
    told = bool(meaning or classes_in(type_)) or named(p.name, text)
    return Part(p.name, type_, default(p.default), meaning, told)


def _field_texts(found: type[Any]) -> dict[str, str]:
    """Give what stands at the fields themselves: text below, the twin's metadata, descriptions of schemas."""
    texts: dict[str, str] = {}
    for base in reversed(found.__mro__):
        if base.__module__.startswith("fdvv"):
            texts |= {name: told.text for name, told in class_body(base).items() if told.text}
    if dataclasses.is_dataclass(found):
        texts |= {field.name: told for field in dataclasses.fields(found) if (told := _told_beside(field))}
    if issubclass(found, msgspec.Struct):
        texts |= _described(found)
    return texts


def _told_beside(field: dataclasses.Field[Any]) -> str:
    """Give meaning and source that a field carries: a parameter of the twin, or a dimension."""
    about = field.metadata.get("about")
    meaning = about.text if about else field.metadata.get("meaning", "")
    source = about.source if about else field.metadata.get("source", "")
    return f"{meaning} (source: {source})" if source else str(meaning)


@cache
def _described(found: type[msgspec.Struct]) -> dict[str, str]:
    info = msgspec.inspect.type_info(found)
    assert isinstance(info, msgspec.inspect.StructType)
    schemas = {field.name: getattr(field.type, "extra_json_schema", None) or {} for field in info.fields}
    return {name: schema["description"] for name, schema in schemas.items() if "description" in schema}


def _members(room: str, found: type[enum.Enum], doc: str) -> tuple[Said | None, tuple[Part, ...]]:
    """Give text and members of an enumeration; a value of several words tells itself."""
    values = {name: str(member.value) for name, member in found.__members__.items()}
    said, entries = read(doc, (*values, *values.values()))
    body = class_body(found)
    parts = []
    for name, value in values.items():
        spoken = named(name, doc) or named(value, doc) or " " in value
        meaning = entries.get(name) or entries.get(value) or body.get(name, Assigned()).text
        meaning = meaning or ("" if spoken else word(room, name))
        parts.append(Part(name, repr(found[name].value), "", meaning, bool(meaning) or spoken))
    return said, tuple(parts)


def word(room: str, name: str, type_: str = "") -> str:
    """Give what a name means where nothing else is said of it, "" if that is nowhere written.

    type_ : a record of the package tells more than a word that holds everywhere.
    """
    everywhere = "" if classes_in(type_) else WORDS[EVERYWHERE].get(name, "")
    return WORDS.get(room, {}).get(name) or everywhere


@cache
def class_homes() -> dict[str, str]:
    """Give the first room that offers each class of the package."""
    found: dict[str, str] = {}
    for room in rooms():
        module = importlib.import_module(room)
        for name in public(module):
            if inspect.isclass(getattr(module, name)):
                found.setdefault(name, room)
    return found


def classes_in(type_: str) -> list[str]:
    """Give the classes of the package that a type names."""
    return [word for word in re.findall(r"[A-Za-z_]\w*", type_) if word in class_homes()]
