"""Blocks, rods and prisms in the rig's frame, of the CAD kernel, which is imported when the first is made."""

from __future__ import annotations

from collections.abc import Sequence
from functools import cache
from types import ModuleType
from typing import Any

from fdvv.errors import BuildError

Solid = Any
"""A solid of the kernel; solids add, subtract and intersect by +, - and &."""

Point = tuple[float, float, float]
TURNS = {"x": (0.0, 90.0, 0.0), "y": (-90.0, 0.0, 0.0), "z": (0.0, 0.0, 0.0)}


@cache
def kernel() -> ModuleType:
    """Return the CAD kernel. Raises BuildError where it is not installed."""
    try:
        import build123d
    except ImportError as error:
        raise BuildError('making parts needs a CAD kernel: pip install "fdvv-rig[cad]"') from error
    module: ModuleType = build123d
    return module


def block(low: Point, high: Point, radius_mm: float = 0.0) -> Solid:
    """Return a block between two corners; its upright edges are rounded by a radius that is not 0."""
    k = kernel()
    size = tuple(b - a for a, b in zip(low, high, strict=True))
    middle = tuple((a + b) / 2 for a, b in zip(low, high, strict=True))
    if not radius_mm:
        return k.Pos(*middle) * k.Box(*size)
    outline = k.RectangleRounded(size[0], size[1], radius_mm)
    return k.Pos(middle[0], middle[1], low[2]) * k.extrude(outline, size[2])


def rod(axis: str, begin: Point, length_mm: float, diameter_mm: float) -> Solid:
    """Return a cylinder from a point along x, y or z."""
    k = kernel()
    upright = k.Pos(0, 0, length_mm / 2) * k.Cylinder(diameter_mm / 2, length_mm)
    return k.Pos(*begin) * k.Rot(*TURNS[axis]) * upright


def cone(begin: Point, low_mm: float, high_mm: float, height_mm: float) -> Solid:
    """Return a cone from a point up, by its diameters at both ends."""
    k = kernel()
    return k.Pos(begin[0], begin[1], begin[2] + height_mm / 2) * k.Cone(low_mm / 2, high_mm / 2, height_mm)


def ball(centre: Point, diameter_mm: float) -> Solid:
    """Return a ball."""
    k = kernel()
    return k.Pos(*centre) * k.Sphere(diameter_mm / 2)


def prism(axis: str, points: Sequence[tuple[float, float]], low_mm: float, high_mm: float) -> Solid:
    """Return a prism along x (its points are y, z) or y (its points are x, z) between two places."""
    k = kernel()
    corners = [(low_mm, a, b) if axis == "x" else (a, low_mm, b) for a, b in points]
    face = k.make_face(k.Polyline(*corners, close=True))
    way = (1, 0, 0) if axis == "x" else (0, 1, 0)
    return k.extrude(face, amount=high_mm - low_mm, dir=way)


def hexagon(axis: str, begin: Point, length_mm: float, across_mm: float) -> Solid:
    """Return a hexagonal rod from a point along an axis, by its width across flats: room for a nut."""
    k = kernel()
    upright = k.extrude(k.RegularPolygon(across_mm / 3**0.5, 6), length_mm)
    return k.Pos(*begin) * k.Rot(*TURNS[axis]) * upright
