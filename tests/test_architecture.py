"""Rooms import only what stands below them; a new room must be placed here and in ARCHITECTURE.md."""

from __future__ import annotations

import ast
import sys
from pathlib import Path

import pytest

PACKAGE = Path(__file__).resolve().parents[1] / "src" / "fdvv"

GROUND = {
    *("errors", "units", "files", "documents", "columns", "journal", "text"),
    *("_native", "protocol", "core"),
}
LEVELS = [
    GROUND,
    {"model"},
    {"recording"},
    {
        *("capture", "compensate", "exchange", "hardware", "mechanism", "optimize", "preprocess", "program"),
        *("study", "twin", "vibration"),
    },
    {"device", "plot"},
    {"workflow"},
    {"studio"},
    {"cli"},
]
# inside the ground and between rooms of one level, only these arrows
SAME_LEVEL = {
    *((room, "errors") for room in ("_native", "core", "documents", "files", "journal", "protocol", "text")),
    ("journal", "files"),
    ("core", "_native"),
    ("core", "protocol"),
}
# shipped helpers for tests: they may use any room, and no room may use them
TESTING = "testing"


def room_of(path: Path) -> str:
    parts = path.relative_to(PACKAGE).parts
    return parts[0].removesuffix(".py")


def imports(path: Path) -> set[str]:
    """Give the rooms that a file imports, wherever in the file."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.level == 0 and node.module:
            names = (
                [f"{node.module}.{a.name}" for a in node.names] if node.module == "fdvv" else [node.module]
            )
        elif isinstance(node, ast.Import):
            names = [a.name for a in node.names]
        else:
            assert not (isinstance(node, ast.ImportFrom) and node.level), f"{path}: relative import"
            continue
        found |= {name.split(".")[1] for name in names if name.startswith("fdvv.")}
    return found - {"__version__"}


def level(room: str) -> int:
    return next(i for i, rooms in enumerate(LEVELS) if room in rooms)


def allowed(importer: str, imported: str) -> bool:
    if importer == imported:
        return True
    if importer == TESTING:
        return imported != "cli"
    if imported == TESTING:
        return False
    return level(imported) < level(importer) or (importer, imported) in SAME_LEVEL


DOORS = {PACKAGE / "__init__.py", PACKAGE / "__main__.py"}
FILES = sorted(set(PACKAGE.rglob("*.py")) - DOORS)


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_a_file_imports_only_rooms_below_its_own(path: Path) -> None:
    room = room_of(path)
    wrong = [other for other in imports(path) if not allowed(room, other)]
    assert not wrong, f"{room} may not import {wrong}"


@pytest.mark.parametrize("path", FILES, ids=lambda p: str(p.relative_to(PACKAGE)))
def test_private_modules_of_a_room_are_closed_to_the_others(path: Path) -> None:
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.ImportFrom) and node.module and node.module.startswith("fdvv."):
            parts = node.module.split(".")
            if parts[1] != room_of(path):
                assert not any(p.startswith("_") for p in parts[2:]), f"{path.name} opens {node.module}"


def test_every_room_is_placed_in_a_level_and_in_the_document() -> None:
    rooms = {room_of(path) for path in FILES}
    assert rooms == set().union(*LEVELS) | {TESTING}
    document = (PACKAGE.parents[1] / "ARCHITECTURE.md").read_text()
    assert [r for r in rooms if f"`fdvv.{r}`" not in document and f"`{r}`" not in document] == []


def test_the_checker_sees_a_forbidden_arrow(tmp_path: Path) -> None:
    bad = tmp_path / "bad.py"
    bad.write_text("def f():\n    from fdvv.workflow import demo\n    return demo\n")
    assert imports(bad) == {"workflow"}
    assert not allowed("model", "workflow")
    assert not allowed("capture", "twin")
    assert not allowed("device", "testing")


def test_importing_the_command_line_imports_neither_numpy_nor_scipy() -> None:
    import subprocess

    heavy = ("numpy", "scipy", "matplotlib", "rich")
    code = f"import sys, fdvv.cli; print([m for m in {heavy} if m in sys.modules])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"
