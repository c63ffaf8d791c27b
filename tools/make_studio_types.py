"""Write the studio's messages as TypeScript: web/src/net/messages.ts. Run from the repository root."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import msgspec
from msgspec import inspect

from fdvv.studio import load_parts

TARGET = Path(__file__).resolve().parents[1] / "web" / "src" / "net" / "messages.ts"
HEAD = "// The studio's messages, made by tools/make_studio_types.py from src/fdvv/studio/_messages_*.py.\n"
PLAIN: dict[type[Any], str] = {
    inspect.AnyType: "unknown",
    inspect.NoneType: "null",
    inspect.BoolType: "boolean",
    inspect.IntType: "number",
    inspect.FloatType: "number",
    inspect.StrType: "string",
    inspect.BytesType: "string",
    inspect.RawType: "unknown",
}


class Writer:
    """Collects the types that messages use, each once."""

    def __init__(self) -> None:
        self.found: dict[str, str] = {}
        self._owners: dict[str, type[Any]] = {}

    def name_of(self, kind: inspect.Type) -> str:
        """Give the TypeScript of a type, and remember what it needs."""
        if isinstance(kind, inspect.StructType):
            return self._struct(kind)
        if isinstance(kind, inspect.EnumType):
            return self._remember(kind.cls, " | ".join(_literal(m.value) for m in kind.cls))
        if isinstance(kind, inspect.LiteralType):
            return " | ".join(_literal(value) for value in kind.values)
        if isinstance(kind, inspect.UnionType):
            return " | ".join(self.name_of(t) for t in kind.types)
        if isinstance(kind, inspect.ListType | inspect.VarTupleType | inspect.SetType):
            return f"readonly {_grouped(self.name_of(kind.item_type))}[]"
        if isinstance(kind, inspect.TupleType):
            return f"readonly [{', '.join(self.name_of(t) for t in kind.item_types)}]"
        if isinstance(kind, inspect.DictType):
            return f"Readonly<Record<string, {self.name_of(kind.value_type)}>>"
        if isinstance(kind, inspect.Metadata):
            return self.name_of(kind.type)
        return PLAIN[type(kind)]

    def _struct(self, kind: inspect.StructType) -> str:
        name = kind.cls.__name__
        if self._owners.setdefault(name, kind.cls) is not kind.cls:
            raise ValueError(f"two messages are called {name}")
        if name not in self.found:
            self.found[name] = ""  # messages may hold themselves
            tag = [f"  readonly {kind.tag_field}: {_literal(kind.tag)};"] if kind.tag_field else []
            fields = [self._field(field) for field in kind.fields]
            self.found[name] = "\n".join([f"export interface {name} {{", *tag, *fields, "}"])
        return name

    def _field(self, field: inspect.Field) -> str:
        optional = "" if field.required else "?"
        return f"  readonly {field.encode_name}{optional}: {self.name_of(field.type)};"

    def _remember(self, cls: type[Any], text: str) -> str:
        self.found.setdefault(cls.__name__, f"export type {cls.__name__} = {text};")
        return cls.__name__


def _literal(value: object) -> str:
    return f'"{value}"' if isinstance(value, str) else str(value)


def _grouped(text: str) -> str:
    return f"({text})" if " " in text else text


def reference() -> str:
    """Give the whole file."""
    parts, writer = load_parts(), Writer()

    def named(kinds: tuple[type[msgspec.Struct], ...]) -> str:
        return " | ".join(writer.name_of(inspect.type_info(kind)) for kind in kinds)

    calls = [
        f'  readonly "{c.name}": {{ readonly ask: {named((c.ask,))}; '
        f"readonly answer: {named((c.answer,))} }};"
        for c in sorted(parts.calls.values(), key=lambda c: c.name)
    ]
    channels = [
        f'  readonly "{c.name}": {{ readonly asks: {named(c.asks)}; readonly tells: {named(c.tells)} }};'
        for c in sorted(parts.channels.values(), key=lambda c: c.name)
    ]
    index = ["export interface Calls {", *calls, "}", "", "export interface Channels {", *channels, "}"]
    return HEAD + "\n" + "\n".join(index) + "\n\n" + "\n\n".join(writer.found.values()) + "\n"


if __name__ == "__main__":
    TARGET.parent.mkdir(parents=True, exist_ok=True)
    TARGET.write_text(reference())
    print(TARGET)
