"""Drawings: they have the sizes of the design, and a DXF file read back holds them."""

from __future__ import annotations

import io

import numpy as np
import pytest

from fdvv.units import FloatArray
from fdvv_switch.dome import DomeMechanism
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.mechanism import Mechanism
from fdvv_switch.section import cam_points_mm, drawing_dxf, drawings_of
from fdvv_switch.spring import SpringMechanism


def area(points: FloatArray) -> float:
    """Return the area of a polygon, positive where it turns left."""
    x, y = points.T
    return float(0.5 * np.sum(x * np.roll(y, -1) - np.roll(x, -1) * y))


def test_a_spring_is_drawn_with_all_its_turns_at_its_built_length(spring: SpringMechanism) -> None:
    (drawing,) = drawings_of(spring)
    wires = [o.points_mm for o in drawing.outlines if o.layer == "WIRE"]
    every = np.vstack(wires)
    coil = spring.coil
    assert np.ptp(every[:, 1]) == pytest.approx(coil.built_mm, abs=0.3)
    assert np.ptp(every[:, 0]) == pytest.approx(coil.mean_mm + coil.wire_mm, abs=1e-3)
    assert len(wires) == 2 * int(coil.active + 2) + 1


def test_a_cams_outline_is_its_surface_and_a_body_behind_it(clear_leaf: Mechanism) -> None:
    assert isinstance(clear_leaf, LeafMechanism)
    cam = next(d for d in drawings_of(clear_leaf) if d.name == "cam")
    body = next(o for o in cam.outlines if o.layer == "CAM")
    x = cam_points_mm(clear_leaf)
    np.testing.assert_array_equal(body.points_mm[: x.size], clear_leaf.cam.surface_mm(x))
    assert body.closed
    assert abs(area(body.points_mm)) > 1.0


def test_a_dome_is_drawn_with_its_wall_between_base_and_top(rubber_dome: DomeMechanism) -> None:
    drawing = drawings_of(rubber_dome)[0]
    outline = next(o.points_mm for o in drawing.outlines if o.layer == "DOME")
    dome = rubber_dome.dome
    np.testing.assert_allclose(outline.mean(axis=0)[0], 0.0, atol=1e-9)
    assert np.ptp(outline[:, 0]) == pytest.approx(dome.base_mm + 4.0)
    assert outline[:, 1].max() == pytest.approx(dome.height_mm + 1.0)


def test_a_dxf_file_read_back_holds_every_line_in_mm(clear_leaf: Mechanism) -> None:
    ezdxf = pytest.importorskip("ezdxf")
    for drawing in drawings_of(clear_leaf):
        document = ezdxf.read(io.StringIO(drawing_dxf(drawing)))
        assert document.units == 4
        lines = list(document.modelspace().query("LWPOLYLINE"))
        assert not document.audit().has_errors
        for line, outline in zip(lines, drawing.outlines, strict=True):
            assert line.dxf.layer == outline.layer
            assert line.closed == outline.closed
            np.testing.assert_allclose(np.array(line.get_points("xy")), outline.points_mm, atol=1e-9)
