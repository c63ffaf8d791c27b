"""What an image holds, back in a designer's units."""

from __future__ import annotations

import struct
from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from fdvv.errors import InputError, ModelError
from fdvv.program.condition import Condition, Transition, When
from fdvv.program.program import During, State, Velocity, VibrationEvent
from fdvv.program.surface import Surface
from fdvv.program.synth import Slot, Waveform
from fdvv.protocol.messages import CN64_PER_cN, MM_S16_PER_mm_s, UM16_PER_mm, checksum_of
from fdvv.protocol.record import Record
from fdvv.protocol.tables import IMAGE_BYTES, IMAGE_MAGIC, NONE, ImageHeader
from fdvv.protocol.tables import Slot as SlotRecord
from fdvv.protocol.tables import State as StateRecord
from fdvv.protocol.tables import Surface as SurfaceRecord
from fdvv.protocol.tables import Transition as TransitionRecord
from fdvv.protocol.tables import Vibration as VibrationRecord

R = TypeVar("R", bound=Record)


@dataclass(frozen=True)
class Description:
    """The parts of an image; it keeps no names, so they are numbered: `state 0`, `surface 0`, `signal 0`.

    Attributes
    ----------
    name : its first ten characters.
    travel_mm, start : as in a program.
    states, surfaces, vibrations : as in a program; surfaces as they are on their even grids.
    slots : what the vibration board plays as `signal 0`, `signal 1`, …
    """

    name: str
    travel_mm: float
    start: str
    states: tuple[State, ...]
    surfaces: tuple[Surface, ...]
    vibrations: tuple[VibrationEvent, ...]
    slots: tuple[Slot, ...]
    size_bytes: int


def describe(image: bytes, source: object = "image") -> Description:
    """Take an image apart.

    Raises InputError if it is none, is damaged, or its parts do not fit together.
    """
    remedy = "compile the program again"
    head_bytes = ImageHeader.length_bytes()
    if not head_bytes <= len(image) <= IMAGE_BYTES or image[:4] != struct.pack("<I", IMAGE_MAGIC):
        raise InputError(source, "whole file", "is not the image of a program", remedy)
    if struct.unpack_from("<I", image, 4)[0] != checksum_of(image):
        raise InputError(source, "checksum", "does not fit the bytes", remedy)
    try:
        return _Parts(image).description()
    except (ModelError, struct.error, ValueError, IndexError) as error:
        raise InputError(source, "layout", str(error), remedy) from error


class _Parts:
    """The records of an image, in the order in which they lie."""

    def __init__(self, image: bytes) -> None:
        self.image, self.at = image, 0
        (self.head,) = self._take(ImageHeader, 1)
        if self.head.size_bytes != len(image):
            raise ModelError(f"{len(image)} bytes, its header tells of {self.head.size_bytes}")
        self.states = self._take(StateRecord, self.head.states)
        self.transitions = self._take(TransitionRecord, self.head.transitions)
        self.surfaces = self._take(SurfaceRecord, self.head.surfaces)
        self.vibrations = self._take(VibrationRecord, self.head.vibrations)
        self.slots = self._take(SlotRecord, self.head.slots)

    def _take(self, kind: type[R], count: int) -> list[R]:
        size = kind.length_bytes()
        records = [kind.unpack(self.image[self.at + i * size :][:size]) for i in range(count)]
        self.at += count * size
        return records

    def description(self) -> Description:
        head = self.head
        return Description(
            head.name.rstrip(b"\0").decode("ascii"),
            head.travel_um16 / UM16_PER_mm,
            _state(head.start_state),
            tuple(self._state(i) for i in range(head.states)),
            tuple(self._surface(i) for i in range(head.surfaces)),
            tuple(self._vibration(v) for v in self.vibrations),
            tuple(self._slot(s) for s in self.slots),
            head.size_bytes,
        )

    def _state(self, index: int) -> State:
        record = self.states[index]
        run = self.transitions[record.first_transition :][: record.transitions]
        if len(run) < record.transitions:
            raise ModelError(f"state {index}: its transitions reach beyond the last")
        return State(
            _state(index),
            f"surface {record.press_surface}",
            f"surface {record.release_surface}",
            tuple(_transition(t) for t in run),
            record.key,
            Velocity(list(Velocity)[record.velocity_source]),
            _signal(record.enter_slot),
            _signal(record.repeat_slot),
            record.repeat_ms,
            record.fade_ms,
            record.bias_cN64 / CN64_PER_cN,
            record.bias_end_cN64 / CN64_PER_cN,
            record.bias_ms,
        )

    def _surface(self, index: int) -> Surface:
        record = self.surfaces[index]
        count = record.rows * record.columns
        speeds = struct.unpack_from(f"<{record.rows}H", self.image, record.velocities_at)
        forces = struct.unpack_from(f"<{count}h", self.image, record.forces_at)
        places = (record.start_um16 + record.step_um16 * np.arange(record.columns)) / UM16_PER_mm
        table = np.reshape(forces, (record.rows, record.columns)) / CN64_PER_cN
        return Surface(
            f"surface {index}",
            tuple(places.tolist()),
            tuple(map(tuple, table.tolist())),
            tuple(speed / MM_S16_PER_mm_s for speed in speeds),
        )

    def _vibration(self, record: VibrationRecord) -> VibrationEvent:
        return VibrationEvent(
            f"signal {record.slot}",
            record.at_um16 / UM16_PER_mm,
            list(During)[record.stroke],
            # no bound was compiled to 0 and to the largest number
            record.slowest_mm_s16 / MM_S16_PER_mm_s or None,
            None if record.fastest_mm_s16 == 65_535 else record.fastest_mm_s16 / MM_S16_PER_mm_s,
            tuple(_state(i) for i in range(self.head.states) if record.states >> i & 1),
        )

    def _slot(self, record: SlotRecord) -> Slot:
        wave = struct.unpack_from(f"{record.wave_samples}b", self.image, record.wave_at)
        return Slot(
            Waveform(record.waveform),
            record.frequency_Hz16,
            record.duration_samples,
            record.amplitude_counts,
            record.decay_q16,
            wave,
        )


def _state(index: int) -> str:
    return f"state {index}"


def _signal(slot: int) -> str | None:
    return None if slot == NONE else f"signal {slot}"


def _condition(code: int, value: int) -> Condition:
    when = list(When)[code]
    if when.endswith("_mm"):
        return Condition(when, value / UM16_PER_mm)
    if when.endswith("_mm_s"):
        return Condition(when, value / MM_S16_PER_mm_s)
    return Condition(when, value)


def _transition(record: TransitionRecord) -> Transition:
    guard = _condition(record.guard, record.guard_value) if record.guard else None
    signal = _signal(record.slot)
    return Transition(_state(record.target), _condition(record.condition, record.value), guard, signal)
