"""Curves as few straight pieces: what fits into programs that know springs but no tables."""

from __future__ import annotations

import numpy as np

from fdvv.units import FloatArray


def polyline(x: FloatArray, y: FloatArray, tolerance: float) -> np.ndarray[tuple[int], np.dtype[np.intp]]:
    """Choose samples whose straight joints stay within tolerance of all samples (Ramer, Douglas and Peucker).

    x : (n,) strictly rising; y : (n,). Gives the chosen indices, rising, both ends among them. Deviation is
        measured along y, which is what a force's error is.
    """
    chosen = {0, x.size - 1}
    spans = [(0, x.size - 1)]
    while spans:
        first, last = spans.pop()
        inside = slice(first + 1, last)
        line = y[first] + (y[last] - y[first]) * (x[inside] - x[first]) / (x[last] - x[first])
        off = np.abs(y[inside] - line)
        if off.size and off.max() > tolerance:
            worst = first + 1 + int(np.argmax(off))
            chosen.add(worst)
            spans += [(first, worst), (worst, last)]
    return np.array(sorted(chosen), dtype=np.intp)
