"""Relating two clocks from pings with delays."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.device.wire import Exchange, relate, unwrap_us
from fdvv.errors import DeviceError

Rng = np.random.Generator


def exchanges(offset_us: float, drift_ppm: float, rng: Rng, count: int = 60) -> list[Exchange]:
    """Make pings a tenth of a second apart, held up on one way or the other, some for long."""
    found = []
    for i in range(count):
        device_us = 1e5 * i
        there, back = 100 + rng.exponential(300, 2) * (rng.random(2) < 0.5)
        host_us = offset_us + (1 + drift_ppm * 1e-6) * device_us
        found.append(Exchange(host_us - there, host_us + back, device_us))
    return found


@pytest.mark.parametrize("drift_ppm", [-200.0, 0.0, 50.0])
def test_offset_and_drift_are_found_in_spite_of_delays(drift_ppm: float) -> None:
    relation = relate(exchanges(12345.0, drift_ppm, np.random.default_rng(2)))
    assert relation.offset_us == pytest.approx(12345.0, abs=60)
    assert relation.drift_ppm == pytest.approx(drift_ppm, abs=15)
    assert relation.host_us(3e6) == pytest.approx(12345 + 3e6 * (1 + drift_ppm * 1e-6), abs=60)
    assert 0 < relation.residual_us < 120
    assert relation.shortest_us == 200


@given(st.integers(0, 10_000))
def test_the_bound_of_the_error_holds_however_the_ways_are_held_up(seed: int) -> None:
    """All on one way, as a busy machine does it; half of the quickest trip bounds only what is symmetric."""
    rng = np.random.default_rng(seed)
    late_us = rng.exponential(2000, (12, 2)) * [1.0, 0.05]
    found = [
        Exchange(1e5 * i - there, 1e5 * i + back, 1e5 * i) for i, (there, back) in enumerate(late_us.tolist())
    ]
    relation = relate(found[:8])
    assert abs(relation.offset_us) <= relation.error_us


def test_exchanges_within_a_second_claim_no_drift() -> None:
    relation = relate(exchanges(0.0, 80.0, np.random.default_rng(1), 5))
    assert relation.drift_ppm == 0


def test_without_a_ping_there_is_no_relation() -> None:
    with pytest.raises(DeviceError, match="ping the device first"):
        relate([])


@given(st.integers(0, 2**40), st.integers(-(2**30), 2**30))
def test_a_wrapped_clock_is_unwrapped_near_what_is_expected(true_us: int, error_us: int) -> None:
    assert unwrap_us(true_us % 2**32, true_us + error_us) == true_us
