"""The cue that shows a person how fast to press."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fdvv.cli.cue import BEATS, BEAT_s, DWELL_s, bar, depth_at, minimum_jerk, show_cue


class Clock:
    """Time that passes only while somebody sleeps."""

    def __init__(self) -> None:
        self.now_s = 10.0

    def __call__(self) -> float:
        return self.now_s

    def sleep(self, duration_s: float) -> None:
        self.now_s += duration_s


def test_the_smoothest_move_begins_and_ends_at_rest_and_is_half_way_at_half_time() -> None:
    assert [minimum_jerk(p) for p in (0.0, 0.5, 1.0)] == [0.0, 0.5, 1.0]
    for end in (0.0, 1.0):
        assert minimum_jerk(end + 1e-3) == pytest.approx(minimum_jerk(end - 1e-3), abs=1e-7)


@given(st.floats(0.01, 1.0))
def test_the_bar_is_at_the_stop_after_one_stroke_and_back_after_the_second(stroke_s: float) -> None:
    assert depth_at(0.0, stroke_s) == 0.0
    assert depth_at(stroke_s + DWELL_s / 2, stroke_s) == pytest.approx(1.0)
    assert depth_at(2 * stroke_s + DWELL_s, stroke_s) == pytest.approx(0.0, abs=1e-12)
    assert depth_at(1.5 * stroke_s + DWELL_s, stroke_s) == pytest.approx(0.5)


def test_a_bar_is_full_at_the_stop_and_has_one_width() -> None:
    assert set(bar(1.0)) == {"█"}
    assert set(bar(0.0)) == {"·"}
    assert {len(bar(d / 7)) for d in range(8)} == {len(bar(1.0))}


def test_the_cue_counts_in_and_then_takes_the_time_of_both_strokes() -> None:
    clock, drawn = Clock(), list[tuple[float, str]]()
    show_cue(0.2, lambda text: drawn.append((clock.now_s - 10.0, text)), clock, clock.sleep)
    assert [text[0] for _, text in drawn[:3]] == list(BEATS)
    begun_s = BEAT_s * len(BEATS)
    deepest_s, deepest = max(drawn, key=lambda d: d[1].count("█"))
    assert deepest.count("·") == 0
    assert begun_s + 0.15 < deepest_s < begun_s + 0.2 + DWELL_s
    assert drawn[-1][0] == pytest.approx(begun_s + 0.4 + DWELL_s, abs=1 / 50)
    assert drawn[-1][1].count("█") == 0
