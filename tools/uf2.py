"""Wrap a program's bytes in UF2 blocks, which a bootloader's USB disk takes."""

from __future__ import annotations

import argparse
import struct
from pathlib import Path

MAGICS = (0x0A324655, 0x9E5D5157, 0x0AB16F30)
FAMILY_PRESENT = 0x2000
PAYLOAD_BYTES = 256


def uf2_blocks(program: bytes, family: int, start: int) -> bytes:
    """Return the UF2 file of a program that lies at `start`: 512-byte blocks with 256 bytes each."""
    pages = [program[at : at + PAYLOAD_BYTES] for at in range(0, len(program), PAYLOAD_BYTES)]
    return b"".join(
        struct.pack(
            "<8I",
            *MAGICS[:2],
            FAMILY_PRESENT,
            start + i * PAYLOAD_BYTES,
            PAYLOAD_BYTES,
            i,
            len(pages),
            family,
        )
        + page.ljust(476, b"\0")
        + struct.pack("<I", MAGICS[2])
        for i, page in enumerate(pages)
    )


def main() -> None:
    """Read the program and write its blocks."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("output", type=Path)
    parser.add_argument("--family", type=lambda text: int(text, 0), required=True)
    parser.add_argument("--start", type=lambda text: int(text, 0), required=True)
    choices = parser.parse_args()
    choices.output.write_bytes(uf2_blocks(choices.program.read_bytes(), choices.family, choices.start))


if __name__ == "__main__":
    main()
