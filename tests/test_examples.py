"""The notebooks of docs/examples run from top to bottom, and are kept without what they showed."""

from __future__ import annotations

import ast
import json
from pathlib import Path
from typing import Any

import pytest

from fdvv.report.notebook import DRAWN_BY

NOTEBOOKS = sorted((Path(__file__).resolve().parents[1] / "docs" / "examples").glob("*.ipynb"))


def cells(notebook: Path) -> list[dict[str, Any]]:
    found = json.loads(notebook.read_text())
    assert (found["nbformat"], found["nbformat_minor"]) >= (4, 5)
    return list(found["cells"])


def run_cell(source: str, names: dict[str, Any]) -> object:
    """Run a cell as a notebook does and return the value of its last line, if it is one."""
    tree = ast.parse(source)
    last = tree.body[-1] if tree.body else None
    if not isinstance(last, ast.Expr):
        exec(compile(tree, "cell", "exec"), names)
        return None
    del tree.body[-1]
    exec(compile(tree, "cell", "exec"), names)
    return eval(compile(ast.Expression(last.value), "cell", "eval"), names)


@pytest.mark.slow
@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda n: n.stem)
def test_a_notebook_runs_and_every_value_can_be_shown(
    notebook: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    for library in ("pandas", "xarray"):
        pytest.importorskip(library)
    monkeypatch.chdir(tmp_path)
    names: dict[str, Any] = {"__name__": "__main__"}
    shown = []
    for cell in cells(notebook):
        if cell["cell_type"] == "code":
            value = run_cell("".join(cell["source"]), names)
            html = DRAWN_BY.get(type(value), getattr(type(value), "_repr_html_", None))
            shown.append(html(value) if html else repr(value))
    assert all(shown)
    assert sum("<svg" in one for one in shown) >= 2


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda n: n.stem)
def test_a_notebook_is_kept_without_outputs(notebook: Path) -> None:
    found = cells(notebook)
    assert all(not c["outputs"] and c["execution_count"] is None for c in found if c["cell_type"] == "code")
    assert len({c["id"] for c in found}) == len(found)


def test_there_is_a_notebook() -> None:
    assert NOTEBOOKS
