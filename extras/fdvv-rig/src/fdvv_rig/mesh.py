"""Triangle meshes and binary STL: written the same way every time, read with care, measured."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

import numpy as np
import numpy.typing as npt

from fdvv.errors import InputError
from fdvv.io.files import read_limited
from fdvv.units import FloatArray
from fdvv_rig.placement import Pose

IntArray = npt.NDArray[np.int64]
LARGEST_BYTES = 100_000_000
HEAD = b"fdvv part, binary STL, mm".ljust(80)
RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
ROUND_mm = 1e-4
"""Places are rounded to this, so that corners which faces share are the same number."""


@dataclass(frozen=True, eq=False)
class Mesh:
    """A surface of triangles, in mm.

    points : (n, 3); triangles : (m, 3), indices of points, counter-clockwise seen from outside.
    """

    points: FloatArray
    triangles: IntArray

    @cached_property
    def corners(self) -> FloatArray:
        """Get the corners of each triangle, (m, 3, 3)."""
        found: FloatArray = self.points[self.triangles]
        return found

    @property
    def volume_cm3(self) -> float:
        """Get the volume inside, by the divergence theorem; negative where the faces look inwards."""
        a, b, c = np.moveaxis(self.corners - self.points.mean(axis=0), 1, 0)
        return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6e3

    @property
    def area_cm2(self) -> float:
        """Get the area of the surface."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return float(np.linalg.norm(np.cross(b - a, c - a), axis=1).sum()) / 200

    @property
    def box_mm(self) -> FloatArray:
        """Get lowest and highest corner, (2, 3)."""
        return np.array([self.points.min(axis=0), self.points.max(axis=0)])

    def open_edges(self) -> int:
        """Count the edges that are not shared by exactly two triangles running along it in opposite ways."""
        edges = self.triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
        _, twice = np.unique(edges, axis=0, return_counts=True)
        one_way = {(int(a), int(b)) for a, b in edges}
        return sum((b, a) not in one_way for a, b in one_way) + int((twice > 1).sum())

    def flat_triangles(self) -> int:
        """Count the triangles without area."""
        a, b, c = np.moveaxis(self.corners, 1, 0)
        return int((np.linalg.norm(np.cross(b - a, c - a), axis=1) < ROUND_mm**2).sum())

    def moved(self, pose: Pose) -> Mesh:
        """Return the mesh at a pose."""
        return Mesh(pose.of(self.points), self.triangles)


def joined(corners_mm: FloatArray) -> Mesh:
    """Make a mesh from loose triangles: corners at the same place become one point; slivers go.

    corners_mm : of each triangle (m, 3, 3).
    """
    rounded = np.rint(corners_mm.reshape(-1, 3) / ROUND_mm).astype(np.int64)
    places, index = np.unique(rounded, axis=0, return_inverse=True)
    triangles = index.reshape(-1, 3)
    a, b, c = triangles.T
    points: FloatArray = np.asarray(places * ROUND_mm, dtype=np.float64)
    return Mesh(points, triangles[(a != b) & (b != c) & (c != a)])


def stl_bytes(mesh: Mesh) -> bytes:
    """Write a mesh as binary STL, its triangles sorted, so that equal parts give equal bytes."""
    lowest = np.argmin(mesh.triangles, axis=1)
    turned = np.take_along_axis(mesh.triangles, (lowest[:, None] + np.arange(3)) % 3, axis=1)
    order = np.lexsort(turned.T[::-1])
    corners = mesh.points[turned[order]].astype(np.float32)
    facets = np.zeros(len(corners), RECORD)
    facets["corners"] = corners
    facets["normal"] = _normals(corners.astype(np.float64))
    return HEAD + np.array(len(corners), "<u4").tobytes() + facets.tobytes()


def _normals(corners: FloatArray) -> FloatArray:
    a, b, c = np.moveaxis(corners, 1, 0)
    across = np.cross(b - a, c - a)
    length = np.linalg.norm(across, axis=1, keepdims=True)
    unit: FloatArray = np.divide(across, length, out=np.zeros_like(across), where=length > 0)
    return unit


def read_stl(path: Path | str) -> Mesh:
    """Read a binary STL file. Raises InputError for a text STL, a torn file, numbers that are not finite."""
    data = read_limited(Path(path), LARGEST_BYTES, "pass an exported part")
    count = int(np.frombuffer(data[80:84], "<u4")[0]) if len(data) >= 84 else 0
    if not count or len(data) != 84 + count * RECORD.itemsize:
        reason = "is no whole binary STL file"
        raise InputError(path, "whole file", reason, "export it again with fdvv hardware export")
    corners = np.frombuffer(data, RECORD, count, 84)["corners"].astype(np.float64)
    if not np.isfinite(corners).all():
        raise InputError(path, "whole file", "has a corner that is not finite", "export it again")
    return joined(corners)
