"""The cycle model against code whose cycles are counted by hand from the Cortex-M0+ manual's table 3-1."""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Sequence

import pytest

from fdvv._native import library
from fdvv_m0.bus import NEVER, Bus, Clockwork, Window

START = 0x2000


def spend(code: Sequence[int], blocks: Sequence[tuple[int, int]], *, is_cached: bool = True) -> int:
    """Return the cycles of blocks (offset, halfwords) run one after the other."""
    bus = Bus(is_cached, 0)
    struct.pack_into(f"<{len(code)}H", bus.flash, START, *code)
    bus.clockwork.next_event = NEVER
    for offset, halfwords in blocks:
        run_block(bus, START + offset, 2 * halfwords)
    return bus.cycles


def run_block(bus: Bus, address: int, size: int) -> None:
    library().fdvv_m0_block(None, ctypes.c_uint64(address), size, ctypes.byref(bus.clockwork))


def warm(code: Sequence[int]) -> int:
    """Return the cycles of one straight block whose lines are in the cache already."""
    whole = [(0, len(code))]
    return spend(code, whole * 2) - spend(code, whole)


def test_the_mirrors_of_the_structures_have_their_sizes() -> None:
    assert ctypes.sizeof(Clockwork) == library().fdvv_m0_bytes(0)
    assert ctypes.sizeof(Window) == library().fdvv_m0_bytes(1)


@pytest.mark.parametrize(
    ("code", "cycles"),
    [
        ([0x2001], 1),  # movs r0, #1
        ([0x4348], 1),  # muls r0, r1
        ([0x6808], 2),  # ldr r0, [r1]
        ([0x7008], 2),  # strb r0, [r1]
        ([0x5A88], 2),  # ldrh r0, [r1, r2]
        ([0x9001], 2),  # str r0, [sp, #4]
        ([0xA001], 1),  # adr r0, ...
        ([0xB082], 1),  # sub sp, #8
        ([0xB5F0], 6),  # push {r4-r7, lr}: 1 + 5
        ([0xBC0F], 5),  # pop {r0-r3}: 1 + 4
        ([0xBDF0], 8),  # pop {r4-r7, pc}: 3 + 5
        ([0xC107], 4),  # stmia r1!, {r0-r2}: 1 + 3
        ([0xC907], 4),  # ldmia r1!, {r0-r2}
        ([0xE000], 2),  # b
        ([0x4770], 2),  # bx lr
        ([0x4780], 2),  # blx r0
        ([0x46F7], 2),  # mov pc, lr
        ([0x4608], 1),  # mov r0, r1
        ([0xF000, 0xF800], 3),  # bl
        ([0xF3BF, 0x8F4F], 3),  # dsb
        ([0xBF00], 1),  # nop
        ([0xBF30], 2),  # wfi
        ([0xD001, 0xBF00], 2),  # beq, not taken, and nop
    ],
)
def test_an_instruction_costs_what_the_manual_says(code: list[int], cycles: int) -> None:
    assert warm(code) == cycles


def test_a_taken_branch_costs_one_more() -> None:
    loop = [0x3801, 0xD1FD]  # 1: subs r0, #1; bne 1b
    behind = (4, 1)
    code = [*loop, 0xBF00]
    turns = [spend(code, [(0, 2)] * n + [behind]) for n in (3, 4)]
    assert turns[1] - turns[0] == 1 + 2
    # the last time through, not taken: 1 + 1, and the nop, all on one line fetched once
    assert spend(code, [(0, 2), behind]) == 1 + 1 + 1 + 1


def test_each_line_of_eight_bytes_waits_once() -> None:
    nops = [0xBF00] * 16
    assert spend(nops, [(0, 16)]) == 16 + 4
    assert warm(nops) == 16


def test_a_literal_is_a_line_of_its_own() -> None:
    far = [0x4810]  # ldr r0, [pc, #64]
    assert spend(far, [(0, 1)]) == 2 + 1 + 1
    assert warm(far) == 2


def test_the_line_unused_longest_makes_room() -> None:
    code = [0xBF00] * 36  # nine lines
    lines = [(8 * i, 4) for i in range(9)]
    eight = spend(code, lines[:8])
    assert eight == 8 * 5
    assert spend(code, [*lines[:8], lines[0]]) == eight + 4
    assert spend(code, lines) == 9 * 5
    assert spend(code, [*lines, lines[0]]) == 9 * 5 + 5
    assert spend(code, [*lines, lines[1]]) == 9 * 5 + 4 + 0


def test_without_the_cache_every_fetched_word_waits() -> None:
    assert spend([0xBF00] * 16, [(0, 16)], is_cached=False) == 16 + 8
    assert spend([0x4810], [(0, 1)], is_cached=False) == 2 + 1 + 1


def test_an_event_is_called_when_its_cycle_has_come() -> None:
    bus, came = Bus(True, 0), list[int]()
    struct.pack_into("<4H", bus.flash, START, *[0xBF00] * 4)
    bus.at(7, lambda: came.append(bus.cycles))
    bus.at(12, lambda: came.append(bus.cycles))
    for _ in range(3):
        run_block(bus, START, 8)
    assert came == [9, 13]  # 5 with the line's wait, then 4 a turn
