"""A table of force as the smallest program that renders it: one state, one surface per stroke."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.force_text import force_text
from fdvv.model.surface import ForceSurface
from fdvv.protocol.messages import CN64_PER_cN, MM_S16_PER_mm_s, UM16_PER_mm, seal
from fdvv.protocol.tables import (
    IMAGE_BYTES,
    IMAGE_MAGIC,
    IMAGE_VERSION,
    NONE,
    SURFACE_DISPLACEMENTS,
    SURFACE_VELOCITIES,
    ImageHeader,
    Slot,
    State,
    Surface,
    VelocitySource,
    Vibration,
)
from fdvv.units import FloatArray

LARGEST_ERROR_cN = 0.1
"""A table that would change by more on its way into an image is refused."""


@dataclass(frozen=True)
class TableImage:
    """A table as the firmware holds it.

    Attributes
    ----------
    image : the program, checksum and all.
    error_cN : by how much it differs from the table at most, anywhere between the table's ends.
    """

    image: bytes
    error_cN: float


def image_of(
    surface: ForceSurface,
    travel_mm: float,
    vibrations: Sequence[Vibration] = (),
    slots: Sequence[Slot] = (),
    paced: bool = False,
    waves: Sequence[Sequence[int]] = (),
) -> TableImage:
    """Make the program that renders a table as it is, and plays these waveforms at these displacements.

    paced : the announced velocity chooses the row, else the one decided in the press.
    waves : samples of each slot, -128 to 127; empty for a sine, and for all if left out.

    Columns stay where they are if their step is a whole number of 1/16 um and all fit; else the table is
    sampled anew, as finely as fits. ModelError if that changes it by more than 0.1 cN, or if its numbers are
    beyond what the firmware holds.
    """
    if surface.velocity_mm_s.size > SURFACE_VELOCITIES:
        raise ModelError(
            f"a device holds {SURFACE_VELOCITIES} velocities at most, got {surface.velocity_mm_s.size}"
        )
    held_waves = [bytes(np.asarray(wave, dtype="i1")) for wave in waves]
    extra = [event.length_bytes() for event in (*vibrations, *slots)] + list(map(len, held_waves))
    start, step, columns = _grid(surface, sum(extra))
    x = (start + step * np.arange(columns)) / UM16_PER_mm
    old = surface.displacement_mm
    tables = [
        np.array([np.interp(x, old, row) for row in rows]) for rows in (surface.press_cN, surface.release_cN)
    ]
    held = [np.round(CN64_PER_cN * table) for table in tables]
    if max(float(np.abs(table).max()) for table in held) > 32000:
        raise ModelError(f"a device holds forces up to {force_text(500)}")
    error = _error(surface, x, held)
    if error > LARGEST_ERROR_cN:
        raise ModelError(
            f"the table would change by {force_text(error, '.3g')} to fit a device; {columns} places at most "
            "fit"
            f" {surface.velocity_mm_s.size} velocities"
        )
    source = VelocitySource.ANNOUNCED if paced else VelocitySource.DECIDED
    grid = start, step, columns
    return TableImage(_pack(surface, travel_mm, grid, held, [*vibrations, *slots], source, held_waves), error)


def _grid(surface: ForceSurface, taken_bytes: int = 0) -> tuple[int, int, int]:
    """Choose first column, step (both 1/16 um) and count, beside what else takes room."""
    first, last = (UM16_PER_mm * float(surface.displacement_mm[i]) for i in (0, -1))
    start, count = round(first), surface.displacement_mm.size
    fits = min(
        SURFACE_DISPLACEMENTS, (IMAGE_BYTES - 160 - taken_bytes) // (4 * surface.velocity_mm_s.size) - 2
    )
    low, high = Surface.LIMITS["step_um16"]
    exact = (last - first) / (count - 1)
    if count <= fits and low <= exact <= high and abs(exact - round(exact)) * (count - 1) < 1:
        return start, round(exact), count
    # a step too long for the firmware is cut into equal ones
    parts = int(np.ceil(exact / high)) if count <= fits else 1
    if parts > 1 and (count - 1) * parts < fits:
        return start, round(exact / parts), (count - 1) * parts + 1
    step = min(high, max(low, int(np.ceil((last - first) / (fits - 1)))))
    return start, step, max(2, int(np.ceil((last - first) / step)) + 1)


def _error(surface: ForceSurface, x: FloatArray, held: list[FloatArray]) -> float:
    """Compare at the places of both grids, where the difference of two broken lines is largest."""
    old = surface.displacement_mm
    places = np.concatenate([x[(x >= old[0]) & (x <= old[-1])], old])
    rows = zip(np.vstack([surface.press_cN, surface.release_cN]), np.vstack(held) / CN64_PER_cN, strict=True)
    return max(float(np.abs(np.interp(places, old, a) - np.interp(places, x, b)).max()) for a, b in rows)


def _pack(
    surface: ForceSurface,
    travel_mm: float,
    grid: tuple[int, int, int],
    held: list[FloatArray],
    events: Sequence[Vibration | Slot],
    source: VelocitySource,
    waves: Sequence[bytes],
) -> bytes:
    start, step, columns = grid
    rows = surface.velocity_mm_s.size
    fixed = ImageHeader.length_bytes() + State.length_bytes() + 2 * Surface.length_bytes()
    fixed += sum(event.length_bytes() for event in events)
    speeds = np.round(MM_S16_PER_mm_s * surface.velocity_mm_s).astype("<u2").tobytes()
    forces = [table.astype("<i2").tobytes() for table in held]
    places = [fixed + len(speeds) + i * len(forces[0]) for i in (0, 1)]
    parts = [_state(source).pack()]
    parts += [
        Surface(
            start_um16=start, step_um16=step, columns=columns, rows=rows, velocities_at=fixed, forces_at=at
        ).pack()
        for at in places
    ]
    placed = _place(events, waves, places[1] + len(forces[1]))
    body = b"".join([*parts, *(event.pack() for event in placed), speeds, *forces, *waves])
    body += bytes(-len(body) % 4)
    return _seal(body, round(UM16_PER_mm * travel_mm), events)


def _place(events: Sequence[Vibration | Slot], waves: Sequence[bytes], at: int) -> list[Vibration | Slot]:
    """Return the events with each slot at its own samples, which lie one after the other from ``at``."""
    placed: list[Vibration | Slot] = []
    left = list(waves)
    for event in events:
        wave = left.pop(0) if isinstance(event, Slot) and left else b""
        if isinstance(event, Slot) and wave:
            placed.append(replace(event, wave_at=at, wave_samples=len(wave)))
        else:
            placed.append(event)
        at += len(wave)
    return placed


def _state(source: VelocitySource) -> State:
    nothing = State.unpack(bytes(State.length_bytes()))
    return replace(nothing, release_surface=1, velocity_source=source, enter_slot=NONE, repeat_slot=NONE)


def _seal(body: bytes, travel_um16: int, events: Sequence[Vibration | Slot]) -> bytes:
    head = ImageHeader(
        magic=IMAGE_MAGIC,
        crc32=0,
        travel_um16=travel_um16,
        size_bytes=ImageHeader.length_bytes() + len(body),
        version=IMAGE_VERSION,
        start_state=0,
        states=1,
        transitions=0,
        surfaces=2,
        vibrations=sum(isinstance(event, Vibration) for event in events),
        slots=sum(isinstance(event, Slot) for event in events),
        spare=0,
        name=b"table",
    )
    return seal(head.pack() + body)
