"""The file for the bootloader's disk holds the program, each block in its place."""

from __future__ import annotations

import struct

from hypothesis import given
from hypothesis import strategies as st
from tools.uf2 import uf2_blocks


@given(st.binary(min_size=1, max_size=2000), st.integers(0, 255).map(lambda page: 256 * page))
def test_the_blocks_put_together_are_the_program(program: bytes, start: int) -> None:
    file = uf2_blocks(program, 0x68ED2B88, start)
    flash = bytearray()
    for at in range(0, len(file), 512):
        first, second, flags, address, size, number, count, family = struct.unpack_from("<8I", file, at)
        assert (first, second) == (0x0A324655, 0x9E5D5157)
        assert file[at + 508 : at + 512] == struct.pack("<I", 0x0AB16F30)
        assert (flags, family, size, count) == (0x2000, 0x68ED2B88, 256, len(file) // 512)
        assert (address, number) == (start + len(flash), at // 512)
        flash += file[at + 32 : at + 32 + size]
    assert flash[: len(program)] == program
    assert not any(flash[len(program) :])
