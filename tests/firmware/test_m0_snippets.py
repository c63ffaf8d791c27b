"""Small programs run by the emulator itself: counted cycles, refused programs, missing clocks."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from fdvv.errors import DeviceError, InputError
from fdvv_m0.elf import read_elf
from fdvv_m0.emulator import M0Emulator
from fdvv_m0.records import TickInputs, TickOutputs

pytest.importorskip("unicorn")

START = 0x2000
STACK = 0x20008000


def write_elf(path: Path, code: list[int], machine: int = 40) -> Path:
    """Write an ELF file with a vector table and code behind it, which begins at START + 16."""
    program = struct.pack("<4I", STACK, START + 17, 0, 0) + struct.pack(f"<{len(code)}H", *code)
    head = b"\x7fELF\x01\x01\x01" + bytes(9)
    head += struct.pack("<HHIIIIIHHHHHH", 2, machine, 1, START + 17, 52, 0, 0, 52, 32, 1, 40, 0, 0)
    part = struct.pack("<8I", 1, 84, START, START, len(program), len(program), 5, 4)
    path.write_bytes(head + part + program)
    return path


def no_world(outputs: TickOutputs) -> TickInputs:
    raise AssertionError("no tick is set up")


def test_a_nested_loop_takes_its_cycles_to_the_exact_one(tmp_path: Path) -> None:
    code = [
        0x2164,  # movs r1, #100
        0x2032,  # 1: movs r0, #50
        0x3801,  # 2: subs r0, #1
        0xD1FD,  # bne 2b
        0x3901,  # subs r1, #1
        0xD1FA,  # bne 1b
        0x2201,  # movs r2, #1
        0xE7FE,  # b .
    ]
    inner = 50 * 2 + 49 * 1  # subs and bne, one more for each taken
    total = 1 + 100 * (1 + inner + 2) + 99 * 1 + 2  # and two lines fetched
    emulator = M0Emulator(write_elf(tmp_path / "a.elf", code), no_world)
    for duration_cycles, is_done in ((total - 2, 0), (total + 3, 1)):
        emulator.reset()
        start = emulator.time_us
        emulator.run_us(duration_cycles / 48)
        assert emulator.processor.register(2) == is_done, emulator.time_us - start


def test_a_peripheral_without_its_bus_clock_is_reported(tmp_path: Path) -> None:
    code = [0x4801, 0x6001, 0xE7FE, 0x0000, 0x2040, 0x4200]  # ldr r0, =0x42002040; str r1, [r0]; b .
    emulator = M0Emulator(write_elf(tmp_path / "a.elf", code), no_world)
    with pytest.raises(DeviceError, match=r"0x42002040 used without its bus clock"):
        emulator.run_us(10)


def test_a_dfll_set_up_in_the_wrong_order_is_reported(tmp_path: Path) -> None:
    code = [0x4801, 0x6001, 0xE7FE, 0x0000, 0x082C, 0x4000]  # DFLLMUL before DFLLCTRL.ENABLE
    emulator = M0Emulator(write_elf(tmp_path / "a.elf", code), no_world)
    with pytest.raises(DeviceError, match="erratum 9905"):
        emulator.run_us(10)


def test_the_loop_of_a_program_without_ticks_is_named(tmp_path: Path) -> None:
    emulator = M0Emulator(write_elf(tmp_path / "a.elf", [0xE7FE]), no_world)
    with pytest.raises(DeviceError, match="come to no tick; it is at 0x2010"):
        emulator.run_ticks(1)


def test_an_access_to_nowhere_is_reported(tmp_path: Path) -> None:
    emulator = M0Emulator(write_elf(tmp_path / "a.elf", [0x2080, 0x0600, 0x6801, 0xE7FE]), no_world)
    with pytest.raises(DeviceError, match=r"fails at 0x2014"):
        emulator.run_us(10)


@pytest.mark.parametrize(
    ("data", "reason"),
    [
        (b"", "not an ELF"),
        (b"\x7fELF\x01\x01" + bytes(46), "not an ELF"),
        (b"UF2\n" + bytes(508), "not an ELF"),
    ],
)
def test_what_is_no_arm_program_is_refused(tmp_path: Path, data: bytes, reason: str) -> None:
    path = tmp_path / "a.elf"
    path.write_bytes(data)
    with pytest.raises(InputError, match=reason):
        read_elf(path)


def test_a_truncated_or_missing_elf_is_refused(tmp_path: Path) -> None:
    path = write_elf(tmp_path / "a.elf", [0xE7FE])
    path.write_bytes(path.read_bytes()[:60])
    with pytest.raises(InputError, match="truncated"):
        read_elf(path)
    with pytest.raises(InputError, match="make firmware"):
        read_elf(tmp_path / "none.elf")
    with pytest.raises(InputError, match="not an ELF"):
        read_elf(write_elf(path, [0xE7FE], machine=62))
