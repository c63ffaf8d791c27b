"""What does a tick of the core cost a Cortex-M0+? Emulated, in cycles of its instruction table.

``python -m benchmarks.core_cost`` needs arm-none-eabi-gcc and unicorn. Loads and stores cost 2 cycles; each
figure is given without wait states and with those of the board's flash behind its cache. Half of the random
rigs are the dearest that the settings allow. The whole board is the business of ``python -m benchmarks.m0``.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from dataclasses import replace
from pathlib import Path

import numpy as np

from fdvv.firmware.core import Core, RecordArray
from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import NONE, Condition, Settings, Slot, State, Transition, Vibration
from fdvv_m0.bus import Bus
from fdvv_m0.processor import Processor
from tests.support.random_presses import random_inputs, random_settings
from tests.support.random_programs import (
    assemble,
    random_image,
    random_state,
    random_vibration,
    random_waveform,
)

FIRMWARE = Path(__file__).resolve().parents[1] / "firmware"
CORE = FIRMWARE / "core"
FLAGS = ["-mcpu=cortex-m0plus", "-mthumb", "-std=c99", "-ffreestanding", "-nostdlib", "-nostartfiles"]
FLAGS += ["-DFDVV_NO_THERMISTOR"]  # as the board's Makefile, for the rig that it is shipped for
STUBS = """
#include "core.h"
#include <stddef.h>
__attribute__((used)) void *memcpy(void *to, const void *from, size_t n)
{ char *a = to; const char *b = from; while (n--) *a++ = *b++; return to; }
__attribute__((used)) void *memset(void *to, int value, size_t n)
{ char *a = to; while (n--) *a++ = value; return to; }
static void ask(fdvv_core *core, uint8_t what)
{ fdvv_supervisor_ask(&core->supervisor, &core->settings, what, 0); }
void arm(fdvv_core *core) { ask(core, FDVV_ASK_BOOTED); ask(core, FDVV_ASK_ARM); }
void hear(fdvv_core *core, uint32_t time_us) { fdvv_supervisor_host_seen(&core->supervisor, time_us); }
"""
ENTRIES = ("fdvv_core_init", "fdvv_core_activate", "arm", "hear")
FLASH, RAM, RETURN = 0x2000, 0x20000000, 0x1000
CACHED, NO_WAIT = 1, 2
CORE_AT, IMAGE_AT, INPUTS_AT = RAM, RAM + 0x2000, RAM + 0x4000
OUTPUTS_AT, SETTINGS_AT, LIMITS_AT = RAM + 0x4100, RAM + 0x4200, RAM + 0x4300
TICKS_us = (100, 1000)
"""What a timer of 16 bits at 48 MHz counts, and the processor has time for."""


def board_flags() -> str:
    """Return what the board's Makefile compiles the tick with."""
    text = (FIRMWARE / "boards" / "itsybitsy_m0" / "Makefile").read_text()
    found = re.search(r"^TICK_FLAGS := (.+)$", text, re.MULTILINE)
    assert found is not None
    return found[1]


def build(folder: Path, optimise: str) -> tuple[bytes, dict[str, int]]:
    """Compile the core and give its bytes from FLASH on, and where its functions are."""
    (folder / "stubs.c").write_text(STUBS)
    elf, binary = folder / "core.elf", folder / "core.bin"
    sources = [str(folder / "stubs.c"), *map(str, sorted(CORE.glob("*.c")))]
    extra = ["-fno-tree-loop-distribute-patterns", f"-I{CORE}", "-ffunction-sections", "-Wl,--gc-sections"]
    extra += [f"-Wl,-Ttext={FLASH:#x}", "-Wl,--entry=fdvv_core_tick", *(f"-Wl,-u,{name}" for name in ENTRIES)]
    subprocess.run(
        ["arm-none-eabi-gcc", *optimise.split(), *FLAGS, *extra, *sources, "-lgcc", "-o", str(elf)],
        check=True,
    )
    subprocess.run(["arm-none-eabi-objcopy", "-O", "binary", str(elf), str(binary)], check=True)
    names = subprocess.run(["arm-none-eabi-nm", str(elf)], check=True, capture_output=True, text=True).stdout
    places = {
        line.split()[2]: int(line.split()[0], 16) for line in names.splitlines() if " T " in line.upper()
    }
    return binary.read_bytes(), places


class Machine(Processor):
    """The core on an emulated Cortex-M0+, its flash CACHED or with NO_WAIT."""

    def __init__(
        self, code: bytes, places: dict[str, int], settings: Settings, image: bytes, waits: int = NO_WAIT
    ) -> None:
        bus = Bus(is_cached=True, bus_wait_cycles=0)
        bus.clockwork.is_cached = waits
        bus.flash[FLASH : FLASH + len(code)] = code
        super().__init__(bus)
        self.places = places
        self._uc.mem_write(IMAGE_AT, image)
        self._uc.mem_write(SETTINGS_AT, settings.pack())
        self._uc.mem_write(LIMITS_AT, limits_like(settings).pack())
        self.call("fdvv_core_init", CORE_AT, SETTINGS_AT, LIMITS_AT)
        self.call("fdvv_core_activate", CORE_AT, IMAGE_AT)
        self.call("arm", CORE_AT)

    def call(self, name: str, *arguments: int) -> int:
        """Call a function and give the cycles it took."""
        before = self._bus.cycles
        self.set_stack(RAM + 0x7FF0)
        self._uc.reg_write(self._arm.UC_ARM_REG_LR, RETURN | 1)
        for k, value in enumerate(arguments):
            self._uc.reg_write(self._arm.UC_ARM_REG_R0 + k, value)
        self._uc.emu_start(self.places[name] | 1, RETURN)
        return self._bus.cycles - before

    def tick(self, inputs: bytes) -> tuple[int, bytes]:
        """Run a tick; give its cycles and its outputs."""
        self._uc.mem_write(INPUTS_AT, inputs)
        self.call("hear", CORE_AT, int.from_bytes(inputs[:4], "little"))
        cycles = self.call("fdvv_core_tick", CORE_AT, INPUTS_AT, OUTPUTS_AT)
        return cycles, bytes(self._uc.mem_read(OUTPUTS_AT, 20))


def measure(machine: Machine, core: Core, inputs: RecordArray) -> list[int]:
    """Return the cycles of every tick; the outputs must be those of this machine's own core."""
    core.arm()
    cycles = []
    for given, wanted in zip(inputs, core.run(inputs), strict=True):
        took, outputs = machine.tick(given.tobytes())
        assert outputs == wanted.tobytes(), "the emulated core and this machine's differ"
        cycles.append(took)
    return cycles


def dearest(settings: Settings) -> Settings:
    """Let every part of a tick that settings can make dearer be so."""
    return replace(
        settings, fewest_samples=16, sliding_ticks=32, force_gain_q14=settings.force_gain_q14 or 4000
    )


def looking_ahead(settings: Settings, ahead: bool) -> Settings:
    """Turn the predictor on or off."""
    return replace(settings, predictor_q16=(settings.predictor_q16 or 6000) if ahead else 0)


def full_image(transitions: int, vibrations: int, settings: Settings) -> bytes:
    """Return a program of one state with so many transitions that never hold, and vibrations."""
    rng, most_cN64 = np.random.default_rng(0), settings.force_limit_cN64 // 2
    state: State = replace(random_state(rng, 1, 1, most_cN64, 0, transitions), fade_ms=2000, bias_ms=60000)
    never = Transition(
        condition=Condition.DEEPER_THAN, guard=0, target=0, slot=NONE, value=2**31 - 1, guard_value=0
    )
    behind: list[State | Transition | Vibration | Slot] = [
        random_vibration(rng, 1, 1) for _ in range(vibrations)
    ]
    behind.append(random_waveform(rng))
    counts = (1, transitions, 1, vibrations, 1)
    return assemble(rng, [state, *[never] * transitions], behind, counts, most_cN64)


def random_cycles(
    built: tuple[bytes, dict[str, int]], cases: int, ticks: int, waits: int = NO_WAIT, ahead: bool = True
) -> list[int]:
    """Return the cycles of ticks of random rigs and programs, every other rig the dearest of its kind.

    ahead : the controller looks ahead.
    """
    found = []
    for seed in range(cases):
        rng = np.random.default_rng(seed)
        settings = random_settings(rng, TICKS_us)
        settings = looking_ahead(dearest(settings) if seed % 2 else settings, ahead)
        image, inputs = random_image(rng, settings), random_inputs(rng, ticks, settings)
        found += measure(Machine(*built, settings, image, waits), Core(settings, image), inputs)
    return found


def full_cycles(built: tuple[bytes, dict[str, int]], transitions: int, vibrations: int) -> list[int]:
    """Return the cycles of ticks of a program with so many transitions and vibrations."""
    rng = np.random.default_rng(1)
    settings = looking_ahead(dearest(random_settings(rng, TICKS_us)), True)
    image, inputs = full_image(transitions, vibrations, settings), random_inputs(rng, 1000, settings)
    return measure(Machine(*built, settings, image), Core(settings, image), inputs)


def tell(optimise: str, cases: int, ticks: int) -> None:
    """Print what ticks cost when compiled in one way."""
    with tempfile.TemporaryDirectory() as folder:
        built = build(Path(folder), optimise)
    print(f"core, emulated, {optimise}: {len(built[0])} bytes, {cases * ticks} random ticks")
    for waits, name in ((NO_WAIT, "no wait states"), (CACHED, "flash waits")):
        for ahead, suffix in ((False, ""), (True, ", looking ahead")):
            found = random_cycles(built, cases, ticks, waits, ahead)
            print(f"  {name}{suffix}: median {np.median(found):.0f}, worst {max(found)} cycles")
    few, many, full = (full_cycles(built, *counts) for counts in ((0, 0), (48, 0), (48, 32)))
    print(f"  a transition that does not hold: {(np.median(many) - np.median(few)) / 48:.0f} cycles")
    print(f"  a state with 48 of them, 32 vibrations: worst {max(full)} cycles")


def main(cases: int = 40, ticks: int = 500) -> None:
    """Print all figures."""
    if not shutil.which("arm-none-eabi-gcc"):
        sys.exit("core_cost needs arm-none-eabi-gcc")
    for optimise in ("-Os", "-O2", board_flags()):
        tell(optimise, cases, ticks)


if __name__ == "__main__":
    main()
