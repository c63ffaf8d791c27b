"""Random programs for comparing one implementation of the tick with another.

Everything is drawn from the generator that is passed in, so that a seed names a case.
"""

from __future__ import annotations

import zlib
from dataclasses import replace

import numpy as np

from fdvv.protocol.tables import (
    IMAGE_BYTES,
    IMAGE_MAGIC,
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
from tests.support.random_presses import Generator, integer, sometimes


def random_slot(rng: Generator, slots: int) -> int:
    """Draw a slot or none."""
    return sometimes(rng, 0.5, integer(rng, 0, slots - 1), NONE) if slots else NONE


def random_state(rng: Generator, surfaces: int, slots: int, most_cN64: int, first: int, count: int) -> State:
    """Draw a state that owns a run of transitions."""
    repeat = random_slot(rng, slots)
    return State(
        press_surface=integer(rng, 0, surfaces - 1),
        release_surface=integer(rng, 0, surfaces - 1),
        velocity_source=integer(rng, 0, 2),
        key=sometimes(rng, 0.5, 0, integer(rng, 1, 255)),
        first_transition=first,
        transitions=count,
        enter_slot=random_slot(rng, slots),
        repeat_slot=repeat,
        repeat_ms=0 if repeat == NONE else integer(rng, 1, 60),
        fade_ms=sometimes(rng, 0.5, 0, integer(rng, 1, 100)),
        bias_cN64=integer(rng, -most_cN64, most_cN64),
        bias_end_cN64=integer(rng, -most_cN64, most_cN64),
        bias_ms=sometimes(rng, 0.5, 0, integer(rng, 1, 300)),
    )


def random_value(rng: Generator, condition: int) -> int:
    """Draw a value at which the condition is sometimes true."""
    if condition == Condition.AFTER_MS:
        return integer(rng, 0, 80)
    if condition == Condition.HOST_EVENT:
        return integer(rng, 0, 31)
    if condition in (Condition.FASTER_THAN, Condition.SLOWER_THAN):
        return integer(rng, 0, 4000)
    if condition in (Condition.RISEN_BY, Condition.FALLEN_BY):
        return integer(rng, 1, 20000)
    return integer(rng, -1000, 60000)


def random_transition(rng: Generator, states: int, slots: int) -> Transition:
    """Draw a transition, guarded every third time."""
    condition, guard = integer(rng, 0, 10), sometimes(rng, 0.67, 0, integer(rng, 0, 10))
    if condition == Condition.ALWAYS and guard == Condition.ALWAYS:
        condition = Condition.AFTER_MS
    return Transition(
        condition=condition,
        guard=guard,
        target=integer(rng, 0, states - 1),
        slot=random_slot(rng, slots),
        value=random_value(rng, condition),
        guard_value=random_value(rng, guard),
    )


def random_vibration(rng: Generator, states: int, slots: int) -> Vibration:
    """Draw a vibration event somewhere in the travel."""
    slowest = sometimes(rng, 0.5, 0, integer(rng, 0, 3000))
    return Vibration(
        at_um16=integer(rng, -1000, 60000),
        slowest_mm_s16=slowest,
        fastest_mm_s16=sometimes(rng, 0.5, 65535, slowest + integer(rng, 1, 6000)),
        states=integer(rng, 0, 2**states - 1),
        stroke=integer(rng, 0, 2),
        slot=integer(rng, 0, slots - 1),
    )


def random_waveform(rng: Generator) -> Slot:
    """Draw a decaying sine."""
    return Slot(
        waveform=0,
        frequency_Hz16=integer(rng, 800, 8000),
        duration_samples=integer(rng, 100, 2000),
        amplitude_counts=integer(rng, 0, 2047),
        decay_q16=integer(rng, 30000, 65535),
        wave_at=0,
        wave_samples=0,
    )


def random_sizes(rng: Generator, surfaces: int, room_bytes: int) -> list[tuple[int, int]]:
    """Draw rows and columns of the surfaces so that their numbers fit the room."""
    sizes = []
    for left in range(surfaces, 0, -1):
        rows = min(integer(rng, 1, 16), room_bytes // (left * 8))
        columns = min(integer(rng, 2, 255), (room_bytes // left - 2 * rows) // (2 * rows))
        room_bytes -= 2 * rows * (1 + columns)
        sizes.append((rows, columns))
    return sizes


def random_runs(rng: Generator, states: int, most: int) -> list[int]:
    """Draw how many transitions each state has, at most so many together."""
    runs = []
    for _ in range(states):
        runs.append(integer(rng, 0, min(6, most)))
        most -= runs[-1]
    return runs


def random_image(rng: Generator, settings: Settings | None = None) -> bytes:
    """Draw a program that the firmware accepts with these settings (or the default ones)."""
    most_cN64 = (settings or Settings()).force_limit_cN64 // 2
    states, surfaces, slots = integer(rng, 1, 16), integer(rng, 1, 16), integer(rng, 0, 16)
    runs = random_runs(rng, states, 48)
    vibrations = integer(rng, 0, 32) if slots else 0
    firsts = np.cumsum([0, *runs])
    parts: list[State | Transition | Vibration | Slot] = [
        random_state(rng, surfaces, slots, most_cN64, int(first), run)
        for first, run in zip(firsts, runs, strict=False)
    ]
    parts += [random_transition(rng, states, slots) for _ in range(sum(runs))]
    behind: list[State | Transition | Vibration | Slot] = [
        random_vibration(rng, states, slots) for _ in range(vibrations)
    ]
    behind += [random_waveform(rng) for _ in range(slots)]
    return assemble(rng, parts, behind, (states, sum(runs), surfaces, vibrations, slots), most_cN64)


def assemble(
    rng: Generator,
    before: list[State | Transition | Vibration | Slot],
    behind: list[State | Transition | Vibration | Slot],
    counts: tuple[int, int, int, int, int],
    most_cN64: int,
) -> bytes:
    """Put the surfaces between the parts before and behind, their numbers at the end, a header in front."""
    states, transitions, surfaces, vibrations, slots = counts
    head, tail = b"".join(p.pack() for p in before), b"".join(p.pack() for p in behind)
    pool_at = ImageHeader.length_bytes() + len(head) + surfaces * Surface.length_bytes() + len(tail)
    sizes = random_sizes(rng, surfaces, IMAGE_BYTES - 4 - pool_at)
    records, pool = random_surfaces(rng, sizes, pool_at, most_cN64)
    body = head + records + tail + pool
    body += bytes(-len(body) % 4)
    header = ImageHeader(
        magic=IMAGE_MAGIC,
        crc32=0,
        travel_um16=integer(rng, 1600, 102400),
        size_bytes=ImageHeader.length_bytes() + len(body),
        version=1,
        start_state=integer(rng, 0, states - 1),
        states=states,
        transitions=transitions,
        surfaces=surfaces,
        vibrations=vibrations,
        slots=slots,
        name=b"random",
    )
    return replace(header, crc32=zlib.crc32((header.pack() + body)[8:])).pack() + body


def random_surfaces(
    rng: Generator, sizes: list[tuple[int, int]], pool_at: int, most_cN64: int
) -> tuple[bytes, bytes]:
    """Draw surfaces of these rows and columns: their records, and their numbers from an offset on."""
    records, pool = b"", b""
    for rows, columns in sizes:
        at = pool_at + len(pool)
        top = 65535 if rng.random() < 0.1 else 12000
        velocities = np.sort(rng.choice(top, rows, replace=False)).astype("<u2")
        forces = rng.integers(-most_cN64, most_cN64, (rows, columns), endpoint=True).astype("<i2")
        pool += velocities.tobytes() + forces.tobytes()
        record = Surface(
            start_um16=integer(rng, -3000, 8000),
            step_um16=sometimes(rng, 0.8, min(max(16, 60000 // columns), 16000), integer(rng, 16, 16000)),
            columns=columns,
            rows=rows,
            velocities_at=at,
            forces_at=at + 2 * rows,
        )
        records += record.pack()
    return records, pool
