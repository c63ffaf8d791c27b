"""The strip's core under the sanitisers, fed with noise, frames and wild clocks."""

from __future__ import annotations

import subprocess
from pathlib import Path

import pytest

from tests.safety._build import CORE, SANITISED, compile_c

SOURCES = tuple(CORE / name for name in ("strip.c", "strip_link.c", "small_frame.c"))

PROGRAM = r"""
#include "strip.h"
#include <stdlib.h>
#include <string.h>
static fdvv_strip strip;
static uint32_t now, seed = 1, begun, shown;
static uint8_t noise(void) { seed = seed * 1664525u + 1013904223u; return (uint8_t)(seed >> 24); }
static void say(const uint8_t *frame, uint8_t count) {
    uint8_t stuffed[FDVV_SMALL_STUFFED_BYTES], byte, sent = fdvv_small_put(frame, count, stuffed);
    for (uint8_t i = 0; i < sent; i++) {
        fdvv_strip_receive(&strip, stuffed[i], now, noise() & 1);
        while (fdvv_strip_transmit(&strip, &byte)) {}
    }
}
int main(void) {
    fdvv_strip_hello_request hello = {FDVV_STRIP_PROTOCOL_VERSION, 0, FDVV_STRIP_PROTOCOL_HASH};
    uint8_t frame[FDVV_SMALL_FRAME_BYTES - 2] = {FDVV_STRIP_MSG_HELLO, 0};
    fdvv_strip_init(&strip, 0, 46);
    memcpy(frame + 2, &hello, sizeof hello);
    say(frame, 2 + sizeof hello);
    for (uint32_t turn = 0; turn < 400000; turn++) {
        frame[0] = noise() & 7, frame[1] = noise();
        fdvv_strip_begin_request rules = {
            noise(), 20 + noise() % 181, 50 + noise(), 50 + noise(), 8 + noise() % 233,
            1 + noise() % 239, noise() & 7, 1 + noise() % 31, noise() & 1, 0};
        for (uint8_t i = 2; i < sizeof frame; i++) frame[i] = noise();
        if (frame[0] == FDVV_STRIP_MSG_HELLO) memcpy(frame + 2, &hello, sizeof hello);
        if (frame[0] == FDVV_STRIP_MSG_BEGIN) memcpy(frame + 2, &rules, sizeof rules);
        say(frame, 2 + (uint8_t[]){0, 8, 0, 14, 0, 0, 6, 20}[frame[0]]);
        begun += fdvv_strip_is_playing(&strip);
        for (uint8_t i = 0; i < 8; i++) {
            now += noise() & 1 ? noise() : 100000u * (noise() >> 5);
            if (noise() & 1) fdvv_strip_edge(&strip, now - noise());
            fdvv_strip_tick(&strip, now);
            if (fdvv_strip_frame(&strip, now)) {
                const fdvv_strip_picture *picture = &strip.picture;
                if (picture->pixels > FDVV_STRIP_MOST_PIXELS || picture->last < picture->first) abort();
                if (picture->bullet != FDVV_STRIP_NOWHERE && picture->bullet >= picture->pixels) abort();
                if (picture->last - picture->first >= FDVV_STRIP_LIT_PIXELS) abort();
                if (picture->first != FDVV_STRIP_NOWHERE && picture->last >= FDVV_STRIP_MOST_PIXELS) abort();
                shown += picture->bullet != FDVV_STRIP_NOWHERE;
                fdvv_strip_sent(&strip);
            }
        }
    }
    return shown > 1000 && begun > 1000 ? 0 : 3;
}
"""


@pytest.mark.slow
def test_neither_noise_nor_wild_clocks_lead_the_strip_astray(tmp_path: Path) -> None:
    source = tmp_path / "program.c"
    source.write_text(PROGRAM)
    program = compile_c(tmp_path / "program", *SANITISED, sources=(source, *SOURCES))
    out = subprocess.run([str(program)], capture_output=True, text=True, check=False)
    assert (out.returncode, out.stderr) == (0, "")
