"""Outlines of the parts of a mechanism, in mm: what a drawing or a DXF file shows."""

from __future__ import annotations

import io
import math
from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fdvv.errors import BuildError
from fdvv.units import FloatArray
from fdvv_switch.coil import END_COILS, Coil
from fdvv_switch.dome import Dome, DomeMechanism, Pin
from fdvv_switch.leaf import Leaf, LeafMechanism
from fdvv_switch.mechanism import Mechanism

POINT_mm = 0.02
"""Distance of the points of a cam."""

BACK_mm = 1.0
"""The cam's body goes on behind its surface by this."""

CLAMP_mm = 3.0
"""Length of a leaf that is held."""

SHEET_mm, PLUG_mm = 2.0, 1.0
"""Width of the sheet around a dome, and height of the solid top that the key presses on."""

ROUND = 24
"""Points of a circle."""


@dataclass(frozen=True, eq=False)
class Outline:
    """One line of a drawing.

    Attributes
    ----------
    layer : what it belongs to; a DXF file keeps it.
    points_mm : (n, 2).
    closed : whether it goes back to its first point.
    """

    layer: str
    points_mm: FloatArray
    closed: bool


@dataclass(frozen=True, eq=False)
class Drawing:
    """One part: its name as a file is called, what is seen, and its outlines."""

    name: str
    title: str
    outlines: tuple[Outline, ...]


def drawings_of(mechanism: Mechanism) -> tuple[Drawing, ...]:
    """Return the drawings of every part of a mechanism."""
    if isinstance(mechanism, DomeMechanism):
        dome = Drawing("dome", "dome, unloaded, section", tuple(_dome(mechanism)))
        if isinstance(mechanism.foot, Pin):
            return (dome,)
        foot = tuple(_strip("FOOT", mechanism.foot, False))
        return dome, Drawing("foot", "leaf under the dome, flat", foot)
    spring = Drawing("spring", "spring, built in, section", tuple(_coil(mechanism.coil)))
    if not isinstance(mechanism, LeafMechanism):
        return (spring,)
    leaf = tuple(_strip("LEAF", mechanism.leaf, True))
    cam = Drawing("cam", "cam of the slider", tuple(_cam(mechanism)))
    return spring, cam, Drawing("leaf", "leaf and fixed contact, flat", leaf)


def cam_points_mm(mechanism: LeafMechanism) -> FloatArray:
    """Return the places (mm) at which the cam is written down."""
    count = math.ceil((mechanism.cam.end_mm - mechanism.cam.start_mm) / POINT_mm) + 1
    return np.linspace(mechanism.cam.start_mm, mechanism.cam.end_mm, count)


def _cam(mechanism: LeafMechanism) -> Iterator[Outline]:
    x = cam_points_mm(mechanism)
    surface = mechanism.cam.surface_mm(x)
    back = float(surface[:, 1].min()) - BACK_mm
    body = np.vstack([surface, [surface[-1, 0], back], [surface[0, 0], back]])
    yield Outline("CAM", body, True)
    yield Outline("PATH", np.column_stack([x, mechanism.cam.at(x)]), False)
    nose = np.array([x[0], float(mechanism.cam.at(x[:1])[0])])
    yield Outline("NOSE", _circle(nose, mechanism.cam.nose_mm), True)


def _strip(layer: str, leaf: Leaf, contact: bool) -> Iterator[Outline]:
    yield _rectangle(layer, -CLAMP_mm, 0.0, leaf.length_mm, leaf.width_mm)
    yield Outline(f"{layer}_CLAMP", np.array([[0.0, 0.0], [0.0, leaf.width_mm]]), False)
    if contact:
        low = 2.0 * leaf.width_mm
        yield _rectangle("CONTACT", -CLAMP_mm, low, leaf.contact_length_mm, low + leaf.width_mm)
        yield Outline("CONTACT_CLAMP", np.array([[0.0, low], [0.0, low + leaf.width_mm]]), False)


def _rectangle(layer: str, left: float, low: float, right: float, high: float) -> Outline:
    return Outline(layer, np.array([[left, low], [right, low], [right, high], [left, high]]), True)


def _coil(coil: Coil) -> Iterator[Outline]:
    turns = coil.active + END_COILS
    radius, wire = 0.5 * coil.mean_mm, coil.wire_mm
    for side, phase in ((-1.0, 0.0), (1.0, 0.5)):
        for turn in np.arange(phase, turns + 1e-9, 1.0):
            centre = np.array([side * radius, _along(coil, float(turn), turns)])
            yield Outline("WIRE", _circle(centre, 0.5 * wire), True)
    yield Outline("AXIS", np.array([[0.0, 0.0], [0.0, coil.built_mm]]), False)


def _along(coil: Coil, turn: float, turns: float) -> float:
    wire, end = coil.wire_mm, 0.5 * END_COILS
    pitch = (coil.built_mm - wire - 2.0 * end * wire) / (turns - 2.0 * end)
    inner = min(max(turn - end, 0.0), turns - 2.0 * end)
    return 0.5 * wire + wire * min(turn, end) + pitch * inner + wire * max(turn - turns + end, 0.0)


def _circle(centre: FloatArray, radius: float) -> FloatArray:
    angle = np.linspace(0.0, 2.0 * math.pi, ROUND, endpoint=False)
    return np.asarray(centre + radius * np.column_stack([np.cos(angle), np.sin(angle)]))


def _dome(mechanism: DomeMechanism) -> Iterator[Outline]:
    right = _dome_half(mechanism.dome)
    yield Outline("DOME", np.vstack([right, (right * [-1.0, 1.0])[::-1]]), True)
    if mechanism.pad:
        half, low = 0.5 * mechanism.pad.diameter_mm, mechanism.dome.height_mm + PLUG_mm
        yield _rectangle("PAD", -half, low, half, low + mechanism.pad.length_mm)
    yield from _under(mechanism)


def _under(mechanism: DomeMechanism) -> Iterator[Outline]:
    dome, foot, tip = mechanism.dome, mechanism.foot, mechanism.tip_mm
    base, wide = -0.5 * dome.hinge_mm, 0.5 * dome.base_mm + SHEET_mm
    floor, inside = base - mechanism.rim_mm, 0.5 * dome.base_mm - 0.5 * dome.hinge_mm
    if isinstance(foot, Pin) and foot.diameter_mm > 0:
        yield _rectangle("FOOT", -0.5 * foot.diameter_mm, tip - foot.length_mm, 0.5 * foot.diameter_mm, tip)
    elif not isinstance(foot, Pin):
        yield _rectangle("FOOT", -inside, tip - foot.thickness_mm, 0.0, tip)
    ground = [[-wide, base], [-inside, base], [-inside, floor], [inside, floor], [inside, base], [wide, base]]
    yield Outline("BOARD", np.array(ground), False)


def _dome_half(dome: Dome) -> FloatArray:
    """Return the right half of the section from the axis outside over the top, and back inside.

    The wall's middle line runs from the base's radius at 0 to the top's at the dome's height; the hinges are
    its two ends, thinner over three times their thickness.
    """
    start = np.array([0.5 * dome.base_mm, 0.0])
    end = np.array([0.5 * dome.top_mm, dome.height_mm])
    along = (end - start) / float(np.hypot(*(end - start)))
    across = np.array([-along[1], along[0]]) * (-1.0 if along[0] < 0 else 1.0)
    across = across if across[1] > 0 else -across
    hinge, wall = 0.5 * dome.hinge_mm * across, 0.5 * dome.wall_mm * across
    long = min(3.0 * dome.hinge_mm, 0.3 * float(np.hypot(*(end - start))))
    low, high = start + long * along, end - long * along
    sheet = 0.5 * dome.hinge_mm
    wide = float(start[0]) + SHEET_mm
    over = [end + hinge, high + hinge, high + wall, low + wall, low + hinge, start + hinge]
    under = [start - hinge, low - hinge, low - wall, high - wall, high - hinge, end - hinge]
    plug = dome.height_mm + PLUG_mm
    outside = [np.array([0.0, plug]), np.array([float(end[0]), plug]), *over]
    flat = [np.array([wide, sheet]), np.array([wide, -sheet])]
    return np.array([*outside, *flat, *under, np.array([0.0, float((end - hinge)[1])])])


VERSION = "R2010"


def drawing_dxf(drawing: Drawing) -> str:
    """Write a drawing as DXF text. Raises BuildError if ezdxf is not installed."""
    try:
        from ezdxf import units
        from ezdxf.filemanagement import new
    except ImportError as error:
        raise BuildError("drawings as DXF need ezdxf: pip install ezdxf") from error
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
