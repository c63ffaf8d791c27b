"""Write the table of the coil's thermistor, firmware/core/thermistor_table.h."""

from __future__ import annotations

import math
from pathlib import Path

HEADER = Path(__file__).parents[1] / "firmware" / "core" / "thermistor_table.h"
R25_ohm, BETA_K, PULL_UP_ohm = 10_000.0, 3435.0, 10_000.0
"""The thermistor of the bill, and the resistor from it to the converter's reference."""
COLDEST_ROOM_C, MARGIN_K = 15.0, 3.0
"""From where a rise counts. The margin is for 1 % of each of the three above, 4 counts and rounding."""
STEP, COUNTS, COLUMNS = 64, 4096, 10
ZERO_C = 273.15


def temperature_C(counts: float) -> float:
    """Return the temperature at which the converter reads so; it lies between 0 and 4096 counts."""
    ratio = counts * PULL_UP_ohm / ((COUNTS - counts) * R25_ohm)
    return 1 / (1 / (25.0 + ZERO_C) + math.log(ratio) / BETA_K) - ZERO_C


def rise_K_q8(counts: float) -> int:
    """Return the most that the thermistor may be warmer than the coldest room, in 1/256 K, 0 below it."""
    if not 0 < counts < COUNTS:
        return 0 if counts else 65535
    above_K = temperature_C(counts) + MARGIN_K - COLDEST_ROOM_C
    return min(65535, max(0, math.ceil(256 * above_K)))


def _rows() -> str:
    numbers = [f"{rise_K_q8(counts):6d}" for counts in range(0, COUNTS + STEP, STEP)]
    return ",\n".join("   " + ",".join(numbers[i : i + COLUMNS]) for i in range(0, len(numbers), COLUMNS))


def reference() -> str:
    """Return the header's text."""
    return f"""/* Made by tools/make_thermistor.py; do not edit. Rise of the thermistor above
 * {COLDEST_ROOM_C:g} C in K, times 256, every {STEP} counts of {COUNTS}; it is at most
 * {MARGIN_K:g} K off, and that is added: never too cold. */
#ifndef FDVV_THERMISTOR_TABLE_H
#define FDVV_THERMISTOR_TABLE_H

#include <stdint.h>

enum {{ THERMISTOR_STEP_BITS = {STEP.bit_length() - 1}, THERMISTOR_MARGIN_K = {MARGIN_K:.0f} }};

static const uint16_t thermistor_rise_K_q8[{COUNTS // STEP + 1}] = {{
{_rows()},
}};

#endif
"""


if __name__ == "__main__":
    HEADER.write_text(reference())
