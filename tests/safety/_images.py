"""Valid random programs, made from the protocol's records, and images put together from parts."""

from __future__ import annotations

import random
import struct
import zlib
from dataclasses import dataclass, field

from fdvv.protocol.record import Record
from fdvv.protocol.tables import (
    IMAGE_MAGIC,
    NONE,
    Condition,
    ImageHeader,
    Slot,
    State,
    Surface,
    Transition,
    Vibration,
    Waveform,
)

LIMIT_CN64 = 28160


@dataclass
class Parts:
    """The tables of a program and what lies behind them."""

    states: list[State] = field(default_factory=list)
    transitions: list[Transition] = field(default_factory=list)
    surfaces: list[Surface] = field(default_factory=list)
    vibrations: list[Vibration] = field(default_factory=list)
    slots: list[Slot] = field(default_factory=list)
    pool: bytes = b""

    def image(self, **header: int | bytes) -> bytes:
        """Put the image together; header fields may be given otherwise than they ought to be."""
        tables: list[list[Record]] = [getattr(self, name) for name in TABLES]
        body = b"".join(record.pack() for table in tables for record in table) + self.pool
        body += bytes(-len(body) % 4)
        fields: dict[str, int | bytes] = dict(
            zip(TABLES, map(len, tables), strict=True),
            magic=IMAGE_MAGIC,
            crc32=0,
            travel_um16=64000,
            size_bytes=ImageHeader.length_bytes() + len(body),
            version=1,
            start_state=0,
            name=b"random",
        )
        return sealed(ImageHeader(**(fields | header)).pack() + body)  # type: ignore[arg-type]


def sealed(image: bytes) -> bytes:
    """Return the image with its correct checksum."""
    return image[:4] + struct.pack("<I", zlib.crc32(image[8:])) + image[8:]


TABLES: dict[str, type[Record]] = {
    "states": State,
    "transitions": Transition,
    "surfaces": Surface,
    "vibrations": Vibration,
    "slots": Slot,
}
"""The tables of an image in their order."""


def random_parts(rng: random.Random, counts: dict[str, int] | None = None) -> Parts:
    """Draw the parts of a program that is right in every way, with so many records in its tables."""
    counts = counts or {
        "states": rng.randint(1, 16),
        "transitions": rng.choice([0, 1, rng.randint(2, 48)]),
        "surfaces": rng.randint(1, 16),
        "vibrations": rng.choice([0, 1, rng.randint(2, 32)]),
        "slots": rng.randint(1, 16),
    }
    at = ImageHeader.length_bytes()
    at += sum(TABLES[name].length_bytes() * count for name, count in counts.items())
    parts = Parts()
    for _ in range(counts["surfaces"]):
        parts.surfaces.append(_surface(rng, parts, at))
    parts.slots = [_slot(rng, parts, at) for _ in range(counts["slots"])]
    parts.states = [_state(rng, counts) for _ in range(counts["states"])]
    parts.transitions = [_transition(rng, counts) for _ in range(counts["transitions"])]
    parts.vibrations = [_vibration(rng, counts) for _ in range(counts["vibrations"])]
    return parts


def _surface(rng: random.Random, parts: Parts, pool_at: int) -> Surface:
    rows, columns = rng.randint(1, 4), rng.randint(2, 24)
    parts.pool += bytes(len(parts.pool) % 2)
    velocities_at = pool_at + len(parts.pool)
    parts.pool += struct.pack(f"<{rows}H", *sorted(rng.sample(range(8, 16000), rows)))
    forces = [rng.randint(-LIMIT_CN64 // 2, LIMIT_CN64 // 2) for _ in range(rows * columns)]
    forces_at = pool_at + len(parts.pool)
    parts.pool += struct.pack(f"<{len(forces)}h", *forces)
    return Surface(
        start_um16=rng.randint(-32000, 32000),
        step_um16=rng.randint(16, 16000),
        columns=columns,
        rows=rows,
        velocities_at=velocities_at,
        forces_at=forces_at,
    )


def _slot(rng: random.Random, parts: Parts, pool_at: int) -> Slot:
    waveform = rng.choice([*Waveform])
    samples = 0 if waveform is Waveform.DECAYING_SINE else rng.randint(1, 40)
    at = pool_at + len(parts.pool) if samples else 0
    parts.pool += rng.randbytes(samples)
    return Slot(
        waveform=waveform,
        frequency_Hz16=rng.randint(0, 65535),
        duration_samples=rng.randint(1, 65535),
        amplitude_counts=rng.randint(0, 2047),
        decay_q16=rng.randint(0, 65535),
        wave_at=at,
        wave_samples=samples,
    )


def _state(rng: random.Random, counts: dict[str, int]) -> State:
    first = rng.randint(0, counts["transitions"])
    repeat = rng.choice([NONE, rng.randrange(counts["slots"])])
    return State(
        press_surface=rng.randrange(counts["surfaces"]),
        release_surface=rng.randrange(counts["surfaces"]),
        velocity_source=rng.randint(0, 2),
        key=rng.randint(0, 255),
        first_transition=first,
        transitions=rng.randint(0, counts["transitions"] - first),
        enter_slot=rng.choice([NONE, rng.randrange(counts["slots"])]),
        repeat_slot=repeat,
        repeat_ms=0 if repeat == NONE else rng.randint(1, 65535),
        fade_ms=rng.randint(0, 2000),
        bias_cN64=rng.randint(-LIMIT_CN64 // 2, LIMIT_CN64 // 2),
        bias_end_cN64=rng.randint(-LIMIT_CN64 // 2, LIMIT_CN64 // 2),
        bias_ms=rng.randint(0, 65535),
    )


def _operand(rng: random.Random, condition: Condition) -> int:
    if condition is Condition.HOST_EVENT:
        return rng.randint(0, 31)
    return rng.randint(0 if condition >= Condition.AFTER_MS else -(2**31), 2**31 - 1)


def _transition(rng: random.Random, counts: dict[str, int]) -> Transition:
    condition, guard = rng.choice([*Condition]), rng.choice([*Condition])
    return Transition(
        condition=condition,
        guard=guard,
        target=rng.randrange(counts["states"]),
        slot=rng.choice([NONE, rng.randrange(counts["slots"])]),
        value=_operand(rng, condition),
        guard_value=_operand(rng, guard),
    )


def _vibration(rng: random.Random, counts: dict[str, int]) -> Vibration:
    return Vibration(
        at_um16=rng.randint(-32000, 320000),
        slowest_mm_s16=rng.randint(0, 65535),
        fastest_mm_s16=rng.randint(0, 65535),
        states=rng.randrange(1 << counts["states"]),
        stroke=rng.randint(0, 2),
        slot=rng.randrange(counts["slots"]),
    )
