"""What a person sets for a use case: one record, from which command, message, form and document come.

A field is annotated with what every door needs to know of it::

    class ProbeSettings(Settings):
        presses: Annotated[int, about("Per velocity.", ge=1, le=200)] = 10

The command makes an option of it (`fdvv.cli.settings`), the studio decodes it from its page, the page makes
a field of a form (`tools.make_studio_types`), and the documents a row of a table.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from typing import Any, Literal, Self, dataclass_transform

from msgspec import Meta, Struct, field, inspect, structs

from fdvv import extras
from fdvv.errors import ModelError


# tells mypy what msgspec inherits: settings below these are frozen too
@dataclass_transform(frozen_default=True, kw_only_default=True, field_specifiers=(field,))
class Settings(Struct, frozen=True, kw_only=True, forbid_unknown_fields=True):
    """Base of the settings of a use case.

    Every way to make them checks them: calls from Python, options, messages, files. ModelError names the
    first setting that is out of its bounds, ``check`` may raise more.
    """

    def __post_init__(self) -> None:
        for setting in settings_of(type(self)):
            if reason := setting.refusal(getattr(self, setting.name)):
                raise ModelError(reason)
        self.check()

    def check(self) -> None:
        """Check what no single field shows. Raises ModelError."""

    def replace(self, **changes: Any) -> Self:
        """Return the same settings with some changed."""
        return structs.replace(self, **changes)


def about(
    help: str,
    *,
    option: str = "",
    label: str = "",
    joined: bool = False,
    choices: Sequence[str] = (),
    more: extras.Kind | None = None,
    **bounds: Any,
) -> Meta:
    """Return what is known of a setting; its parts as of `Setting`, bounds as of `Meta`.

    more : what other packages add, whose names are choices too.
    """
    shown = {"option": option, "label": label, "joined": joined}
    return Meta(description=help, extra=shown | {"choices": tuple(choices), "more": more}, **bounds)


UNITS = (("_mm_s", "mm/s"), ("_mm", "mm"))
"""Of settings, by the end of their names."""


@dataclass(frozen=True)
class Setting:
    """One field of settings, as a door shows it.

    Attributes
    ----------
    name, default, help : of the field; `help` is its description, one sentence without a subject.
    kind : of its value; a list has the kind of its items.
    least, most : of a number; None where there is no bound.
    choices : the words allowed; empty for any.
    several, longest : whether it is a list of different items, one at least, and how many there may be.
    optional : None stands for what ``help`` says.
    option : the command's, where its name is not the setting's. label : of a form's field, likewise.
    """

    name: str
    kind: Literal["whole", "number", "text", "flag"]
    default: Any
    help: str
    least: float | None = None
    most: float | None = None
    choices: tuple[str, ...] = ()
    several: bool = False
    longest: int | None = None
    optional: bool = False
    option: str = ""
    label: str = ""
    joined: bool = False

    def refusal(self, value: Any) -> str:
        """Return what is wrong with a value; empty if nothing is."""
        if value is None and self.optional:
            return ""
        if not self.several:
            return "" if self._allows(value) else f"{self.name} must be {self.allowed}, got {value!r}"
        if not 0 < len(value) <= (self.longest or math.inf):
            return f"{self.name} must be 1 to {self.longest} values, got {len(value)}"
        wrong = next((item for item in value if not self._allows(item)), None)
        if wrong is not None:
            return f"{self.name} must be {self.allowed}, got {wrong!r}"
        twice = next((item for item in value if value.count(item) > 1), None)
        return "" if twice is None else f"{self.name} must differ, got {twice!r} more than once"

    @property
    def allowed(self) -> str:
        """What a value, or an item of a list, may be, in words."""
        if self.choices:
            return " or ".join(self.choices)
        noun = {"whole": "a whole number", "number": "a number", "text": "text", "flag": "true or false"}[
            self.kind
        ]
        if self.least is None and self.most is None:
            return noun
        if self.most is None:
            return f"{noun} of {self.least:g} or more"
        unit = next((f" {text}" for end, text in UNITS if self.name.endswith(end)), "")
        return f"{self.least or 0:g} to {self.most:g}{unit}"

    def _allows(self, value: Any) -> bool:
        if self.choices:
            return value in self.choices
        if self.kind in ("text", "flag"):
            return isinstance(value, str if self.kind == "text" else bool)
        kinds = int if self.kind == "whole" else (int, float)
        if not isinstance(value, kinds) or isinstance(value, bool) or not math.isfinite(value):
            return False
        return (self.least is None or value >= self.least) and (self.most is None or value <= self.most)


_SETTINGS: dict[type[Settings], tuple[Setting, ...]] = {}


def settings_of(kind: type[Settings]) -> tuple[Setting, ...]:
    """Return the settings of a record, in the order of its fields."""
    if kind not in _SETTINGS:
        info = inspect.type_info(kind)
        assert isinstance(info, inspect.StructType)
        _SETTINGS[kind] = tuple(map(_setting, info.fields))
    return _SETTINGS[kind]


KINDS = {
    inspect.IntType: "whole",
    inspect.FloatType: "number",
    inspect.StrType: "text",
    inspect.LiteralType: "text",
    inspect.BoolType: "flag",
}


def _setting(field: inspect.Field) -> Setting:
    facts: dict[str, Any] = {"help": ""}
    for part in _parts(field.type):
        if isinstance(part, inspect.Metadata):
            facts["help"] = (part.extra_json_schema or {}).get("description", facts["help"])
            facts |= part.extra or {}
        elif isinstance(part, inspect.NoneType):
            facts["optional"] = True
        elif isinstance(part, inspect.VarTupleType):
            facts |= {"several": True, "longest": part.max_length}
        elif isinstance(part, inspect.LiteralType):
            facts |= {"kind": "text", "choices": _default_first(part.values, field.default)}
        elif type(part) in KINDS:
            facts |= {
                "kind": KINDS[type(part)],
                "least": getattr(part, "ge", None),
                "most": getattr(part, "le", None),
            }
    if more := facts.pop("more", None):
        facts["choices"] += extras.names(more)
    return Setting(field.name, default=field.default, **facts)


def _default_first(choices: Sequence[Any], default: Any) -> tuple[str, ...]:
    # msgspec sorts them
    return tuple(sorted(map(str, choices), key=lambda choice: choice != default))


def _parts(kind: inspect.Type) -> Iterator[inspect.Type]:
    """Yield a type and what it is made of, outer ones first."""
    yield kind
    inner: tuple[inspect.Type, ...] = ()
    if isinstance(kind, inspect.Metadata):
        inner = (kind.type,)
    elif isinstance(kind, inspect.UnionType):
        inner = kind.types
    elif isinstance(kind, inspect.VarTupleType):
        inner = (kind.item_type,)
    for part in inner:
        yield from _parts(part)
