"""A program image taken apart, and the lookup of a surface, in plain Python."""

from __future__ import annotations

import struct
from dataclasses import dataclass, field

from fdvv.protocol.record import Record
from fdvv.protocol.tables import ImageHeader, State, Surface, Transition, Vibration
from tests.support.core.arithmetic import ONE, blend, part, reciprocal


@dataclass
class Program:
    """An image taken apart."""

    image: bytes
    head: ImageHeader = field(init=False)
    parts: dict[type[Record], list[Record]] = field(init=False)

    def __post_init__(self) -> None:
        self.head = ImageHeader.unpack(self.image[:32])
        at, self.parts = 32, {}
        counts = (self.head.states, self.head.transitions, self.head.surfaces, self.head.vibrations)
        kinds: tuple[type[Record], ...] = (State, Transition, Surface, Vibration)
        for kind, count in zip(kinds, counts, strict=True):
            size = kind.length_bytes()
            self.parts[kind] = [kind.unpack(self.image[at + size * k :][:size]) for k in range(count)]
            at += size * count

    def state(self, index: int) -> State:
        found = self.parts[State][index]
        assert isinstance(found, State)
        return found

    def transitions(self, state: State) -> list[Transition]:
        run = slice(state.first_transition, state.first_transition + state.transitions)
        return [t for t in self.parts[Transition][run] if isinstance(t, Transition)]

    def vibrations(self) -> list[Vibration]:
        return [v for v in self.parts[Vibration] if isinstance(v, Vibration)]

    def force_cN64(self, index: int, x: int, velocity: int) -> int:
        """Look up a surface: first along the displacements, then between the rows."""
        s = self.parts[Surface][index]
        assert isinstance(s, Surface)
        speeds = struct.unpack_from(f"<{s.rows}H", self.image, s.velocities_at)
        forces = struct.unpack_from(f"<{s.rows * s.columns}h", self.image, s.forces_at)
        column, across = place_in_columns(x - s.start_um16, s.step_um16, s.columns)
        rows = [
            blend(forces[r * s.columns + column], forces[r * s.columns + column + 1], across)
            for r in range(s.rows)
        ]
        below = [r for r in range(s.rows) if speeds[r] <= velocity]
        row = below[-1] if below else 0
        if not below or row == s.rows - 1:
            return rows[row]
        return blend(rows[row], rows[row + 1], part(velocity - speeds[row], speeds[row + 1] - speeds[row]))


def place_in_columns(way: int, step: int, columns: int) -> tuple[int, int]:
    """Return the column and, in Q15, how far towards the next; ends hold."""
    if way <= 0:
        return 0, 0
    if way >= (columns - 1) * step:
        return columns - 2, ONE
    fill = 16 - step.bit_length()
    r = 65535 if step << fill == ONE else reciprocal(step << fill)
    return way // step, (way % step << fill) * r >> 16
