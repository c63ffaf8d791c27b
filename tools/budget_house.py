"""What the brake counts in our own Python modules: arrows, records, protocols, importers and names."""

from __future__ import annotations

import ast
import gc
import re
from collections import Counter, defaultdict
from collections.abc import Callable, Container, Iterable, Mapping
from dataclasses import dataclass, field
from functools import cache
from importlib.util import resolve_name
from itertools import combinations
from pathlib import Path
from typing import Any

from tools.budget_file import Row

FEWEST_FIELDS = 4
SHARED_ratio = 0.8
"""Two records are a pair if they share this part of the larger one's fields."""

IRREGULAR = """
become begun bent born bought bound broken brought built caught chosen dealt done drawn driven felt forgotten
found given gone grown heard held hidden kept known laid left lent lost made meant met paid said seen sent
shown sold spent spoken stood stuck swept taken taught thought thrown torn understood undone unknown won
worn written
"""
NO_PARTICIPLE = "bed breed embed exceed feed need proceed red seed shed speed succeed"
"""Words in -ed that are verbs or nouns."""


@dataclass(frozen=True)
class Class:
    """A class: its annotated fields, everything its instances have, and the names of its bases."""

    name: str
    fields: frozenset[str]
    members: frozenset[str]
    bases: tuple[str, ...]


@dataclass
class Module:
    """What is counted of a module; ``package`` is where its relative imports start."""

    name: str
    package: str
    exports: int = 0
    imports: set[str] = field(default_factory=set)
    functions: list[str] = field(default_factory=list)
    identifiers: list[str] = field(default_factory=list)
    classes: list[Class] = field(default_factory=list)


def count_house(paths: Mapping[str, Path]) -> dict[Row, int]:
    """Return the figures of all modules, given as files by their dotted name."""
    collects = gc.isenabled()
    gc.disable()  # a tree is many small objects: to look for circles in them takes longer than to parse
    try:
        modules = [read_module(name, path) for name, path in paths.items()]
    finally:
        if collects:
            gc.enable()
    return {
        **count_arrows(modules),
        **count_names(modules),
        **pair_records(modules),
        **find_lonely_protocols(modules),
    }


def read_module(name: str, path: Path) -> Module:
    """Parse a file, and note what is counted."""
    module = Module(name, package=name if path.name == "__init__.py" else name.rpartition(".")[0])
    for node in ast.walk(ast.parse(path.read_bytes(), filename=str(path))):
        if read := _READERS.get(type(node)):
            read(module, node)
    return module


def _read_function(module: Module, node: ast.FunctionDef | ast.AsyncFunctionDef) -> None:
    module.functions.append(node.name)
    module.identifiers.append(node.name)


def _read_argument(module: Module, node: ast.arg) -> None:
    module.identifiers.append(node.arg)


def _read_name(module: Module, node: ast.Name) -> None:
    if isinstance(node.ctx, ast.Store):
        module.identifiers.append(node.id)


def _read_assignment(module: Module, node: ast.Assign) -> None:
    match node:
        case ast.Assign([ast.Name("__all__")], ast.List(names) | ast.Tuple(names)):
            module.exports = len(names)


def _read_import(module: Module, node: ast.Import) -> None:
    module.imports.update(alias.name for alias in node.names)


def _read_import_from(module: Module, node: ast.ImportFrom) -> None:
    source = resolve_name("." * node.level + (node.module or ""), module.package)
    module.imports.update(f"{source}.{alias.name}" for alias in node.names)


def _read_class(module: Module, node: ast.ClassDef) -> None:
    module.identifiers.append(node.name)
    fields = {
        statement.target.id
        for statement in node.body
        if isinstance(statement, ast.AnnAssign) and isinstance(statement.target, ast.Name)
        if "ClassVar" not in ast.dump(statement.annotation)
    }
    methods = [each for each in node.body if isinstance(each, ast.FunctionDef | ast.AsyncFunctionDef)]
    members = fields.union(each.name for each in methods)
    for method in methods:
        if method.name == "__init__":
            members.update(_attributes_set_in(method))
    bases = tuple(_last_name(base) for base in node.bases)
    module.classes.append(Class(node.name, frozenset(fields), frozenset(members), bases))


def _attributes_set_in(method: ast.AST) -> set[str]:
    nodes = ast.walk(method)
    return {
        node.attr for node in nodes if isinstance(node, ast.Attribute) and isinstance(node.ctx, ast.Store)
    }


def _last_name(base: ast.expr) -> str:
    """Return ``Plan`` for ``Plan``, ``plan.Plan`` and ``Plan[T]``."""
    return ast.unparse(base).partition("[")[0].rpartition(".")[2]


_READERS: dict[type[ast.AST], Callable[[Module, Any], None]] = {
    ast.FunctionDef: _read_function,
    ast.AsyncFunctionDef: _read_function,
    ast.arg: _read_argument,
    ast.Name: _read_name,
    ast.Assign: _read_assignment,
    ast.Import: _read_import,
    ast.ImportFrom: _read_import_from,
    ast.ClassDef: _read_class,
}


def package_of(module: str) -> str:
    """Return the package that a budget names: ``study`` for ``fdvv_people.study.plan``, or
    ``fdvv_rig.cad``."""
    return ".".join(module.split(".")[:2]).removeprefix("fdvv.")


def count_arrows(modules: Iterable[Module]) -> dict[Row, int]:
    """Return the arrows between packages, the importers of ``force_text``, and modules with one importer."""
    names = {module.name for module in modules}
    importers: Counter[str] = Counter()
    counts: Counter[Row] = Counter()
    for module in modules:
        imported = {_nearest_of(names, name) for name in module.imports} - {""}
        importers.update(imported)
        package = package_of(module.name)
        for other in {package_of(name) for name in imported} - {package}:
            counts[Row("arrows", package, other)] = 1
        counts[Row("force_text", package)] += any(name.endswith(".force_text") for name in imported)
    counts[Row("counts", "modules with one importer")] = list(importers.values()).count(1)
    return dict(counts)


def _nearest_of(names: Container[str], name: str) -> str:
    """Return the module that defines a name, or its package where the module is generated; "" if not ours."""
    while name and name not in names:
        name = name.rpartition(".")[0]
    return name


def count_names(modules: Iterable[Module]) -> dict[Row, int]:
    """Return how many names are public, and how many are of the kinds that shall become fewer."""
    modules = list(modules)
    identifiers = [
        word for module in modules for name in module.identifiers for word in set(split_name(name))
    ]
    functions = [name for module in modules for name in module.functions]
    return {
        **{Row("counts", f"public names of {m.name}"): m.exports for m in modules if m.exports},
        Row("counts", "functions named by a past participle"): sum(map(begins_with_participle, functions)),
        **{Row("counts", f"identifiers with '{word}'"): identifiers.count(word) for word in ("found", "one")},
    }


@cache
def split_name(name: str) -> tuple[str, ...]:
    """Return the words of an identifier, in lower case."""
    return tuple(word.lower() for word in re.findall(r"[A-Z]?[a-z]+|[A-Z]+(?![a-z])", name))


def begins_with_participle(name: str) -> bool:
    """Return whether a function is named by what was done, not by what it does or returns."""
    first = next(iter(split_name(name)), "")
    return first in IRREGULAR.split() or (first.endswith("ed") and first not in NO_PARTICIPLE.split())


def pair_records(modules: Iterable[Module]) -> dict[Row, int]:
    """Return the pairs of records that share most of their fields."""
    records = sorted(
        (f"{module.name.removeprefix('fdvv.')}.{each.name}", each.fields)
        for module in modules
        for each in module.classes
        if len(each.fields) >= FEWEST_FIELDS and "Protocol" not in each.bases
    )
    return {
        Row("records", name, other): 1
        for (name, fields), (other, others) in combinations(records, 2)
        if len(fields & others) >= max(FEWEST_FIELDS, SHARED_ratio * max(len(fields), len(others)))
    }


def find_lonely_protocols(modules: Iterable[Module]) -> dict[Row, int]:
    """Return the protocols that fewer than two classes implement: by name, or by having all it asks for."""
    classes = [each for module in modules for each in module.classes]
    by_name: defaultdict[str, list[Class]] = defaultdict(list)
    for each in classes:
        by_name[each.name].append(each)

    def members(each: Class, below: frozenset[str]) -> frozenset[str]:
        bases = [base for name in each.bases if name not in below for base in by_name[name]]
        return each.members.union(*(members(base, below | {base.name}) for base in bases))

    offers = [
        (each, members(each, frozenset({each.name}))) for each in classes if "Protocol" not in each.bases
    ]
    return {
        Row("protocols", module.name.removeprefix("fdvv."), protocol.name): 1
        for module in modules
        for protocol in module.classes
        if "Protocol" in protocol.bases
        if sum(protocol.members <= has or protocol.name in each.bases for each, has in offers) < 2
    }
