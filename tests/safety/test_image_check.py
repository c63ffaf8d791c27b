"""What the image check accepts, what it refuses and where, and that it reads nothing outside the image."""

from __future__ import annotations

import dataclasses
import random
import struct
import zlib
from dataclasses import replace

import pytest

from fdvv.protocol.record import Record
from fdvv.protocol.tables import NONE, Condition, ImageHeader, Refusal, Settings
from tests.safety._checking import check_image, fuzz
from tests.safety._images import LIMIT_CN64, TABLES, Parts, random_parts, sealed
from tests.support.campaign import campaign


def images(seed: int, count: int) -> list[bytes]:
    rng = random.Random(seed)
    return [random_parts(rng).image() for _ in range(count)]


@pytest.mark.parametrize("step_bytes", [0, 1, 64, 256, 65535])
def test_right_programs_are_accepted_in_steps_of_any_size(step_bytes: int) -> None:
    for image in images(step_bytes, 40):
        assert check_image(image, step_bytes=step_bytes).verdict is Refusal.NONE


def test_a_flipped_bit_anywhere_is_found() -> None:
    image = small().image()
    for bit in range(8 * len(image)):
        flipped = bytearray(image)
        flipped[bit // 8] ^= 1 << bit % 8
        verdict = check_image(bytes(flipped), crc32=int.from_bytes(image[4:8], "little")).verdict
        assert verdict in (Refusal.CHECKSUM, Refusal.IMAGE_LAYOUT)


def test_the_program_announced_is_the_one_that_must_be_there() -> None:
    image = images(2, 1)[0]
    other = sealed(image[:-1] + bytes([image[-1] ^ 1]))
    assert check_image(other, crc32=int.from_bytes(image[4:8], "little")).verdict is Refusal.CHECKSUM


@campaign("seed", range(50), part=1)
def test_no_mutated_image_is_read_beyond_its_end(seed: int) -> None:
    # the walk through accepted ones would fail; test_instrumented.py runs this with the address sanitiser
    verdicts = fuzz(images(seed, 60), seed=seed + 1, count=20_000)
    assert sum(verdicts.values()) == 20_000
    assert set(verdicts) == {Refusal.NONE, Refusal.CHECKSUM, Refusal.IMAGE_LAYOUT, Refusal.IMAGE_RANGE}
    assert min(verdicts.values()) > 500


def small() -> Parts:
    """Two records of each; slot 0 is a sine, slot 1 a sampled wave."""
    for seed in range(100):
        parts = random_parts(random.Random(seed), dict.fromkeys(TABLES, 2))
        if [slot.waveform for slot in parts.slots] == [0, 1] and parts.surfaces[1].rows > 1:
            return parts
    raise AssertionError("no seed gives such a program")


def offset(record: type[Record], name: str) -> int:
    """Count the bytes before a field."""
    names = [field.name for field in dataclasses.fields(record)]
    return struct.calcsize("<" + record.FORMAT[1 : 1 + names.index(name)])


def place(table: str, number: int, name: str) -> int:
    """Return the offset of a field in the small image."""
    at = ImageHeader.length_bytes()
    for each, record in TABLES.items():
        if each == table:
            return at + number * record.length_bytes() + offset(record, name)
        at += 2 * record.length_bytes()
    raise KeyError(table)


def patched(image: bytes, at: int, value: bytes) -> bytes:
    """Return the image with other bytes at an offset, sealed again."""
    return sealed(image[:at] + value + image[at + len(value) :])


LAYOUT, RANGE = Refusal.IMAGE_LAYOUT, Refusal.IMAGE_RANGE
HEADER_CASES = [
    ("magic", 0, b"G", LAYOUT, 0),
    ("size_bytes", 12, b"\0", LAYOUT, 12),
    ("travel below the least", 8, struct.pack("<i", 1599), RANGE, 8),
    ("version", 14, b"\2", RANGE, 14),
    ("start beyond the states", 15, b"\2", LAYOUT, 15),
    ("no state", 16, b"\0", RANGE, 16),
    ("17 states", 16, b"\x11", RANGE, 16),
    ("no surface", 18, b"\0", RANGE, 18),
    ("spare", 21, b"\1", RANGE, 21),
    ("tables longer than the image", 15, bytes([0, 16, 48, 16, 32, 16]), LAYOUT, 16),
    ("letters after the name's end", 22, b"ab\0c", RANGE, 25),
    ("not ASCII", 22, b"a\x7f", RANGE, 23),
    ("the last letter", 22, b"123456789\x80", RANGE, 31),
]


@pytest.mark.parametrize(("at", "value", "verdict", "detail"), [c[1:] for c in HEADER_CASES], ids=str)
def test_a_wrong_header_is_refused_at_its_place(at: int, value: bytes, verdict: Refusal, detail: int) -> None:
    checked = check_image(patched(small().image(), at, value))
    assert (checked.verdict, checked.detail) == (verdict, detail)


NOWHERE = [
    ("states", "press_surface", 2),
    ("states", "release_surface", 2),
    ("states", "first_transition", 3),
    ("states", "enter_slot", 2),
    ("states", "repeat_slot", 254),
    ("transitions", "target", 2),
    ("transitions", "slot", 2),
    ("surfaces", "velocities_at", 175),
    ("surfaces", "velocities_at", 174),
    ("surfaces", "forces_at", 177),
    ("surfaces", "forces_at", 7168),
    ("vibrations", "slot", 2),
    ("vibrations", "states", 4),
]


@pytest.mark.parametrize(("table", "field", "value"), NOWHERE)
def test_an_index_or_offset_that_leads_nowhere_is_refused_at_its_place(
    table: str, field: str, value: int
) -> None:
    parts = small()
    records = getattr(parts, table)
    records[1] = replace(records[1], **{field: value})
    checked = check_image(parts.image())
    assert (checked.verdict, checked.detail) == (LAYOUT, place(table, 1, field))


@pytest.mark.parametrize(("slot", "field", "value"), [(0, "wave_at", 176), (0, "wave_samples", 1)])
def test_a_sine_has_no_wave(slot: int, field: str, value: int) -> None:
    parts = small()
    parts.slots[slot] = replace(parts.slots[slot], **{field: value})
    assert check_image(parts.image())[:2] == (LAYOUT, place("slots", slot, field))


def test_a_sampled_wave_lies_in_the_image() -> None:
    parts = small()
    whole, first = len(parts.image()), parts.slots[1].wave_at
    for field, value in (("wave_at", 175), ("wave_at", whole), ("wave_samples", 0)):
        parts.slots[1] = replace(small().slots[1], **{field: value})
        assert check_image(parts.image())[:2] == (LAYOUT, place("slots", 1, field))
    parts.slots[1] = replace(small().slots[1], wave_samples=whole - first)
    assert check_image(parts.image()).verdict is Refusal.NONE
    parts.slots[1] = replace(small().slots[1], wave_samples=whole - first + 1)
    assert check_image(parts.image())[:2] == (LAYOUT, place("slots", 1, "wave_at"))


def test_each_field_of_each_record_out_of_its_range_is_refused_at_its_place() -> None:
    image, seen = small().image(), 0
    for table, record in TABLES.items():
        for field, kind in zip(dataclasses.fields(record), record.FORMAT[1:], strict=True):
            limits = record.LIMITS[field.name]
            for value in (limits[0] - 1, limits[1] + 1):
                try:
                    packed = struct.pack("<" + kind, value)
                except struct.error:
                    continue
                at = place(table, 1, field.name)
                assert check_image(patched(image, at, packed))[:2] == (RANGE, at), (table, field.name)
                seen += 1
    assert seen > 30


def test_velocities_must_rise() -> None:
    parts = small()
    at = parts.surfaces[1].velocities_at
    image = parts.image()
    assert check_image(patched(image, at + 2, image[at : at + 2]))[:2] == (RANGE, at + 2)


@pytest.mark.parametrize("force_cN64", [-LIMIT_CN64 - 1, LIMIT_CN64 + 1])
def test_a_force_beyond_the_limit_is_refused_wherever_it_is(force_cN64: int) -> None:
    parts = small()
    image, surface = parts.image(), parts.surfaces[1]
    for node in range(surface.rows * surface.columns):
        at = surface.forces_at + 2 * node
        assert check_image(patched(image, at, struct.pack("<h", force_cN64)))[:2] == (RANGE, at)


@pytest.mark.parametrize("field", ["bias_cN64", "bias_end_cN64"])
@pytest.mark.parametrize("strokes", [(0, 1), (1, 0)])
def test_bias_and_surface_together_must_keep_the_limit(field: str, strokes: tuple[int, int]) -> None:
    parts = small()
    forces = [
        struct.unpack_from(f"<{s.rows * s.columns}h", parts.image(), s.forces_at) for s in parts.surfaces
    ]
    press, release = strokes
    calm = {"bias_cN64": 0, "bias_end_cN64": 0, "press_surface": press, "release_surface": release}
    highest, lowest = max(map(max, forces)), min(map(min, forces))
    for bias, right in (
        (LIMIT_CN64 - highest, True),
        (LIMIT_CN64 - highest + 1, False),
        (-LIMIT_CN64 - lowest, True),
        (-LIMIT_CN64 - lowest - 1, False),
    ):
        parts.states[1] = replace(parts.states[1], **calm | {field: bias})
        checked = check_image(parts.image())
        assert checked[:2] == ((Refusal.NONE, 0) if right else (RANGE, place("states", 1, field)))


def test_a_weaker_rig_refuses_what_a_stronger_one_takes() -> None:
    image = small().image()
    assert check_image(image, Settings(force_limit_cN64=32000)).verdict is Refusal.NONE
    assert check_image(image, Settings(force_limit_cN64=64)).verdict is RANGE


@pytest.mark.parametrize(("slot", "period_ms", "right"), [(NONE, 0, 1), (NONE, 9, 0), (1, 0, 0), (1, 9, 1)])
def test_a_repeated_waveform_has_a_period_and_none_has_none(slot: int, period_ms: int, right: int) -> None:
    parts = small()
    parts.states[1] = replace(parts.states[1], repeat_slot=slot, repeat_ms=period_ms)
    place_of = place("states", 1, "repeat_ms")
    assert check_image(parts.image())[:2] == ((Refusal.NONE, 0) if right else (RANGE, place_of))


OPERANDS = [
    (Condition.HOST_EVENT, -1, False),
    (Condition.HOST_EVENT, 0, True),
    (Condition.HOST_EVENT, 31, True),
    (Condition.HOST_EVENT, 32, False),
    (Condition.AFTER_MS, -1, False),
    (Condition.AFTER_MS, 0, True),
    (Condition.RISEN_BY, -1, False),
    (Condition.FALLEN_BY, -1, False),
    (Condition.SLOWER_THAN, -(2**31), True),
]


@pytest.mark.parametrize(("condition", "value", "right"), OPERANDS)
@pytest.mark.parametrize("fields", [("condition", "value"), ("guard", "guard_value")])
def test_a_condition_needs_an_operand_that_makes_sense(
    fields: tuple[str, str], condition: Condition, value: int, right: bool
) -> None:
    parts = small()
    parts.transitions[1] = replace(parts.transitions[1], **dict(zip(fields, (condition, value), strict=True)))
    refused = RANGE, place("transitions", 1, fields[1])
    assert check_image(parts.image())[:2] == ((Refusal.NONE, 0) if right else refused)


def test_the_board_may_have_less_travel_than_the_protocol_allows() -> None:
    image = small().image(travel_um16=64000)
    assert check_image(image, travel_limit_um16=64000).verdict is Refusal.NONE
    assert check_image(image, travel_limit_um16=63999)[:2] == (RANGE, 8)


@pytest.mark.parametrize("size_bytes", [0, 28, 33, 34, 35, 7172])
def test_a_size_that_no_program_has_is_refused_before_a_byte_is_read(size_bytes: int) -> None:
    checked = check_image(bytes(size_bytes), size_bytes=size_bytes, crc32=0)
    assert checked == (LAYOUT, 12, 1)


def test_a_step_checks_no_more_than_its_budget_and_less_than_64_bytes_beyond() -> None:
    image = random_parts(random.Random(7), dict.fromkeys(TABLES, 16)).image()
    looked = 2 * len(image)  # all but the wave's samples are read twice: summed, then checked
    for step_bytes in (1, 64, 256):
        steps = check_image(image, step_bytes=step_bytes).steps
        assert looked / (step_bytes + 64) / 2 < steps < looked / step_bytes + 8


def test_the_largest_program_is_accepted() -> None:
    parts = small()
    parts.pool += bytes(7168 - len(parts.image()))
    assert len(parts.image()) == 7168
    assert check_image(parts.image()).verdict is Refusal.NONE
    assert zlib.crc32(parts.image()[8:]) == int.from_bytes(parts.image()[4:8], "little")
