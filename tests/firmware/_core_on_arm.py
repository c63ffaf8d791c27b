"""The core compiled for the Cortex-M0+ and run in an emulator, with the doors of fdvv.core. Emulated."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.firmware.core import INPUTS, OUTPUTS, RecordArray
from fdvv.protocol.tables import Settings

from ._m0 import BOARD, REPOSITORY, require_tools

HERE = Path(__file__).resolve().parent
CORE = REPOSITORY / "firmware" / "core"
FLAGS = ("-mcpu=cortex-m0plus", "-mthumb", "-std=c11", "-ffreestanding", "-fno-strict-aliasing")
LIMITS = ("-fno-tree-loop-distribute-patterns", "-ffunction-sections", "-nostdlib", "-Wl,--gc-sections")
FLASH, RAM, RETURN, SIZE = 0x2000, 0x20000000, 0x1000, 0x40000


def board_flags() -> str:
    """Return the flags with which the board's Makefile compiles the tick."""
    found = re.search(r"^TICK_FLAGS := (.+)$", (BOARD / "Makefile").read_text(), re.MULTILINE)
    assert found is not None
    return found[1]


def compile_core(folder: Path, optimise: str) -> bytes:
    """Return the program's bytes from FLASH on."""
    require_tools()
    elf, binary = folder / "core.elf", folder / "core.bin"
    # apart, as on the board: link-time optimisation loses functions that the compiler itself calls
    memory = folder / "memory.o"
    subprocess.run(
        ["arm-none-eabi-gcc", *FLAGS, *LIMITS, "-Os", "-c", BOARD / "memory.c", "-o", memory], check=True
    )
    sources = [HERE / "_core_on_arm.c", memory, *sorted(CORE.glob("*.c"))]
    command: list[str | Path] = ["arm-none-eabi-gcc", *FLAGS, *LIMITS, *optimise.split(), f"-I{CORE}"]
    command += ["-T", HERE / "_core_on_arm.ld", "-Wl,-e0x2000", *sources, "-lgcc", "-o", elf]
    subprocess.run(command, check=True)
    objcopy = shutil.which("arm-none-eabi-objcopy") or "arm-none-eabi-objcopy"
    subprocess.run([objcopy, "-O", "binary", elf, binary], check=True)
    return binary.read_bytes()


class CoreOnM0:
    """One device's core on an emulated Cortex-M0+, armed with a program as Core.arm leaves it."""

    def __init__(self, code: bytes, settings: Settings, image: bytes) -> None:
        unicorn: Any = import_module("unicorn")
        self._arm: Any = import_module("unicorn.arm_const")
        self._uc = unicorn.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS)
        self._uc.ctl_set_cpu_model(self._arm.UC_CPU_ARM_CORTEX_M0)
        self._uc.mem_map(0, SIZE)
        self._uc.mem_map(RAM, 0x8000)
        self._uc.mem_write(FLASH, code)
        self.ticks, *places = struct.unpack("<10I", code[:40])
        self._data, self._functions = places[:4], places[4:]
        self._uc.mem_write(self._data[0], settings.pack())
        self._uc.mem_write(self._data[1], image)
        self._call(0)
        self.refusal = self._call(1, len(image), int.from_bytes(image[4:8], "little"))

    def _call(self, function: int, *arguments: int) -> int:
        self._uc.reg_write(self._arm.UC_ARM_REG_SP, RAM + 0x7FF0)
        self._uc.reg_write(self._arm.UC_ARM_REG_LR, RETURN | 1)
        for k, value in enumerate(arguments):
            self._uc.reg_write(self._arm.UC_ARM_REG_R0 + k, value)
        self._uc.emu_start(self._functions[function] | 1, RETURN)
        return int(self._uc.reg_read(self._arm.UC_ARM_REG_R0))

    def event(self, event: int) -> None:
        """Send host event 0 to 31 to the program."""
        self._call(2, event)

    def announce(self, velocity_mm_s16: int) -> None:
        """Say how fast the next press is meant to be."""
        self._call(3, velocity_mm_s16)

    def run(self, inputs: RecordArray) -> RecordArray:
        """Run a tick per record, the host heard before each."""
        parts = []
        for start in range(0, inputs.size, self.ticks):
            part = np.ascontiguousarray(inputs[start : start + self.ticks], INPUTS)
            self._uc.mem_write(self._data[2], part.tobytes())
            self._call(4, part.size)
            given = self._uc.mem_read(self._data[3], part.size * OUTPUTS.itemsize)
            parts.append(np.frombuffer(bytes(given), OUTPUTS))
        return np.concatenate(parts)
