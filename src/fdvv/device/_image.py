"""The smallest program: one state that follows a surface."""

from __future__ import annotations

import struct
import zlib

import numpy as np
import numpy.typing as npt

from fdvv.errors import DeviceError
from fdvv.model import ForceSurface
from fdvv.protocol import (
    IMAGE_BYTES,
    IMAGE_MAGIC,
    IMAGE_VERSION,
    NONE,
    SURFACE_DISPLACEMENTS,
    SURFACE_VELOCITIES,
    ImageHeader,
    State,
    Surface,
    VelocitySource,
)

COVERED = 8
"""The checksum covers what follows magic and checksum."""


def surface_image(surface: ForceSurface, travel_mm: float, name: str = "surface") -> bytes:
    """Make a program of one state that follows the surface, its row chosen by the decided velocity.

    DeviceError if the surface has more cells than a program holds.
    """
    rows, columns = surface.press_cN.shape
    size = 32 + 20 + 2 * 12 + 2 * rows + 2 * (2 * rows * columns)
    size += -size % 4
    if columns > SURFACE_DISPLACEMENTS or rows > SURFACE_VELOCITIES or size > IMAGE_BYTES:
        raise DeviceError(
            f"a table of {rows} x {columns} needs {size} bytes, a program holds {IMAGE_BYTES}, "
            f"{SURFACE_VELOCITIES} rows and {SURFACE_DISPLACEMENTS} columns; sample it more coarsely"
        )
    velocities_at = 32 + 20 + 2 * 12
    forces_at = velocities_at + 2 * rows
    tables = (surface.press_cN, surface.release_cN)
    surfaces = (_place(surface, velocities_at, forces_at + i * 2 * rows * columns) for i in range(2))
    body = b"".join(
        (
            _state().pack(),
            *(part.pack() for part in surfaces),
            _integers(16 * surface.velocity_mm_s, "<u2"),
            *(_integers(64 * table, "<i2") for table in tables),
        )
    )
    return seal(_header(travel_mm, name, size), body.ljust(size - 32, b"\0"))


def _integers(values: npt.NDArray[np.float64], kind: str) -> bytes:
    return np.rint(values).astype(kind).tobytes()


def _state() -> State:
    return State(
        press_surface=0,
        release_surface=1,
        velocity_source=VelocitySource.DECIDED,
        key=0,
        first_transition=0,
        transitions=0,
        enter_slot=NONE,
        repeat_slot=NONE,
        repeat_ms=0,
        fade_ms=0,
        bias_cN64=0,
        bias_end_cN64=0,
        bias_ms=0,
    )


def _place(surface: ForceSurface, velocities_at: int, forces_at: int) -> Surface:
    rows, columns = surface.press_cN.shape
    x = surface.displacement_mm
    return Surface(
        start_um16=round(16000 * float(x[0])),
        step_um16=round(16000 * float(x[1] - x[0])),
        columns=columns,
        rows=rows,
        velocities_at=velocities_at,
        forces_at=forces_at,
    )


def _header(travel_mm: float, name: str, size: int) -> ImageHeader:
    return ImageHeader(
        magic=IMAGE_MAGIC,
        crc32=0,
        travel_um16=round(16000 * travel_mm),
        size_bytes=size,
        version=IMAGE_VERSION,
        start_state=0,
        states=1,
        transitions=0,
        surfaces=2,
        vibrations=0,
        slots=0,
        name=name.encode("ascii", "replace")[:10],
    )


def seal(header: ImageHeader, body: bytes) -> bytes:
    """Join header and body, with the checksum in its place."""
    data = header.pack() + body
    return data[:4] + struct.pack("<I", zlib.crc32(data[COVERED:])) + data[COVERED:]
