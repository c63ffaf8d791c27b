"""The firmware's tables are those of the code; the thermistor's is on the safe side of its equation."""

from __future__ import annotations

import numpy as np
from tools import make_sine, make_thermistor
from tools.make_thermistor import COLDEST_ROOM_C, MARGIN_K, R25_ohm, temperature_C

from tests.safety._thermistor import rise_K_q16


def test_the_sine_table_is_that_of_the_code() -> None:
    assert make_sine.HEADER.read_text() == make_sine.reference(), "run python tools/make_sine.py"


def test_the_thermistors_table_is_that_of_the_tool() -> None:
    assert make_thermistor.HEADER.read_text() == make_thermistor.reference(), "run tools/make_thermistor.py"


def test_no_reading_is_taken_for_colder_than_it_is_nor_for_much_warmer() -> None:
    counts = np.arange(64, 2500)
    warm_K = np.array([temperature_C(float(count)) - COLDEST_ROOM_C for count in counts])
    off_K = np.array([rise_K_q16(int(count)) / 65536 for count in counts]) - warm_K
    assert off_K.min() >= MARGIN_K - 0.05
    assert off_K[counts > 128].max() < MARGIN_K + 1.5


def test_parts_of_one_percent_and_four_counts_stay_within_the_margin() -> None:
    for kelvins in range(15, 111, 5):
        true_C = float(kelvins)
        worst = 0.0
        for r25 in (0.99, 1.01):
            for beta in (0.99 * 3435, 1.01 * 3435):
                ohm = r25 * R25_ohm * np.exp(beta * (1 / (true_C + 273.15) - 1 / 298.15))
                for pull_up in (9900.0, 10_100.0):
                    for noise in (-4, 4):
                        read_C = temperature_C(4096 * ohm / (ohm + pull_up) + noise)
                        worst = max(worst, abs(read_C - true_C))
        assert worst < MARGIN_K
