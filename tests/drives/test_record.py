"""The press in a loop's log."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.device.remote import find_press
from fdvv.device.telemetry import TickColumns
from fdvv.units import FloatArray
from fdvv_drives.record import LoopLog, PressFinder


def columns_of(x_mm: FloatArray) -> TickColumns:
    zeros = {name: np.zeros(x_mm.size) for name in TickColumns.__dataclass_fields__}
    return TickColumns(**{**zeros, "displacement_mm": x_mm})  # type: ignore[arg-type]


@given(
    st.lists(
        st.tuples(st.sampled_from([0.0, 0.1, 0.2, 1.0, 3.5, 3.7, 4.2]), st.integers(1, 30)),
        min_size=1,
        max_size=14,
    )
)
def test_the_press_found_in_the_loop_is_that_found_afterwards(pieces: list[tuple[float, int]]) -> None:
    x_mm = np.concatenate([np.full(count, value) for value, count in pieces])
    finder, last = PressFinder(4.0), -1
    for number, value in enumerate(x_mm):
        if finder.feed(float(value)):
            last = number
            break
    rows = find_press(columns_of(x_mm[: last + 1]), 4.0) if last >= 0 else find_press(columns_of(x_mm), 4.0)
    if rows is None:
        assert last < 0
        return
    chosen = np.flatnonzero(rows)
    assert (finder.first, last) == (chosen[0], chosen[-1])


def uneven(count: int = 200) -> LoopLog:
    """Cycles of 2 ms that come up to 0.8 ms late, of a cap that goes through a half sine."""
    log, random = LoopLog(), np.random.default_rng(1)
    for number in range(count):
        sent_s = 7.0 + 0.002 * number + 0.0008 * random.random()
        received_s = sent_s + 0.0003 + 0.0004 * random.random()
        time_s = 0.5 * (sent_s + received_s) - 7.0
        log.note(sent_s, received_s, position(time_s), force(time_s), float(number), number == 50)
    return log


def position(time_s: float) -> float:
    return float(4.0 * np.sin(np.pi * time_s / 0.4))


def force(time_s: float) -> float:
    return float(40.0 + 10.0 * position(time_s))


def test_a_press_is_even_in_time_and_measured_at_its_true_times() -> None:
    press = uneven().press(20, 180, 0.002, 100.0, simulated=True)
    assert np.allclose(np.diff(press.t_s), 0.002, rtol=1e-9)
    first_s = uneven().times_s()[20] - 7.0
    # an even clock on uneven times would be wrong by up to 0.8 ms, or 0.025 mm
    wanted = [position(first_s + t_s) for t_s in press.t_s]
    assert np.allclose(press.displacement_mm, wanted, atol=2e-3)
    assert np.allclose(press.force_cN, [force(first_s + t_s) for t_s in press.t_s], atol=2e-2)


def test_a_command_holds_until_the_next() -> None:
    log = uneven()
    press = log.press(20, 180, 0.002, 100.0, simulated=True)
    assert press.commanded_cN is not None
    assert press.saturated is not None
    times_s = log.times_s()
    for t_s, commanded_cN in zip(press.t_s, press.commanded_cN, strict=True):
        assert commanded_cN == np.flatnonzero(times_s <= times_s[20] + t_s + 1e-12)[-1]
    assert 1 <= press.saturated.sum() <= 2


def test_a_press_holds_no_row_before_its_first_and_after_its_last_cycle() -> None:
    log = uneven()
    press = log.press(20, 180, 0.002, 100.0, simulated=True)
    assert press.t_s[-1] <= log.times_s()[180] - log.times_s()[20] < press.t_s[-1] + 0.002
    assert press.t_s.size == pytest.approx(161, abs=1)
