"""What stands in the source and is gone once it runs: where a name is defined, and the text below it."""

from __future__ import annotations

import ast
import importlib
import inspect
from dataclasses import dataclass
from functools import cache
from pathlib import Path
from typing import Any


@dataclass(frozen=True)
class Assigned:
    """What a name was given, as code, and the text below; "" if there is none."""

    value: str = ""
    text: str = ""


@cache
def tree(module: str) -> ast.Module:
    """Give the syntax of a module."""
    found = importlib.import_module(module).__file__
    assert found is not None
    return ast.parse(Path(found).read_text(encoding="utf-8"))


@cache
def imported(module: str) -> dict[str, tuple[str, str]]:
    """Give module and name there of all that a module imports from this package, under its name here."""
    nodes = (node for node in ast.walk(tree(module)) if isinstance(node, ast.ImportFrom))
    own = ((node, node.module) for node in nodes if node.module and node.module.startswith("fdvv"))
    return {alias.asname or alias.name: (source, alias.name) for node, source in own for alias in node.names}


def home(module: str, name: str) -> tuple[str, str]:
    """Give the module that defines a name, and its name there, following imports from door to door."""
    there = imported(module).get(name)
    return home(*there) if there else (module, name)


@cache
def constants(module: str) -> dict[str, Assigned]:
    """Give what a module assigns or defines, with the text that stands below each."""
    return _assigned(tree(module).body)


@cache
def class_body(found: type[Any]) -> dict[str, Assigned]:
    """Give what the body of a class assigns, with the text that stands below each."""
    classes = (node for node in ast.walk(tree(found.__module__)) if isinstance(node, ast.ClassDef))
    return next((_assigned(node.body) for node in classes if node.name == found.__name__), {})


def _assigned(body: list[ast.stmt]) -> dict[str, Assigned]:
    texts = (*(_text_of(node) for node in body[1:]), "")
    pairs = zip(body, texts, strict=True)
    found = {
        name: Assigned(value, inspect.cleandoc(text))
        for node, text in pairs
        for name, value in _targets(node)
    }
    functions = (node for node in body if isinstance(node, ast.FunctionDef))
    return {f.name: Assigned("...", ast.get_docstring(f) or "") for f in functions} | found


def _text_of(node: ast.stmt) -> str:
    if isinstance(node, ast.Expr) and isinstance(node.value, ast.Constant):
        return node.value.value if isinstance(node.value.value, str) else ""
    return ""


def _targets(node: ast.stmt) -> list[tuple[str, str]]:
    if isinstance(node, ast.Assign):
        return [pair for target in node.targets for pair in _named(target, node.value)]
    if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
        return [(node.target.id, ast.unparse(node.value) if node.value else "")]
    return []


def _named(target: ast.expr, value: ast.expr) -> list[tuple[str, str]]:
    """Pair names with their values; several names may share a tuple."""
    if isinstance(target, ast.Name):
        return [(target.id, ast.unparse(value))]
    if isinstance(target, ast.Tuple) and isinstance(value, ast.Tuple):
        pairs = zip(target.elts, value.elts, strict=False)
        return [pair for name, given in pairs for pair in _named(name, given)]
    return []
