"""Drawings as DXF files, in mm, one layer for each thing that is seen."""

from __future__ import annotations

import io

from fdvv.errors import BuildError
from fdvv.mechanism._section import Drawing

VERSION = "R2010"


def drawing_dxf(drawing: Drawing) -> str:
    """Write a drawing as DXF text. Raises BuildError if ezdxf is not installed."""
    try:
        from ezdxf import units
        from ezdxf.filemanagement import new
    except ImportError as error:
        raise BuildError(
            'drawings as DXF need ezdxf; install it with: pip install "fdvv[mechanism]"'
        ) from error
    document = new(VERSION, units=units.MM)
    for layer in sorted({outline.layer for outline in drawing.outlines}):
        document.layers.add(layer)
    space = document.modelspace()
    for outline in drawing.outlines:
        space.add_lwpolyline(
            outline.points_mm.tolist(), close=outline.closed, dxfattribs={"layer": outline.layer}
        )
    text = io.StringIO()
    document.write(text)
    return text.getvalue()
