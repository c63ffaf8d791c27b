"""Solids of exported parts and bought ones: do they collide, and how close do they come?"""

from __future__ import annotations

from types import ModuleType
from typing import Any

import numpy as np

from fdvv.errors import BuildError
from fdvv_rig.envelope import Block, Envelope, Rod
from fdvv_rig.mesh import Mesh
from fdvv_rig.placement import Pose

Body = Any
"""A solid of manifold3d."""

SIDES = 96
"""Of the prisms that stand for cylinders."""

FAR_mm = 3.0


def _library() -> ModuleType:
    try:
        import manifold3d
    except ImportError as error:
        raise BuildError("checking how parts fit needs manifold3d: pip install manifold3d") from error
    module: ModuleType = manifold3d
    return module


def body_of(mesh: Mesh) -> Body:
    """Return a mesh as a solid. Raises BuildError without manifold3d; ValueError where it is not closed."""
    library = _library()
    found = library.Manifold(library.Mesh(mesh.points.astype(np.float32), mesh.triangles.astype(np.uint32)))
    if found.status() != library.Error.NoError or found.volume() <= 0:
        raise ValueError(f"not a closed solid ({found.status().name})")
    return found


def body_of_bought(envelope: Envelope) -> Body:
    """Return the room a bought part takes as a solid."""
    library = _library()
    made = library.Manifold()
    for solid in envelope.solids:
        made += _primitive(library, solid)
    for hollow in envelope.hollows:
        made -= _primitive(library, hollow)
    return made


def _primitive(library: ModuleType, shape: Rod | Block) -> Body:
    if isinstance(shape, Block):
        size = np.subtract(shape.high_mm, shape.low_mm)
        return library.Manifold.cube(tuple(size)).translate(shape.low_mm)
    made = _cylinder(library, shape.length_mm, shape.diameter_mm)
    if shape.bore_mm:
        longer = _cylinder(library, shape.length_mm + 2, shape.bore_mm).translate((0, 0, -1))
        made -= longer
    turned = {"x": (0, 90, 0), "y": (-90, 0, 0), "z": (0, 0, 0)}[shape.axis]
    return made.rotate(turned).translate(shape.begin_mm)


def _cylinder(library: ModuleType, length_mm: float, diameter_mm: float) -> Body:
    return library.Manifold.cylinder(length_mm, diameter_mm / 2, diameter_mm / 2, SIDES)


def placed(body: Body, pose: Pose) -> Body:
    """Return a solid at a pose."""
    return body.transform(pose.rows)


def mesh_of(body: Body) -> Mesh:
    """Return a solid's surface."""
    mesh = body.to_mesh64() if hasattr(body, "to_mesh64") else body.to_mesh()
    points = np.asarray(mesh.vert_properties, dtype=np.float64)[:, :3]
    return Mesh(points, np.asarray(mesh.tri_verts, dtype=np.int64))


def shared_mm3(one: Body, other: Body) -> float:
    """Return the volume that two solids share, in mm³."""
    return float((one ^ other).volume())


def gap_mm(one: Body, other: Body, far_mm: float = FAR_mm) -> float:
    """Return how close two solids come, in mm; far_mm where they are further apart."""
    a, b = np.array(one.bounding_box()), np.array(other.bounding_box())
    apart = np.maximum(a[:3] - b[3:], b[:3] - a[3:]).max()
    return far_mm if apart >= far_mm else float(one.min_gap(other, far_mm))
