"""Presses in telemetry: found however it is cut, judged against what was meant, counted only if whole."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.model.curve import Stroke
from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv.protocol.tables import Fault
from fdvv.units import FloatArray
from fdvv_people.study.plan.trial import Rendered
from fdvv_people.study.stimulus.evidence import RenderingEvidence
from tests.support.buttons import line_model

LINE = line_model("line", 40.0)
TICK_s = 2.5e-4


def pressed(model: FDVVModel, speed_mm_s: float, depth_mm: float = 4.0, added_cN: float = 0.0) -> FloatArray:
    """Return time, place and force of a press at constant speed, off the model by some force."""
    down_s = depth_mm / speed_mm_s
    corners_s = np.cumsum([0.0, 0.1, down_s, 0.05, down_s, 0.15])
    t = np.arange(0.0, corners_s[-1], TICK_s)
    x = np.interp(t, corners_s, [0.0, 0.0, depth_mm, depth_mm, 0.0, 0.0])
    force = np.where(
        t < corners_s[3],
        model.force_cN(x, speed_mm_s, Stroke.PRESS),
        model.force_cN(x, speed_mm_s, Stroke.RELEASE),
    )
    return np.stack([t, x, force + added_cN])


def moved(rows: FloatArray, time_s: float, place_mm: float = 0.0) -> FloatArray:
    """Move rows in time and place."""
    return np.asarray(rows + np.array([[time_s], [place_mm], [0.0]]))


def joined(*presses: FloatArray) -> FloatArray:
    """Put presses behind each other on one clock."""
    placed, now_s = [], 0.0
    for rows in presses:
        placed.append(moved(rows, now_s))
        now_s = placed[-1][0, -1] + TICK_s
    return np.hstack(placed)


def record_of(model: FDVVModel, rows: FloatArray, *cuts: int) -> Rendered:
    evidence = RenderingEvidence("A", "S", model)
    for piece in np.split(rows, sorted(cuts), axis=1):
        evidence.take(*piece)
    return evidence.rendered()


@pytest.mark.parametrize("speed_mm_s", [20.0, 100.0, 180.0])
@pytest.mark.parametrize("added_cN", [0.0, 5.0, -12.0])
def test_the_error_is_what_was_added_to_the_intended_force(speed_mm_s: float, added_cN: float) -> None:
    model = load_builtin("mx-clear")
    found = record_of(model, pressed(model, speed_mm_s, added_cN=added_cN))
    assert found.presses == 1
    assert found.error_cN[0] == pytest.approx(abs(added_cN), abs=0.4)
    assert found.velocity_mm_s[0] == pytest.approx(speed_mm_s, rel=0.01)


@settings(deadline=None, max_examples=15)
@given(st.lists(st.integers(1, 3500), max_size=60))
def test_telemetry_may_come_in_any_pieces(cuts: list[int]) -> None:
    rows = joined(
        *(pressed(LINE, speed, added_cN=added) for speed, added in ((60, 0.0), (90, 3.0), (200, 9.0)))
    )
    whole, pieces = record_of(LINE, rows), record_of(LINE, rows, *cuts)
    assert whole.presses == pieces.presses == 3
    assert pieces.error_cN == pytest.approx(whole.error_cN, abs=0.1)
    assert pieces.velocity_mm_s == pytest.approx(whole.velocity_mm_s, rel=0.02)


def test_a_press_that_is_not_deep_or_not_over_is_none() -> None:
    assert record_of(LINE, pressed(LINE, 100.0, depth_mm=0.25)).presses == 0
    rows = pressed(LINE, 100.0)
    assert record_of(LINE, rows[:, : rows.shape[1] // 2]).presses == 0


def test_a_press_that_had_begun_before_does_not_count() -> None:
    rows = pressed(LINE, 100.0)
    held = rows[:, rows.shape[1] // 2 :]
    assert record_of(LINE, held).presses == 0
    assert record_of(LINE, joined(held, rows)).presses == 1


def test_half_a_press_counts_and_is_not_judged() -> None:
    found = record_of(LINE, pressed(LINE, 100.0, depth_mm=1.2))
    assert (found.presses, found.error_cN) == (1, (None,))
    assert found.velocity_mm_s[0] is not None


def test_without_a_known_force_no_error_is_reported() -> None:
    rows = pressed(LINE, 100.0)
    rows[2] = np.nan
    assert record_of(LINE, rows).error_cN == (None,)


def test_a_cap_that_does_not_come_all_the_way_back_ends_its_press_all_the_same() -> None:
    rows = pressed(LINE, 100.0)
    after = rows[0] > rows[0, rows[1].argmax()]
    rows[1, after] = np.maximum(rows[1, after], 0.25)
    found = record_of(LINE, joined(rows, moved(rows, 0.0, 0.25)))
    assert found.presses >= 1


def test_a_gap_ends_what_is_back_and_forgets_what_is_not() -> None:
    rows = pressed(LINE, 100.0)
    evidence = RenderingEvidence("A", "S", LINE)
    back = int(np.flatnonzero(rows[1] > 0.3)[-1]) + 3
    evidence.take(*rows[:, :back])
    evidence.cut()
    assert evidence.presses == 1
    evidence.take(*rows[:, : rows.shape[1] // 2])
    evidence.cut()
    evidence.take(*rows[:, -100:])
    assert evidence.presses == 1


def test_a_button_held_for_minutes_costs_little_and_its_press_is_judged() -> None:
    rows = pressed(LINE, 100.0)
    bottom = int(rows[1].argmax()) + 10
    evidence = RenderingEvidence("A", "S", LINE)
    evidence.take(*rows[:, :bottom])
    hold_s = np.arange(0.0, 0.1, TICK_s)
    still = np.full(hold_s.size, 4.0), np.full(hold_s.size, 60.0)
    for i in range(1200):
        evidence.take(rows[0, bottom] + 0.1 * i + hold_s, *still)
    assert sum(piece.shape[1] for piece in evidence._kept) < 30_000
    later = moved(rows[:, bottom:], 121.0)
    evidence.take(*later)
    assert evidence.rendered().error_cN[0] == pytest.approx(0.0, abs=0.4)


def test_of_a_board_that_does_not_answer_no_vibration_is_reported() -> None:
    evidence = RenderingEvidence("A", "S", LINE)
    evidence.played(3)
    evidence.failed(Fault.VIBRATION_BOARD)
    found = evidence.rendered()
    assert (found.vibrations, found.faults) == (0, ("vibration_board",))
