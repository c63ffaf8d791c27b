"""What a solid looks like from one side: lines that show, lines that hide, round edges seen face on."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import dataclass

from fdvv_rig.cad.shapes import Solid, kernel

Line = tuple[tuple[float, float], ...]
Box = tuple[float, float, float, float]
FAR_mm = 1000.0
ROUND = 2
"""Decimals of a millimetre in drawings."""

WHOLE_ratio = 0.6
"""Share of a full turn from which an arc is drawn as a circle."""


@dataclass(frozen=True)
class Circle:
    """Round edges of one diameter that a view shows face on: where the first is, and how many there are."""

    diameter_mm: float
    centres_mm: tuple[tuple[float, float], ...]


@dataclass(frozen=True)
class View:
    """A solid seen along a line: x to the right, y up, in mm; its box is left, bottom, right and top."""

    title: str
    shown: tuple[Line, ...]
    hidden: tuple[Line, ...]
    circles: tuple[Circle, ...]
    box_mm: Box


# title: from where, what is up, what is to the right (None: not square to the axes)
SIDES: dict[str, tuple[tuple[float, float, float], tuple[float, float, float], int | None]] = {
    "front": ((0.0, -1.0, 0.0), (0.0, 0.0, 1.0), 1),
    "from the right": ((1.0, 0.0, 0.0), (0.0, 0.0, 1.0), 0),
    "from above": ((0.0, 0.0, 1.0), (0.0, 1.0, 0.0), 2),
    "from the front, right and above": ((0.62, -1.0, 0.72), (0.0, 0.0, 1.0), None),
}


def views(solid: Solid) -> tuple[View, ...]:
    """Return front, right side, top and an oblique view of a solid."""
    return tuple(_view(solid, title) for title in SIDES)


def _view(solid: Solid, title: str) -> View:
    towards, up, axis = SIDES[title]
    eye = tuple(FAR_mm * part for part in towards)
    shown, hidden = solid.project_to_viewport(eye, up, (0, 0, 0))
    front = _lines(shown)
    behind = () if axis is None else tuple(line for line in _lines(hidden) if line not in front)
    circles = () if axis is None else _circles(solid, title)
    return View(title, front, behind, circles, _box(front) if axis is None else _true_box(solid, title))


def _box(lines: tuple[Line, ...]) -> Box:
    xs, ys = zip(*(point for line in lines for point in line), strict=True)
    return min(xs), min(ys), max(xs), max(ys)


def _true_box(solid: Solid, title: str) -> Box:
    box = solid.bounding_box()
    left, low = _seen((box.min.X, box.min.Y, box.min.Z), title)
    right, top = _seen((box.max.X, box.max.Y, box.max.Z), title)
    return left, low, right, top


def _lines(edges: list[Solid]) -> tuple[Line, ...]:
    k = kernel()
    found = set()
    for edge in edges:
        straight = edge.geom_type == k.GeomType.LINE
        count = 1 if straight else max(6, min(48, int(edge.length / 0.8)))
        line = tuple(_rounded(edge @ (i / count)) for i in range(count + 1))
        line = tuple(p for i, p in enumerate(line) if not i or p != line[i - 1])
        if len(line) > 1:
            found.add(min(line, line[::-1]))
    return tuple(sorted(found))


def _rounded(point: Solid) -> tuple[float, float]:
    return round(point.X, ROUND) + 0.0, round(point.Y, ROUND) + 0.0


def _circles(solid: Solid, title: str) -> tuple[Circle, ...]:
    k = kernel()
    axis = SIDES[title][2]
    turns: dict[tuple[float, tuple[float, float]], float] = defaultdict(float)
    for edge in solid.edges().filter_by(k.GeomType.CIRCLE):
        normal, centre = edge.normal(), edge.arc_center
        if axis is not None and abs(abs((normal.X, normal.Y, normal.Z)[axis]) - 1) < 1e-6:
            share = edge.length / (2 * math.pi * edge.radius)
            place = _seen((centre.X, centre.Y, centre.Z), title)
            key = (round(2 * edge.radius, ROUND), place)
            turns[key] = max(turns[key], share)
    found: dict[float, set[tuple[float, float]]] = defaultdict(set)
    for (diameter, place), share in turns.items():
        if share >= WHOLE_ratio:
            found[diameter].add(place)
    return tuple(Circle(size, tuple(sorted(found[size]))) for size in sorted(found, reverse=True))


def _seen(point: tuple[float, float, float], title: str) -> tuple[float, float]:
    x, y, z = (round(value, ROUND) + 0.0 for value in point)
    return {"front": (x, z), "from the right": (y, z), "from above": (x, y)}[title]
