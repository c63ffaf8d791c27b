"""What `import fdvv` offers, and how a broken promise is noticed."""

from __future__ import annotations

import ast
import importlib
import inspect
import subprocess
import sys
import textwrap
from pathlib import Path
from types import ModuleType

import griffe
import pytest
from tools.check_api import broken, unannounced

import fdvv
import fdvv_people
import fdvv_studio

SOURCE = ast.parse(Path(fdvv.__file__).read_text(encoding="utf-8"))


def test_every_public_name_is_there_and_has_a_docstring() -> None:
    for name in fdvv.__all__:
        value = getattr(fdvv, name)
        assert name == "__version__" or inspect.getdoc(value), name
    assert dir(fdvv) == sorted(fdvv.__all__)


def test_type_checkers_and_python_import_the_same_names() -> None:
    imports = {
        (node.module, alias.name)
        for statement in SOURCE.body
        if isinstance(statement, ast.If)
        for node in statement.body
        if isinstance(node, ast.ImportFrom)
        for alias in node.names
    }
    assert imports == {(module, name) for module, names in fdvv._MODULES.items() for name in names}
    assert {name for _, name in imports} == set(fdvv.__all__)


@pytest.mark.parametrize("face", [fdvv_people, fdvv_studio])
def test_a_face_above_the_core_has_what_it_names_documented_and_typed(face: ModuleType) -> None:
    assert face.__file__
    source = ast.parse(Path(face.__file__).read_text(encoding="utf-8"))
    typed = {a.name for node in ast.walk(source) if isinstance(node, ast.ImportFrom) for a in node.names}
    names = set(face.__all__) - {"__version__"}
    assert all(inspect.getdoc(getattr(face, name)) for name in names)
    assert names == typed - {"TYPE_CHECKING", "Any", "annotations"}
    assert dir(face) == sorted(face.__all__)
    with pytest.raises(AttributeError, match="has no attribute 'nonsense'"):
        _ = face.nonsense


def test_a_name_that_moved_says_where_it_is_and_is_there() -> None:
    for name, place in fdvv._MOVED.items():
        with pytest.raises(AttributeError, match=rf"{name} is {place}\.{name} \(pip install fdvv-"):
            getattr(fdvv, name)
        assert hasattr(importlib.import_module(place), name)


def test_an_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="has no attribute 'nonsense'"):
        _ = fdvv.nonsense


def test_importing_the_package_imports_no_other_module_of_it() -> None:
    code = "import sys, fdvv; print([m for m in sys.modules if m.startswith('fdvv.')])"
    out = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert out.stdout.strip() == "[]"


def package(folder: Path, body: str) -> griffe.Module:
    (folder / "fdvv").mkdir(parents=True)
    (folder / "fdvv" / "__init__.py").write_text(
        "from fdvv.a import f, g\nfrom fdvv.a import K\n__all__ = ['K', 'f', 'g']\n"
        if "def g" in body
        else "from fdvv.a import f, K\n__all__ = ['K', 'f']\n"
    )
    (folder / "fdvv" / "a.py").write_text(textwrap.dedent(body))
    loaded = griffe.load("fdvv", search_paths=[folder], resolve_aliases=True)
    assert isinstance(loaded, griffe.Module)
    return loaded


def test_a_changed_or_removed_promise_is_noticed_unless_the_changelog_names_it(tmp_path: Path) -> None:
    old = package(
        tmp_path / "old",
        """
        def f(x: int) -> int: ...
        def g() -> None: ...
        def h() -> None: ...
        class K:
            def method(self) -> None: ...
        """,
    )
    new = package(tmp_path / "new", "def f(y: int) -> int: ...\nclass K: ...\n")
    changes = list(broken(old, new))
    assert {name for name, _ in changes} == {"f", "g", "K"}
    log = "# Changes\n\n## [Unreleased]\n- `f` takes y; `g` is gone; `K` lost a method.\n\n## [0.1.0]\n"
    assert unannounced(iter(changes), log) == []
    silent = unannounced(iter(changes), log.replace("`K` lost a method", "more").replace("`g` is gone", ""))
    assert [line.partition(":")[0] for line in silent] == ["K", "g"]
