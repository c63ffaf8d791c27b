"""The bytes of an image: records in their order, then velocities, forces and waves, each stored once."""

from __future__ import annotations

import struct
from collections.abc import Sequence
from itertools import accumulate

from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import Program, Signal, State, VibrationEvent
from fdvv.program.surface import Grid, Surface, counts_cN64, place_um16, speed_mm_s16
from fdvv.program.synth import Slot
from fdvv.protocol.messages import seal
from fdvv.protocol.tables import IMAGE_BYTES, IMAGE_MAGIC, IMAGE_VERSION, NONE, ImageHeader
from fdvv.protocol.tables import Slot as SlotRecord
from fdvv.protocol.tables import State as StateRecord
from fdvv.protocol.tables import Surface as SurfaceRecord
from fdvv.protocol.tables import Transition as TransitionRecord
from fdvv.protocol.tables import Vibration as VibrationRecord

NAME_BYTES = 10  # room in the header (protocol/fdvv.toml, structs.image_header)


class _Pool:
    """Bytes after the records; what is there already is not stored again."""

    def __init__(self, start: int) -> None:
        self.start, self.data = start, b""
        self.places: dict[tuple[bytes, int], int] = {}

    def put(self, data: bytes, align: int = 2) -> int:
        """Return the offset in the image at which these bytes lie."""
        if (data, align) not in self.places:
            self.data += bytes(-(self.start + len(self.data)) % align)
            self.places[data, align] = self.start + len(self.data)
            self.data += data
        return self.places[data, align]


def lay_out(program: Program, grids: Sequence[Grid], slots: Sequence[Slot], weight_cN: float) -> bytes:
    """Return the image of a program whose states carry a weight.

    An image that is larger than a device takes is only as long as it would be, and empty.
    """
    transitions = [t for state in program.states for t in state.transitions]
    sizes = (
        ImageHeader.length_bytes(),
        StateRecord.length_bytes() * len(program.states),
        TransitionRecord.length_bytes() * len(transitions),
        SurfaceRecord.length_bytes() * len(grids),
        VibrationRecord.length_bytes() * len(program.vibrations),
        SlotRecord.length_bytes() * len(slots),
    )
    pool = _Pool(sum(sizes))
    tables = [_table_places(grid, pool) for grid in grids]
    places = [pool.put(struct.pack(f"{len(s.wave)}b", *s.wave), 1) if s.wave else 0 for s in slots]
    size = pool.start + len(pool.data)
    size += -size % 4
    if size > IMAGE_BYTES:
        return bytes(size)
    records = [
        _header(program, len(transitions), size),
        *_state_records(program, weight_cN),
        *(_transition_record(program, transition) for transition in transitions),
        *(_surface_record(grid, *at) for grid, at in zip(grids, tables, strict=True)),
        *(_vibration_record(program, event) for event in program.vibrations),
        *(_slot_record(slot, at) for slot, at in zip(slots, places, strict=True)),
    ]
    body = b"".join(record.pack() for record in records) + pool.data
    body += bytes(size - len(body))
    return seal(body)


def _header(program: Program, transitions: int, size: int) -> ImageHeader:
    return ImageHeader(
        magic=IMAGE_MAGIC,
        crc32=0,
        travel_um16=place_um16(program.travel_mm),
        size_bytes=size,
        version=IMAGE_VERSION,
        start_state=_number(program.states, program.start),
        states=len(program.states),
        transitions=transitions,
        surfaces=len(program.surfaces),
        vibrations=len(program.vibrations),
        slots=len(program.signals),
        name=program.name.encode("ascii", "replace")[:NAME_BYTES],
    )


def _number(parts: Sequence[State | Surface | Signal], name: str | None) -> int:
    """Return the place of a part in its list, which is what the image calls it."""
    return NONE if name is None else [part.name for part in parts].index(name)


def _state_records(program: Program, weight_cN: float) -> list[StateRecord]:
    firsts = accumulate((len(state.transitions) for state in program.states), initial=0)
    return [
        _state_record(program, state, at, weight_cN)
        for state, at in zip(program.states, firsts, strict=False)
    ]


def _state_record(program: Program, state: State, first: int, weight_cN: float) -> StateRecord:
    return StateRecord(
        press_surface=_number(program.surfaces, state.press),
        release_surface=_number(program.surfaces, state.release),
        velocity_source=state.velocity.code,
        key=state.key,
        first_transition=first,
        transitions=len(state.transitions),
        enter_slot=_number(program.signals, state.enter_signal),
        repeat_slot=_number(program.signals, state.repeat_signal),
        repeat_ms=state.repeat_ms,
        fade_ms=state.fade_ms,
        bias_cN64=counts_cN64(state.bias_cN + weight_cN),
        bias_end_cN64=counts_cN64(state.bias_end_cN + weight_cN) if state.bias_ms else 0,
        bias_ms=state.bias_ms,
    )


def value_of(condition: Condition) -> int:
    if condition.when.endswith("_mm"):
        return place_um16(condition.value)
    if condition.when.endswith("_mm_s"):
        return speed_mm_s16(condition.value)
    return int(condition.value)


def _transition_record(program: Program, transition: Transition) -> TransitionRecord:
    guard = transition.only_if or Condition(When.ALWAYS)
    return TransitionRecord(
        condition=transition.when.when.code,
        guard=guard.when.code,
        target=_number(program.states, transition.to),
        slot=_number(program.signals, transition.signal),
        value=value_of(transition.when),
        guard_value=value_of(guard),
    )


def _table_places(grid: Grid, pool: _Pool) -> tuple[int, int]:
    velocities = pool.put(struct.pack(f"<{len(grid.velocities_mm_s16)}H", *grid.velocities_mm_s16))
    forces = [f for row in grid.forces_cN64 for f in row]
    return velocities, pool.put(struct.pack(f"<{len(forces)}h", *forces))


def _surface_record(grid: Grid, velocities_at: int, forces_at: int) -> SurfaceRecord:
    return SurfaceRecord(
        start_um16=grid.start_um16,
        step_um16=grid.step_um16,
        columns=grid.columns,
        rows=len(grid.velocities_mm_s16),
        velocities_at=velocities_at,
        forces_at=forces_at,
    )


def _vibration_record(program: Program, event: VibrationEvent) -> VibrationRecord:
    slowest, fastest = event.slowest_mm_s, event.fastest_mm_s
    named = event.states or tuple(s.name for s in program.states)
    return VibrationRecord(
        at_um16=place_um16(event.at_mm),
        slowest_mm_s16=0 if slowest is None else speed_mm_s16(slowest),
        fastest_mm_s16=65_535 if fastest is None else speed_mm_s16(fastest),
        states=sum(1 << _number(program.states, name) for name in set(named)),
        stroke=event.stroke.code,
        slot=_number(program.signals, event.signal),
    )


def _slot_record(slot: Slot, wave_at: int) -> SlotRecord:
    return SlotRecord(
        waveform=slot.waveform,
        frequency_Hz16=slot.frequency_Hz16,
        duration_samples=slot.duration_samples,
        amplitude_counts=slot.amplitude_counts,
        decay_q16=slot.decay_q16,
        wave_at=wave_at,
        wave_samples=len(slot.wave),
    )
