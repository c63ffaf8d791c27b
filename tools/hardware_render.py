"""Draw meshes: a depth buffer, soft light, dark edges and labels, with NumPy and Pillow alone."""

from __future__ import annotations

import io
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
from PIL import Image, ImageDraw, ImageFont

from fdvv.io.files import write_atomic
from fdvv.units import FloatArray
from fdvv_rig.mesh import Mesh

Colour = tuple[float, float, float]
INK: Colour = (0.08, 0.13, 0.24)
FINE = 3
"""Samples per pixel along either way."""

CREASE_cos = np.cos(np.radians(28.0))
LIGHTS = (((-0.35, -0.75, 0.9), 0.62), ((0.8, -0.3, 0.35), 0.26))
AMBIENT = 0.40


@dataclass(frozen=True)
class Thing:
    """A mesh to draw: its colour, its label if it has one; a ghost is only its edges."""

    mesh: Mesh
    colour: Colour
    label: str = ""
    ghost: bool = False


@dataclass(frozen=True)
class Camera:
    """Where the eye is: degrees around from the front towards the right, degrees above the table."""

    around_deg: float = 32.0
    above_deg: float = 26.0

    @property
    def axes(self) -> FloatArray:
        """Get the picture's right, up and towards the eye as rows."""
        a, e = np.radians(self.around_deg), np.radians(self.above_deg)
        towards = np.array([np.sin(a) * np.cos(e), -np.cos(a) * np.cos(e), np.sin(e)])
        right = np.array([np.cos(a), np.sin(a), 0.0])
        return np.array([right, np.cross(towards, right), towards])


class Canvas:
    """Colour, depth and which thing is seen, at every sample."""

    def __init__(self, width: int, height: int) -> None:
        """Begin white and infinitely far."""
        self.colour = np.ones((height, width, 3))
        self.depth = np.full((height, width), -np.inf)
        self.thing = np.full((height, width), -1)

    def triangle(self, at: FloatArray, light: FloatArray, colour: FloatArray, thing: int) -> None:
        """Draw a triangle: at (3, 3) is x, y and depth of its corners, light (3,) at each."""
        height, width = self.depth.shape
        x0, y0 = np.maximum(np.floor(at[:, :2].min(axis=0)).astype(int), 0)
        x1, y1 = np.minimum(np.ceil(at[:, :2].max(axis=0)).astype(int) + 1, (width, height))
        (ax, ay, _), (bx, by, _), (cx, cy, _) = at
        area = (bx - ax) * (cy - ay) - (cx - ax) * (by - ay)
        if x1 <= x0 or y1 <= y0 or abs(area) < 1e-9:
            return
        x, y = np.arange(x0, x1) + 0.5, (np.arange(y0, y1) + 0.5)[:, None]
        b = ((x - ax) * (cy - ay) - (cx - ax) * (y - ay)) / area
        c = ((bx - ax) * (y - ay) - (x - ax) * (by - ay)) / area
        a = 1 - b - c
        depth = a * at[0, 2] + b * at[1, 2] + c * at[2, 2]
        part = np.s_[y0:y1, x0:x1]
        seen = (a >= -1e-6) & (b >= -1e-6) & (c >= -1e-6) & (depth > self.depth[part])
        shade = (a * light[0] + b * light[1] + c * light[2])[seen]
        self.depth[part][seen] = depth[seen]
        self.colour[part][seen] = np.clip(shade[:, None] * colour, 0, 1)
        self.thing[part][seen] = thing

    def line(
        self, begin: FloatArray, end: FloatArray, colour: Colour, bias: float, share: float = 1.0
    ) -> None:
        """Draw a line where it is not behind anything; share is how much of the ground it covers."""
        count = int(np.abs(end - begin)[:2].max() * 1.3) + 2
        points = begin + np.linspace(0, 1, count)[:, None] * (end - begin)
        x, y = np.floor(points[:, :2]).astype(int).T
        inside = (x >= 1) & (y >= 1) & (x < self.depth.shape[1] - 1) & (y < self.depth.shape[0] - 1)
        x, y, depth = x[inside], y[inside], points[inside, 2] + bias
        seen = depth >= self.depth[y, x]
        for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
            place = y[seen] + dy, x[seen] + dx
            self.colour[place] = (1 - share) * self.colour[place] + share * np.array(colour)


def _normals(mesh: Mesh) -> FloatArray:
    a, b, c = np.moveaxis(mesh.corners, 1, 0)
    across = np.cross(b - a, c - a)
    unit: FloatArray = across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-12)
    return unit


def _soft(mesh: Mesh, normals: FloatArray) -> FloatArray:
    """Return a normal for every corner, (m, 3, 3): the mean of the faces there that are nearly level."""
    around: dict[int, list[int]] = defaultdict(list)
    for i, triangle in enumerate(mesh.triangles):
        for point in triangle:
            around[int(point)].append(i)
    soft = np.empty((*mesh.triangles.shape, 3))
    for point, faces in around.items():
        there = normals[faces]
        near = there @ there.T > CREASE_cos
        mean = near @ there
        mean /= np.linalg.norm(mean, axis=1, keepdims=True)
        for face, normal in zip(faces, mean, strict=True):
            soft[face, list(mesh.triangles[face]).index(point)] = normal
    return soft


def _edges(mesh: Mesh, normals: FloatArray, towards: FloatArray) -> list[tuple[int, int]]:
    """Return the edges to draw: creases, and where a round face turns away from the eye."""
    faces: dict[tuple[int, int], list[int]] = defaultdict(list)
    for i, (a, b, c) in enumerate(mesh.triangles):
        for one, other in ((a, b), (b, c), (c, a)):
            faces[min(one, other), max(one, other)].append(i)
    found = []
    for edge, sides in faces.items():
        one, other = normals[sides[0]], normals[sides[-1]]
        turns = (one @ towards) * (other @ towards) < 0
        if len(sides) != 2 or one @ other < CREASE_cos or turns:
            found.append(edge)
    return found


def draw(things: list[Thing], camera: Camera, size: tuple[int, int], margin: int = 24) -> Image.Image:
    """Draw things as large as they fit; labels stand in columns at both sides."""
    axes, labelled = camera.axes, any(thing.label for thing in things)
    seen = [thing.mesh.points @ axes.T for thing in things]
    low, high = np.vstack(seen).min(axis=0), np.vstack(seen).max(axis=0)
    side = 40 + max(int(font(15).getlength(thing.label)) for thing in things) if labelled else margin
    room = np.array([size[0] - 2 * side, size[1] - 2 * margin])
    scale = float((room / (high - low)[:2]).min()) * FINE
    middle = (low + high)[:2] / 2
    canvas = Canvas(size[0] * FINE, size[1] * FINE)
    half = np.array(size) * FINE / 2
    places = []
    for points in seen:
        at = np.column_stack([(points[:, :2] - middle) * scale * [1, -1] + half, points[:, 2]])
        places.append(at)
    for i, (thing, at) in enumerate(zip(things, places, strict=True)):
        if not thing.ghost:
            _fill(canvas, thing, at, axes, i)
    for thing, at in zip(things, places, strict=True):
        _outline(canvas, thing, at, axes, 0.9 / scale * FINE)
    image = _picture(canvas, size)
    return _labels(image, canvas, things) if labelled else image


def _fill(canvas: Canvas, thing: Thing, at: FloatArray, axes: FloatArray, index: int) -> None:
    normals = _normals(thing.mesh)
    soft = _soft(thing.mesh, normals) @ axes.T
    light = np.full(soft.shape[:2], AMBIENT)
    for way, strength in LIGHTS:
        unit = np.array([way[0], way[2], -way[1]]) / np.linalg.norm(way)
        light += strength * np.clip(soft @ unit, 0, None)
    light += 0.10 * np.clip(soft[..., 2], 0, None)
    colour = np.array(thing.colour)
    for i in np.flatnonzero(normals @ axes[2] > -1e-9):
        canvas.triangle(at[thing.mesh.triangles[i]], light[i], colour, index)


def _outline(canvas: Canvas, thing: Thing, at: FloatArray, axes: FloatArray, bias: float) -> None:
    share = 0.45 if thing.ghost else 0.8
    for one, other in _edges(thing.mesh, _normals(thing.mesh), axes[2]):
        canvas.line(at[one], at[other], INK, 1e9 if thing.ghost else bias, share)


def _picture(canvas: Canvas, size: tuple[int, int]) -> Image.Image:
    small = canvas.colour.reshape(size[1], FINE, size[0], FINE, 3).mean(axis=(1, 3))
    return Image.fromarray(np.rint(small * 255).astype(np.uint8))


def font(size: int) -> Any:
    """Return the font of labels."""
    import matplotlib

    return ImageFont.truetype(str(Path(matplotlib.get_data_path()) / "fonts/ttf/DejaVuSans.ttf"), size)


def _labels(image: Image.Image, canvas: Canvas, things: list[Thing]) -> Image.Image:
    """Write labels in two columns, each with a line to where its thing is seen."""
    ends = []
    for i, thing in enumerate(things):
        if thing.label and (place := _seen_at(canvas.thing == i)) is not None:
            ends.append((place, thing.label))
    middle, pen, face = image.width / 2, ImageDraw.Draw(image), font(15)
    ends.sort(key=lambda end: end[0][0])
    left = ends[: sum(place[0] < middle for place, _ in ends)]
    for column, at_left in ((left, True), (ends[len(left) :], False)):
        column.sort(key=lambda end: end[0][1])
        for y, ((px, py), label) in zip(
            _spread([p[1] for p, _ in column], image.height), column, strict=True
        ):
            x = 16 if at_left else image.width - 16
            width = pen.textlength(label, font=face)
            text_x = x if at_left else x - width
            elbow = text_x + width + 6 if at_left else text_x - 6
            pen.line([(elbow, y), (px, py)], fill=(90, 100, 114), width=1)
            pen.ellipse([px - 2.5, py - 2.5, px + 2.5, py + 2.5], fill=(90, 100, 114))
            pen.text((text_x, y - 9), label, fill=(20, 33, 61), font=face)
    return image


def _seen_at(mask: npt.NDArray[np.bool_]) -> tuple[float, float] | None:
    """Return the pixel of a thing that is nearest to the middle of what is seen of it."""
    y, x = np.nonzero(mask)
    if not x.size:
        return None
    nearest = np.argmin((x - x.mean()) ** 2 + (y - y.mean()) ** 2)
    return float(x[nearest]) / FINE, float(y[nearest]) / FINE


def _spread(wanted: list[float], height: int, apart: float = 24.0) -> list[float]:
    """Move labels apart, in their order, within the picture."""
    at = list(wanted)
    for i in range(1, len(at)):
        at[i] = max(at[i], at[i - 1] + apart)
    end = height - 20.0
    for i in reversed(range(len(at))):
        at[i] = min(at[i], end)
        end = at[i] - apart
    return at


def save(image: Image.Image, path: Path, colours: int = 256) -> None:
    """Write a picture as a small PNG."""
    buffer = io.BytesIO()
    image.quantize(colours, dither=Image.Dither.NONE).save(buffer, "PNG", optimize=True)
    write_atomic(path, buffer.getvalue())
