"""The image check, called from Python."""

from __future__ import annotations

import ctypes
from typing import NamedTuple

from fdvv.protocol.tables import Refusal, Settings
from tests.safety._build import safety_library


class Checked(NamedTuple):
    """How a check ended: verdict, offset where it failed, steps it took."""

    verdict: Refusal
    detail: int
    steps: int


def check_image(
    image: bytes,
    settings: Settings | None = None,
    *,
    size_bytes: int | None = None,
    crc32: int | None = None,
    step_bytes: int = 256,
    travel_limit_um16: int = 0,
) -> Checked:
    """Check an image announced with this size and checksum (None: its own); 0: no limit of travel."""
    steps, detail = ctypes.c_int(), ctypes.c_int()
    verdict = safety_library().safety_check(
        image,
        ctypes.c_int(len(image) if size_bytes is None else size_bytes),
        ctypes.c_uint32(int.from_bytes(image[4:8], "little") if crc32 is None else crc32),
        (Settings() if settings is None else settings).pack(),
        ctypes.c_int(step_bytes),
        ctypes.c_int32(travel_limit_um16),
        ctypes.byref(steps),
        ctypes.byref(detail),
    )
    return Checked(Refusal(verdict), detail.value, steps.value)


def fuzz(images: list[bytes], seed: int, count: int) -> dict[Refusal, int]:
    """Check this many mutated images, walk through those that are accepted; count the verdicts."""
    verdicts = (ctypes.c_int * len(Refusal))()
    safety_library().safety_fuzz(
        b"".join(images),
        (ctypes.c_int * len(images))(*map(len, images)),
        ctypes.c_int(len(images)),
        Settings().pack(),
        ctypes.c_uint32(seed),
        ctypes.c_int(count),
        verdicts,
    )
    return {refusal: verdicts[refusal] for refusal in Refusal if verdicts[refusal]}
