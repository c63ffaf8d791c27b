"""Write the sine table of the vibration synthesiser, firmware/core/synth_sine.h."""

from __future__ import annotations

from pathlib import Path

from fdvv.program.synth import SINE_Q12

HEADER = Path(__file__).parents[1] / "firmware" / "core" / "synth_sine.h"
COLUMNS = 16


def _rows() -> str:
    numbers = [f"{value:5d}" for value in SINE_Q12[:256]]
    return ",\n".join("    " + ",".join(numbers[i : i + COLUMNS]) for i in range(0, 256, COLUMNS))


def reference() -> str:
    """Return the header's text."""
    return f"""/* Made by tools/make_sine.py; do not edit. One turn of a sine in 256 steps, times 4096. */
#ifndef FDVV_SYNTH_SINE_H
#define FDVV_SYNTH_SINE_H

#include <stdint.h>

/* an AVR would copy a plain table into its 2 KB of RAM */
#ifdef __AVR__
#include <avr/pgmspace.h>
#define FDVV_IN_FLASH PROGMEM
#define FDVV_SYNTH_SINE_Q12(index) ((int16_t)pgm_read_word(&sine_table_q12[index]))
#else
#define FDVV_IN_FLASH
#define FDVV_SYNTH_SINE_Q12(index) (sine_table_q12[index])
#endif

static const int16_t sine_table_q12[256] FDVV_IN_FLASH = {{
{_rows()},
}};

#endif
"""


if __name__ == "__main__":
    HEADER.write_text(reference())
