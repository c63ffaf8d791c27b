"""What the image check accepts, what it refuses and where, and that it reads nothing outside the image."""

from __future__ import annotations

import random

import pytest
from tests.safety._checking import check_image, fuzz
from tests.safety._images import random_parts, sealed

from fdvv.protocol import Refusal


def images(seed: int, count: int) -> list[bytes]:
    rng = random.Random(seed)
    return [random_parts(rng).image() for _ in range(count)]


@pytest.mark.parametrize("step_bytes", [0, 1, 64, 256, 65535])
def test_right_programs_are_accepted_in_steps_of_any_size(step_bytes: int) -> None:
    for image in images(step_bytes, 40):
        assert check_image(image, step_bytes=step_bytes).verdict is Refusal.NONE


def test_a_flipped_bit_anywhere_is_found() -> None:
    image = images(1, 1)[0]
    for bit in range(8 * len(image)):
        flipped = bytearray(image)
        flipped[bit // 8] ^= 1 << bit % 8
        verdict = check_image(bytes(flipped), crc32=int.from_bytes(image[4:8], "little")).verdict
        assert verdict in (Refusal.CHECKSUM, Refusal.IMAGE_LAYOUT)


def test_the_program_announced_is_the_one_that_must_be_there() -> None:
    image = images(2, 1)[0]
    other = sealed(image[:-1] + bytes([image[-1] ^ 1]))
    assert check_image(other, crc32=int.from_bytes(image[4:8], "little")).verdict is Refusal.CHECKSUM


def test_no_mutated_image_is_read_beyond_its_end() -> None:
    # the walk through accepted ones would fail; test_sanitised.py runs this with the address sanitiser
    verdicts = fuzz(images(3, 60), seed=4, count=20_000)
    assert sum(verdicts.values()) == 20_000
    assert set(verdicts) == {
        Refusal.NONE,
        Refusal.CHECKSUM,
        Refusal.IMAGE_LAYOUT,
        Refusal.IMAGE_RANGE,
    }
    assert min(verdicts.values()) > 500
