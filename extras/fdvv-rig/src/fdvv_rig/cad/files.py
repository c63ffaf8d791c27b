"""A part's files: STL and STEP, the same bytes every time."""

from __future__ import annotations

import io
import re

import numpy as np

from fdvv_rig.cad.shapes import Solid, kernel
from fdvv_rig.mesh import Mesh, joined

CHORD_mm = 0.02
"""How far a facet may be from the round face it stands for."""

CHORD_rad = 0.25
WRITTEN = "2020-01-01T00:00:00"
"""The time that every STEP file carries, so that equal parts give equal files."""


def mesh_of_solid(solid: Solid) -> Mesh:
    """Return a solid's surface as triangles."""
    points, triangles = solid.tessellate(CHORD_mm, CHORD_rad)
    places = np.array([(p.X, p.Y, p.Z) for p in points])
    return joined(places[np.array(triangles)])


def step_bytes(solid: Solid, name: str) -> bytes:
    """Write a solid as STEP, named, without the time, the kernel's counters and whose computer it was."""
    k = kernel()
    single = solid.solid()
    single.label = name
    stream = io.BytesIO()
    k.export_step(single, stream, write_pcurves=False, timestamp=WRITTEN)
    text = stream.getvalue().decode("ascii")
    head = f"FILE_NAME('{name}.step','{WRITTEN}',('fdvv'),('fdvv'),'fdvv','fdvv','');"
    text = re.sub(r"FILE_NAME\(.*?\);", head, text, count=1, flags=re.DOTALL)
    text = re.sub(r"(NEXT_ASSEMBLY_USAGE_OCCURRENCE\()'\d+'", r"\1'1'", text)
    return text.encode("ascii")
