"""Counts per unit, and what every image of a program has in the same place."""

from __future__ import annotations

import zlib

from fdvv.protocol._tables import ImageHeader

UM16_PER_mm = 16_000
"""Counts of displacement: um16."""
CN64_PER_cN = 64
"""Counts of force: cN64."""
MM_S16_PER_mm_s = 16
"""Counts of velocity: mm_s16."""

CHECKED_FROM = 8
"""The checksum covers what follows magic and checksum."""


def head_of(image: bytes) -> ImageHeader:
    """Read the header of an image; ModelError if it is shorter or its fields are out of range."""
    return ImageHeader.unpack(image[: ImageHeader.length_bytes()])


def travel_mm_of(image: bytes) -> float:
    """Tell where a program's bottom stop is set; ModelError as head_of."""
    return head_of(image).travel_um16 / UM16_PER_mm


def checksum_of(image: bytes) -> int:
    """Compute the checksum that an image should carry."""
    return zlib.crc32(image[CHECKED_FROM:])


def seal(image: bytes) -> bytes:
    """Put the checksum of an image in its place."""
    return image[:4] + checksum_of(image).to_bytes(4, "little") + image[CHECKED_FROM:]
