"""The synthesiser in C beside its model in Python."""

from __future__ import annotations

import subprocess
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.program.synth import SILENCE_counts, Slot, Waveform, render
from tests.support.program.slot_strategies import SLOTS, STRENGTHS
from tests.support.program.synth_in_c import Board, CSlot

CORE = Path(__file__).resolve().parents[4] / "firmware" / "core"
SNAP = Slot(Waveform.SINE, 3824, 256, 1840, 50_461)


@given(SLOTS, STRENGTHS)
def test_c_and_python_give_the_same_samples(slot: Slot, strength: int) -> None:
    board = Board()
    board.store(slot)
    board.play(0, strength)
    samples = slot.duration_samples + 40
    np.testing.assert_array_equal(board.render(samples), render(slot, samples, strength))


@given(SLOTS, SLOTS, st.integers(0, 200), STRENGTHS)
def test_a_voice_started_again_is_as_if_nothing_had_sounded(
    first: Slot, second: Slot, samples: int, strength: int
) -> None:
    board = Board()
    board.store(first, second)
    board.play(0)
    board.render(samples)
    board.play(1, strength)
    np.testing.assert_array_equal(board.render(600), render(second, 600, strength))


def test_an_empty_or_unknown_slot_is_silence() -> None:
    board = Board()
    board.store(SNAP)
    for index in (1, 15, 16, 255):
        board.play(0)
        board.play(index)
        assert (board.render(300) == SILENCE_counts).all()


def test_a_slot_changed_while_it_sounds_goes_on_as_it_was() -> None:
    board = Board()
    board.store(SNAP)
    board.play(0)
    first = board.render(50)
    board.store(Slot(Waveform.SINE, 999, 10, 3))
    np.testing.assert_array_equal([*first, *board.render(250)], render(SNAP, 300))


def c_slot(**change: int) -> CSlot:
    fields = {
        "frequency_Hz16": 1,
        "duration_samples": 1,
        "amplitude_counts": 2047,
        "decay_q16": 65_535,
        "wave_at": 512,
        "wave_samples": 512,
        "waveform": 1,
    }
    return CSlot(**(fields | change))


@pytest.mark.parametrize(
    ("index", "change"),
    [
        (16, {}),
        (0, {"waveform": 2}),
        (0, {"waveform": 255}),
        (0, {"amplitude_counts": 2048}),
        (0, {"wave_samples": 0}),
        (0, {"wave_samples": 513}),
        (0, {"wave_at": 513}),
        (0, {"wave_at": 65_535}),
    ],
)
def test_a_slot_out_of_range_is_refused_and_changes_nothing(index: int, change: dict[str, int]) -> None:
    board = Board()
    board.store(SNAP)
    before = board.contents()
    assert not board.set(index, c_slot(**change))
    assert board.contents() == before


def test_the_last_slot_and_the_whole_pool_can_be_used() -> None:
    board = Board()
    assert board.set(15, c_slot())
    assert board.load(1024 - 28, bytes(28))
    assert not board.load(1024 - 27, bytes(28))
    assert not board.load(65_535, bytes(1))
    assert not board.load(0, b"")


EXERCISE = """
#include "vibration_receiver.h"
#include <stdio.h>
static uint32_t noise = 1;
static uint8_t random_byte(void) {
    noise = noise * 1664525u + 1013904223u;
    return (uint8_t)(noise >> 24);
}
int main(void) {
    static fdvv_synth_bank bank;
    static fdvv_vibration_receiver receiver;
    static uint16_t samples[65600];
    fdvv_vibration_init(&receiver, &bank);
    for (int i = 0; i < 300; i++) {
        fdvv_synth_voice voice = {0};
        fdvv_synth_slot slot;
        uint8_t *bytes = (uint8_t *)&slot;
        for (unsigned k = 0; k < sizeof slot; k++) bytes[k] = random_byte();
        for (unsigned k = 0; k < 1024; k++) bank.pool[k] = (int8_t)((int)random_byte() - 128);
        slot.waveform &= 1;
        slot.amplitude_counts = i % 2 ? 2047 : slot.amplitude_counts & 2047;
        slot.wave_samples = slot.wave_samples % 512 + 1;
        slot.wave_at = slot.wave_at % (1025 - slot.wave_samples);
        if (!fdvv_synth_set(&bank, (uint8_t)(i % 16), &slot)) return 1;
        fdvv_synth_choose(&voice, &bank, (uint8_t)(i % 16));
        fdvv_synth_start(&voice, random_byte());
        fdvv_synth_render(&voice, samples, slot.duration_samples + 10u);
        for (int k = 0; k < 10; k++) if (samples[slot.duration_samples + k] != 2048) return 2;
    }
    for (int i = 0; i < 100000; i++) {
        const uint8_t chance = random_byte();
        if (chance < 32) fdvv_vibration_begin(&receiver);
        else fdvv_vibration_byte(&receiver, random_byte());
        if (chance > 250) fdvv_vibration_end(&receiver);
    }
    puts("done");
    return 0;
}
"""


def test_no_number_and_no_byte_leads_to_undefined_behaviour(tmp_path: Path) -> None:
    program = tmp_path / "program.c"
    program.write_text(EXERCISE)
    sources = [str(program), str(CORE / "synth.c"), str(CORE / "vibration_receiver.c")]
    flags = ["-std=c99", "-O1", "-Wall", "-Wextra", "-Werror", "-fsanitize=address,undefined"]
    flags += ["-fno-sanitize-recover=all", f"-I{CORE}"]
    subprocess.run(["cc", *flags, "-o", str(tmp_path / "program"), *sources], check=True)
    out = subprocess.run([str(tmp_path / "program")], capture_output=True, text=True, check=False)
    assert (out.returncode, out.stdout, out.stderr) == (0, "done\n", "")
