"""What differs between two texts: every character, or on another kind of machine more than last digits."""

from __future__ import annotations

import difflib
import math
import re

RELATIVE = 1e-9
ABSOLUTE = 1e-10
NUMBER = re.compile(r"(?<![\w.#])-?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w#])")
DIGEST = re.compile(r"#[0-9a-f]{12}\b")


def difference(before: str, after: str, exact: bool = True) -> str:
    """Return what differs as a unified diff; an empty text where nothing does.

    exact : every character counts. Else digests do not, and numbers may differ by 1e-9 of themselves: a
    processor, or a library of mathematics, that rounds otherwise.
    """
    old, new = before.splitlines(), after.splitlines()
    if not exact and len(old) == len(new):
        new = [a if alike(a, b) else b for a, b in zip(old, new, strict=True)]
    return "\n".join(difflib.unified_diff(old, new, "before", "after", n=3, lineterm=""))


def alike(line: str, other: str) -> bool:
    """Return whether two lines differ in digests and last digits alone."""
    if line == other:
        return True
    line, other = DIGEST.sub("#", line), DIGEST.sub("#", other)
    numbers = [list(map(float, NUMBER.findall(text))) for text in (line, other)]
    return NUMBER.sub("0", line) == NUMBER.sub("0", other) and all(
        math.isclose(a, b, rel_tol=RELATIVE, abs_tol=ABSOLUTE) for a, b in zip(*numbers, strict=True)
    )
