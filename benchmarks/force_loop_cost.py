"""What does a tick with the force loop cost a Cortex-M4? Instructions emulated, cycles an upper estimate.

``python -m benchmarks.force_loop_cost`` needs arm-none-eabi-gcc and unicorn. An instruction counts also where
its condition fails. Cycles are those of tables 3-1 and 7-1 of the processor's reference manual, each at its
dearest: a taken branch refills the pipeline in 3, an integer division takes 12, every floating-point result
delays what follows by 1. Memory has no wait states.
"""

from __future__ import annotations

import re
import shutil
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

import numpy as np

from benchmarks.core_cost import dearest, full_image, looking_ahead
from fdvv.protocol.tables import BoardLimits, Settings
from tests.firmware._core_on_arm import M4, CoreOnArm, compile_core
from tests.support.force_loop_press import SETTINGS, ANNOUNCED_mm_s16, LoopPress, loop_constants, press

TICK_CYCLES = 12_000
"""Of 100 us at 120 MHz."""
REFILL_CYCLES = 3
LINE = re.compile(r"^ *([0-9a-f]+):\t([0-9a-f ]+?) *\t([a-z][a-z0-9.]*)(?:\t(.*))?$", re.MULTILINE)
"""Of a disassembly: address, code, mnemonic, operands."""


class Instruction(NamedTuple):
    """Its length and its cycles, without the refill after a branch."""

    size_bytes: int
    cycles: int


class TickCost(NamedTuple):
    """What one tick cost, and how many lines of 16 bytes its code lies on."""

    instructions: int
    cycles: int
    lines: int


def registers(operands: str) -> int:
    """Count the registers of a list in braces, a double one as two."""
    count = 0
    for part in operands.partition("{")[2].partition("}")[0].split(","):
        numbers = [int(number) for number in re.findall(r"[rsd](\d+)", part)]
        run = numbers[1] - numbers[0] + 1 if len(numbers) == 2 else 1
        count += 2 * run if part.strip().startswith("d") else run
    return count


def cycles_of(mnemonic: str, operands: str) -> int:
    """Return the cycles of an instruction, its condition held, without the refill after a branch."""
    name = mnemonic.partition(".")[0]
    if re.match(r"v?(ldm|stm|push|pop)", name):
        return 1 + registers(operands)
    if re.match(r"(ldr|str)(ex)?d", name) or (re.match(r"v(ldr|str)$", name) and re.match("d", operands)):
        return 3
    if re.match(r"v?(ldr|str)|tb[bh]", name):
        return 2
    if re.match(r"v(div|sqrt)", name):
        return 14 + 1
    if re.match(r"vf?n?m[la][as]", name):
        return 3 + 1
    if re.match(r"v(add|sub|n?mul|cvt)", name):
        return 1 + 1
    return 12 if re.match(r"[us]div", name) else 1


def read_code(elf: Path) -> dict[int, Instruction]:
    """Return the instructions of a program by their addresses."""
    text = subprocess.run(
        ["arm-none-eabi-objdump", "-d", elf], capture_output=True, text=True, check=True
    ).stdout
    return {
        int(address, 16): Instruction(len(code.replace(" ", "")) // 2, cycles_of(mnemonic, operands))
        for address, code, mnemonic, operands in LINE.findall(text)
    }


def address_of(elf: Path, name: str) -> int:
    """Return where a function begins."""
    text = subprocess.run(["arm-none-eabi-nm", elf], capture_output=True, text=True, check=True).stdout
    return next(int(line.split()[0], 16) for line in text.splitlines() if line.split()[-1] == name)


class Block(NamedTuple):
    """Instructions that run one after the other, their cycles, and the lines they lie on."""

    instructions: int
    cycles: int
    lines: frozenset[int]


class CountingCore(CoreOnArm):
    """A core on an emulated Cortex-M4 that counts what each tick costs, hearing the host included."""

    def __init__(
        self, folder: Path, settings: Settings, image: bytes, limits: BoardLimits | None = None
    ) -> None:
        super().__init__((folder / "core.bin").read_bytes(), settings, image, M4, limits)
        self._code = read_code(folder / "core.elf")
        self._start, self._next = address_of(folder / "core.elf", "fdvv_core_tick"), 0
        self._after = address_of(folder / "core.elf", "fdvv_core_after_tick")
        self._known: dict[tuple[int, int], Block] = {}
        self._ticks: list[tuple[list[Block], list[int]]] = []
        self._rests: list[tuple[list[Block], list[int]]] = []
        self._now: tuple[list[Block], list[int]] | None = None
        self._uc.hook_add(self._unicorn.UC_HOOK_BLOCK, self._count)

    def _count(self, _uc: object, address: int, size_bytes: int, _data: object) -> None:
        if address in (self._start, self._after):
            self._now = [], []
            (self._ticks if address == self._start else self._rests).append(self._now)
        if self._now:
            blocks, refills = self._now
            blocks.append(self._block(address, size_bytes))
            refills.append(REFILL_CYCLES if address != self._next else 0)
        self._next = address + size_bytes

    def _block(self, start: int, size_bytes: int) -> Block:
        """Return the block of code there."""
        if (start, size_bytes) not in self._known:
            at, cycles, count = start, 0, 0
            while at < start + size_bytes:
                size, cost = self._code[at]
                at, cycles, count = at + size, cycles + cost, count + 1
            lines = frozenset(range(start // 16, (at - 1) // 16 + 1))
            self._known[start, size_bytes] = Block(count, cycles, lines)
        return self._known[start, size_bytes]

    def on_instruction(self, call: Callable[[int], object]) -> None:
        """Call for each instruction that runs from now on, with its address."""
        self._uc.hook_add(self._unicorn.UC_HOOK_CODE, lambda _uc, address, _size, _data: call(address))

    def costs(self) -> list[TickCost]:
        """Return what each tick cost so far, up to its outputs and the next tick's sign of the host."""
        return self._costs(self._ticks)

    def rests(self) -> list[TickCost]:
        """Return what came after each tick's outputs: once in 100 ticks the thermistor."""
        return self._costs(self._rests)

    @staticmethod
    def _costs(parts: list[tuple[list[Block], list[int]]]) -> list[TickCost]:
        return [
            TickCost(
                sum(block.instructions for block in blocks),
                sum(block.cycles for block in blocks) + sum(refills),
                len(frozenset().union(*(block.lines for block in blocks))),
            )
            for blocks, refills in parts
        ]


def measure(folder: Path, pressed: LoopPress, closed: bool) -> list[TickCost]:
    """Return the cost of every tick of a press; the outputs must be those of this machine's own core."""
    return counted(folder, pressed, closed).costs()


def counted(folder: Path, pressed: LoopPress, closed: bool) -> CountingCore:
    """Run a press; the outputs must be those of this machine's own core."""
    core = CountingCore(folder, pressed.core.settings, pressed.image, pressed.core.limits)
    if closed:
        core.close_loop(loop_constants())
    core.announce(ANNOUNCED_mm_s16)
    outputs = core.run(pressed.inputs)
    assert outputs.tobytes() == pressed.outputs.tobytes(), "the emulated core and this machine's differ"
    return core


def dearest_settings() -> Settings:
    """Return the rig's settings with every part of a tick that they can make dearer."""
    return looking_ahead(dearest(SETTINGS), True)


def press_costs(folder: Path, closed: bool, ticks: int = 3000) -> list[TickCost]:
    """Return the costs of a press of MX Clear in 0.1 s, and of its release."""
    return measure(folder, press(press_s=0.1, ticks=ticks, closed=closed), closed)


def dear_costs(folder: Path, closed: bool, ticks: int = 3000) -> list[TickCost]:
    """Return the costs of a press of a program with 48 transitions and 32 vibrations, on the dearest rig."""
    settings = dearest_settings()
    image = full_image(48, 32, settings)
    return measure(
        folder, press(settings=settings, image=image, press_s=0.1, ticks=ticks, closed=closed), closed
    )


def tell(name: str, costs: list[TickCost]) -> None:
    """Print the median and the worst tick."""
    instructions, cycles, lines = np.array(costs).T
    print(
        f"  {name}: instructions median {np.median(instructions):.0f}, worst {instructions.max()}; "
        f"cycles at most median {np.median(cycles):.0f}, worst {cycles.max()} "
        f"({100 * cycles.max() / TICK_CYCLES:.0f} % of {TICK_CYCLES}); code at most {16 * lines.max()} bytes"
    )


def main() -> None:
    """Print all figures."""
    if not shutil.which("arm-none-eabi-gcc"):
        sys.exit("force_loop_cost needs arm-none-eabi-gcc")
    for optimise in ("-Os", "-O2"):
        with tempfile.TemporaryDirectory() as place:
            folder = Path(place)
            print(
                f"core and force loop, emulated, {optimise}: {len(compile_core(folder, optimise, M4))} bytes"
            )
            for closed, suffix in ((False, ", loop open"), (True, ", loop closed")):
                tell(f"MX Clear{suffix}", press_costs(folder, closed))
                tell(f"dearest{suffix}", dear_costs(folder, closed))
            rests = counted(folder, press(press_s=0.1, ticks=3000), True).rests()
            tell("after the tick", rests)


if __name__ == "__main__":
    main()
