"""The core compiled for a Cortex-M and run in an emulator, with the doors of fdvv.firmware.core. Emulated."""

from __future__ import annotations

import re
import shutil
import struct
import subprocess
from importlib import import_module
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

from fdvv.firmware.core import INPUTS, OUTPUTS, RecordArray
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import BoardLimits, Settings
from tests.firmware._m0 import BOARD, REPOSITORY, SHARED, require_tools

HERE = Path(__file__).resolve().parent
CORE = REPOSITORY / "firmware" / "core"
FORCE_LOOP = REPOSITORY / "firmware" / "force_loop"
FLAGS = ("-mthumb", "-std=c11", "-ffreestanding", "-fno-strict-aliasing")
LIMITS = ("-fno-tree-loop-distribute-patterns", "-ffunction-sections", "-nostdlib", "-Wl,--gc-sections")
FLASH, RAM, RETURN, SIZE = 0x2000, 0x20000000, 0x1000, 0x40000


class Processor(NamedTuple):
    """What differs between two of them.

    flags : of the compiler. folders : of the sources. model : its name in the emulator.
    """

    flags: tuple[str, ...]
    folders: tuple[Path, ...]
    model: str


M0 = Processor(("-mcpu=cortex-m0plus",), (CORE,), "UC_CPU_ARM_CORTEX_M0")
# -ffp-contract=off: a fused multiplication and addition round once instead of twice
M4 = Processor(
    (
        *("-mcpu=cortex-m4", "-mfpu=fpv4-sp-d16", "-mfloat-abi=hard", "--specs=picolibc.specs"),
        *("-ffp-contract=off", "-DFDVV_FORCE_LOOP", "-Wdouble-promotion", "-Werror"),
    ),
    (CORE, FORCE_LOOP),
    "UC_CPU_ARM_CORTEX_M4",
)


def board_flags() -> str:
    """Return the flags with which the board's Makefile compiles the tick."""
    found = re.search(r"^TICK_FLAGS := (.+)$", (BOARD / "Makefile").read_text(), re.MULTILINE)
    assert found is not None
    return found[1]


def compile_core(folder: Path, optimise: str, processor: Processor = M0) -> bytes:
    """Return the bytes of the program from FLASH on; core.elf is left in the folder."""
    require_tools()
    elf, binary = folder / "core.elf", folder / "core.bin"
    gcc = ["arm-none-eabi-gcc", *FLAGS, *processor.flags, *LIMITS]
    # apart, as on the board: link-time optimisation loses functions that the compiler itself calls
    memory = folder / "memory.o"
    subprocess.run([*gcc, "-Os", "-c", SHARED / "memory.c", "-o", memory], check=True)
    found = [path for place in processor.folders for path in sorted(place.glob("*.c"))]
    command: list[str | Path] = [*gcc, *optimise.split(), *(f"-I{place}" for place in processor.folders)]
    command += ["-T", HERE / "_core_on_arm.ld", "-Wl,-e0x2000", HERE / "_core_on_arm.c", memory, *found]
    subprocess.run([*command, "-lgcc", "-o", elf], check=True)
    objcopy = shutil.which("arm-none-eabi-objcopy") or "arm-none-eabi-objcopy"
    subprocess.run([objcopy, "-O", "binary", elf, binary], check=True)
    return binary.read_bytes()


class CoreOnArm:
    """One device's core on an emulated Cortex-M, armed with a program as Core.arm leaves it."""

    def __init__(
        self,
        code: bytes,
        settings: Settings,
        image: bytes,
        processor: Processor = M0,
        limits: BoardLimits | None = None,
    ) -> None:
        self._unicorn: Any = import_module("unicorn")
        self._arm: Any = import_module("unicorn.arm_const")
        self._uc: Any = self._unicorn.Uc(
            self._unicorn.UC_ARCH_ARM, self._unicorn.UC_MODE_THUMB | self._unicorn.UC_MODE_MCLASS
        )
        self._uc.ctl_set_cpu_model(getattr(self._arm, processor.model))
        self._uc.mem_map(0, SIZE)
        self._uc.mem_map(RAM, 0x8000)
        self._uc.mem_write(FLASH, code)
        self.ticks, *places = struct.unpack("<13I", code[:52])
        self._data, self._functions = places[:5], places[5:10]
        self._loop = places[10:]  # where the table has it
        self._uc.mem_write(self._data[0], settings.pack())
        self._uc.mem_write(self._data[4], (limits or limits_like(settings)).pack())
        self._uc.mem_write(self._data[1], image)
        self._call(self._functions[0])
        self.refusal = self._call(self._functions[1], len(image), int.from_bytes(image[4:8], "little"))

    def _call(self, place: int, *arguments: int) -> int:
        self._uc.reg_write(self._arm.UC_ARM_REG_SP, RAM + 0x7FF0)
        self._uc.reg_write(self._arm.UC_ARM_REG_LR, RETURN | 1)
        for k, value in enumerate(arguments):
            self._uc.reg_write(self._arm.UC_ARM_REG_R0 + k, value)
        self._uc.emu_start(place | 1, RETURN)
        return int(self._uc.reg_read(self._arm.UC_ARM_REG_R0))

    def event(self, event: int) -> None:
        """Send host event 0 to 31 to the program."""
        self._call(self._functions[2], event)

    def announce(self, velocity_mm_s16: int) -> None:
        """Say how fast the next press is meant to be."""
        self._call(self._functions[3], velocity_mm_s16)

    def close_loop(self, constants: npt.NDArray[np.float32]) -> None:
        """Close the force loop with ForceLoopGains.pack(), on a processor with FORCE_LOOP."""
        gains, close = self._loop
        self._uc.mem_write(gains, constants.astype("<f4").tobytes())
        self._call(close)

    def run(self, inputs: RecordArray) -> RecordArray:
        """Run a tick per record, the host heard before each."""
        parts = []
        for start in range(0, inputs.size, self.ticks):
            part = np.ascontiguousarray(inputs[start : start + self.ticks], INPUTS)
            self._uc.mem_write(self._data[2], part.tobytes())
            self._call(self._functions[4], part.size)
            given = self._uc.mem_read(self._data[3], part.size * OUTPUTS.itemsize)
            parts.append(np.frombuffer(bytes(given), OUTPUTS))
        return np.concatenate(parts)
