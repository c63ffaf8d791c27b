"""What does a tick of the core cost a Cortex-M0+? Emulated, in cycles of its instruction table.

``python -m benchmarks.core_cost`` needs arm-none-eabi-gcc and unicorn. Loads and stores cost 2 cycles, flash
has no wait states; the whole board with its flash is the business of the board's own emulator.
"""

from __future__ import annotations

import shutil
import struct
import subprocess
import sys
import tempfile
from importlib import import_module
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.core import Core, RecordArray
from fdvv.protocol import Settings
from fdvv.testing import random_image, random_inputs, random_settings

CORE = Path(__file__).resolve().parents[1] / "firmware" / "core"
FLAGS = ["-mcpu=cortex-m0plus", "-mthumb", "-std=c99", "-ffreestanding", "-nostdlib", "-nostartfiles"]
STUBS = """
#include "core.h"
#include <stddef.h>
void *memcpy(void *to, const void *from, size_t n)
{ char *a = to; const char *b = from; while (n--) *a++ = *b++; return to; }
void *memset(void *to, int value, size_t n)
{ char *a = to; while (n--) *a++ = value; return to; }
static void ask(fdvv_core *core, uint8_t what)
{ fdvv_supervisor_ask(&core->supervisor, &core->settings, what, 0); }
void arm(fdvv_core *core) { ask(core, FDVV_ASK_BOOTED); ask(core, FDVV_ASK_ARM); }
void hear(fdvv_core *core, uint32_t time_us) { fdvv_supervisor_host_seen(&core->supervisor, time_us); }
"""
ENTRIES = ("fdvv_core_init", "fdvv_core_activate", "arm", "hear")
FLASH, RAM, RETURN = 0x2000, 0x20000000, 0x1000
CORE_AT, IMAGE_AT, INPUTS_AT = RAM, RAM + 0x2000, RAM + 0x4000
OUTPUTS_AT, SETTINGS_AT = RAM + 0x4100, RAM + 0x4200


def build(folder: Path, optimise: str) -> tuple[bytes, dict[str, int]]:
    """Compile the core and give its bytes from FLASH on, and where its functions are."""
    (folder / "stubs.c").write_text(STUBS)
    elf, binary = folder / "core.elf", folder / "core.bin"
    sources = [str(folder / "stubs.c"), *map(str, sorted(CORE.glob("*.c")))]
    extra = ["-fno-tree-loop-distribute-patterns", f"-I{CORE}", "-ffunction-sections", "-Wl,--gc-sections"]
    extra += [f"-Wl,-Ttext={FLASH:#x}", "-Wl,--entry=fdvv_core_tick", *(f"-Wl,-u,{name}" for name in ENTRIES)]
    subprocess.run(
        ["arm-none-eabi-gcc", optimise, *FLAGS, *extra, *sources, "-lgcc", "-o", str(elf)], check=True
    )
    subprocess.run(["arm-none-eabi-objcopy", "-O", "binary", str(elf), str(binary)], check=True)
    names = subprocess.run(["arm-none-eabi-nm", str(elf)], check=True, capture_output=True, text=True).stdout
    places = {
        line.split()[2]: int(line.split()[0], 16) for line in names.splitlines() if " T " in line.upper()
    }
    return binary.read_bytes(), places


def cost_of(first: int) -> tuple[int, int]:
    """Cycles of an instruction by its first halfword, and how many more if it branches."""
    top = first >> 11
    if top in (0b01001, 0b10010, 0b10011) or first >> 12 in (0b0101, 0b0110, 0b0111, 0b1000):
        return 2, 0
    if first >> 12 == 0b1100 or first & 0xF600 == 0xB400:
        many = bin(first & 0xFF).count("1") + (first >> 8 & 1 if first >> 12 == 0b1011 else 0)
        return 1 + many, 2
    if first & 0xF800 == 0xF000:
        return 2, 1
    return 1, 1


class Machine:
    """The core on an emulated Cortex-M0+."""

    def __init__(self, code: bytes, places: dict[str, int], settings: Settings, image: bytes) -> None:
        unicorn: Any = import_module("unicorn")
        self.arm: Any = import_module("unicorn.arm_const")
        self.places, self.code, self.cycles, self.last = places, code, 0, 0
        self.uc = unicorn.Uc(unicorn.UC_ARCH_ARM, unicorn.UC_MODE_THUMB | unicorn.UC_MODE_MCLASS)
        self.uc.ctl_set_cpu_model(self.arm.UC_CPU_ARM_CORTEX_M0)
        self.uc.mem_map(0, 0x20000)
        self.uc.mem_map(RAM, 0x8000)
        self.uc.mem_write(FLASH, code)
        self.uc.mem_write(IMAGE_AT, image)
        self.uc.mem_write(SETTINGS_AT, settings.pack())
        self.halves = struct.unpack(f"<{len(code) // 2}H", code[: len(code) // 2 * 2])
        self.after, self.extra = 0, 0
        self.uc.hook_add(unicorn.UC_HOOK_CODE, self._count)
        self.uc.ctl_flush_tb()
        self.call("fdvv_core_init", CORE_AT, SETTINGS_AT)
        self.call("fdvv_core_activate", CORE_AT, IMAGE_AT)
        self.call("arm", CORE_AT)

    def _count(self, _uc: object, address: int, size: int, _data: object) -> None:
        if address == RETURN:
            return
        if address != self.after:
            self.cycles += self.extra
        plain, self.extra = cost_of(self.halves[(address - FLASH) // 2])
        self.cycles += plain
        self.after = address + size

    def call(self, name: str, *arguments: int) -> int:
        """Call a function and give the cycles it took."""
        self.cycles, self.extra = 0, 0
        self.uc.reg_write(self.arm.UC_ARM_REG_SP, RAM + 0x7FF0)
        self.uc.reg_write(self.arm.UC_ARM_REG_LR, RETURN | 1)
        for k, value in enumerate(arguments):
            self.uc.reg_write(self.arm.UC_ARM_REG_R0 + k, value)
        self.uc.emu_start(self.places[name] | 1, RETURN)
        return self.cycles + self.extra

    def tick(self, inputs: bytes) -> tuple[int, bytes]:
        """Run a tick; give its cycles and its outputs."""
        self.uc.mem_write(INPUTS_AT, inputs)
        self.call("hear", CORE_AT, int.from_bytes(inputs[:4], "little"))
        cycles = self.call("fdvv_core_tick", CORE_AT, INPUTS_AT, OUTPUTS_AT)
        return cycles, bytes(self.uc.mem_read(OUTPUTS_AT, 20))


def measure(machine: Machine, core: Core, inputs: RecordArray) -> list[int]:
    """Give the cycles of every tick; the outputs must be those of this machine's own core."""
    core.arm()
    cycles = []
    for given, wanted in zip(inputs, core.run(inputs), strict=True):
        took, outputs = machine.tick(given.tobytes())
        assert outputs == wanted.tobytes(), "the emulated core and this machine's differ"
        cycles.append(took)
    return cycles


def main(cases: int = 12, ticks: int = 150) -> None:
    if not shutil.which("arm-none-eabi-gcc"):
        sys.exit("core_cost needs arm-none-eabi-gcc")
    with tempfile.TemporaryDirectory() as folder:
        for optimise in ("-Os", "-O2"):
            code, places = build(Path(folder), optimise)
            found: list[int] = []
            for seed in range(cases):
                rng = np.random.default_rng(seed)
                settings = random_settings(rng)
                image, inputs = random_image(rng, settings), random_inputs(rng, ticks, settings)
                machine = Machine(code, places, settings, image)
                took = measure(machine, Core(settings, image), inputs)
                print(f"  seed {seed}: median {np.median(took):.0f}, worst {max(took)}")
                found += took
            print(
                f"core, emulated, {optimise}: {len(code)} bytes, {len(found)} random ticks: "
                f"median {np.median(found):.0f}, worst {max(found)} cycles"
            )


if __name__ == "__main__":
    main()
