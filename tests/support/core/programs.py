"""Small programs put together by hand."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from fdvv.firmware.core import Core
from fdvv.protocol.record import Record
from fdvv.protocol.tables import (
    NONE,
    Condition,
    ImageHeader,
    Settings,
    Slot,
    State,
    Surface,
    Transition,
    Vibration,
)
from tests.safety._images import Parts

REST = State(
    press_surface=0,
    release_surface=0,
    velocity_source=0,
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
WAVE = Slot(
    waveform=0,
    frequency_Hz16=3200,
    duration_samples=160,
    amplitude_counts=1000,
    decay_q16=60000,
    wave_at=0,
    wave_samples=0,
)
Table = tuple[int, int, Sequence[int], Sequence[Sequence[int]]]
FLAT: Table = (0, 16000, [1600], [[0, 0]])


def when(
    condition: Condition, value: int, target: int, guard: Condition = Condition.ALWAYS, guard_value: int = 0
) -> Transition:
    """Say when to go where."""
    return Transition(
        condition=condition, guard=guard, target=target, slot=NONE, value=value, guard_value=guard_value
    )


def event(at_um16: int, stroke: int = 0, slowest: int = 0, fastest: int = 65535, slot: int = 0) -> Vibration:
    """Say where to vibrate, in the first state."""
    return Vibration(
        at_um16=at_um16, slowest_mm_s16=slowest, fastest_mm_s16=fastest, states=1, stroke=stroke, slot=slot
    )


def image(
    states: Sequence[tuple[State, Sequence[Transition]]] = ((REST, ()),),
    tables: Sequence[Table] = (FLAT,),
    vibrations: Sequence[Vibration] = (),
    slots: int = 4,
) -> bytes:
    """Put an image together; a table is start and step (um16), velocities (mm_s16), rows of forces (cN64)."""
    parts = Parts(vibrations=[*vibrations], slots=[WAVE] * slots)
    for state, run in states:
        parts.states.append(replace(state, first_transition=len(parts.transitions), transitions=len(run)))
        parts.transitions += run
    records: list[Record] = [*parts.states, *parts.transitions, *parts.vibrations, *parts.slots]
    at = ImageHeader.length_bytes() + len(tables) * Surface.length_bytes()
    at += sum(record.length_bytes() for record in records)
    for start, step, velocities, forces in tables:
        rows, columns = np.shape(forces)
        here = at + len(parts.pool)
        parts.pool += struct.pack(f"<{rows}H", *velocities) + np.asarray(forces, "<i2").tobytes()
        parts.surfaces.append(
            Surface(
                start_um16=start,
                step_um16=step,
                columns=columns,
                rows=rows,
                velocities_at=here,
                forces_at=here + 2 * rows,
            )
        )
    return parts.image(name=b"test")


def armed(program: bytes, settings: Settings | None = None) -> Core:
    """Return a core that renders the program from its next tick on."""
    core = Core(settings, program)
    core.arm()
    return core


FINE = Settings(
    position_gain_q14=2**14,
    position_offset_um16=-20000,
    reads=64,
    reading_low=0,
    reading_high=1023,
    slew_cN64_tick=32000,
    jump_um16=65535,
    stuck_ticks=65535,
    late_ticks=1000,
)
"""A rig whose sum of readings tells every 1/16 um from -1.25 mm to 2.8 mm, and which is hard to alarm."""
