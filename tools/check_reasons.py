"""Look for numbers at the head of a module that nobody explains: ``python -m tools.check_reasons``.

A constant is explained by a comment in its lines or before it, or by a string below it or below the lines of
constants that it is one of. Prints file, line and code, and exits with 1.
"""

from __future__ import annotations

import ast
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
MADE = "protocol/tables.py"
"""Its reasons are in the file that it is made from."""


def unexplained(source: str) -> Iterator[tuple[int, str]]:
    """Yield line number and text of each number of a module that has no reason beside it."""
    body, lines = ast.parse(source).body, source.splitlines()
    for i, node in enumerate(body):
        if not isinstance(node, ast.Assign | ast.AnnAssign) or not _is_number(node.value):
            continue
        above = lines[node.lineno - 2].lstrip() if node.lineno > 1 else ""
        inside = any("#" in line for line in lines[node.lineno - 1 : node.end_lineno])
        if not (inside or above.startswith("#") or _is_described(body, i)):
            yield node.lineno, lines[node.lineno - 1]


def _is_number(node: ast.expr | None) -> bool:
    match node:
        case ast.Constant(value):
            return isinstance(value, int | float) and not isinstance(value, bool)
        case ast.UnaryOp(operand=inner):
            return _is_number(inner)
        case ast.BinOp(left=left, right=right):
            return _is_number(left) and _is_number(right)
        case ast.Tuple(parts) | ast.List(parts):
            return bool(parts) and all(map(_is_number, parts))
    return False


def _is_described(body: Sequence[ast.stmt], at: int) -> bool:
    """Whether a string follows an assignment, or the assignments right below it."""
    for node, after in zip(body[at:], body[at + 1 :], strict=False):
        if after.lineno != (node.end_lineno or 0) + 1:
            return False
        if not isinstance(after, ast.Assign | ast.AnnAssign):
            return isinstance(after, ast.Expr) and isinstance(after.value, ast.Constant)
    return False


def main() -> int:
    count = 0
    for path in sorted(ROOT.glob("packages/*/src/**/*.py")):
        if path.as_posix().endswith(MADE):
            continue
        for number, line in unexplained(path.read_text(encoding="utf-8")):
            print(f"{path.relative_to(ROOT)}:{number}: {line}: say beside it why it has this value")
            count += 1
    return 1 if count else 0


if __name__ == "__main__":
    sys.exit(main())
