"""When a key goes down that is read now and then."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv_studio.live.travel_key import TravelKey


def test_it_can_again_once_it_was_above_the_reset() -> None:
    key = TravelKey(1.5, 1.2)
    places = (2.0, 1.3, 1.6, 1.2, 1.4, 1.5, 0.0, 2.0)
    found = [key.read(float(t), x) for t, x in enumerate(places)]
    assert [at is not None for at in found] == [True, False, False, False, False, True, False, True]
    assert found[-1] == pytest.approx(6.75)


def test_however_often_it_is_read_a_steady_press_is_found_when_it_was() -> None:
    random = np.random.default_rng(2)
    for _ in range(50):
        speed_mm_s, place_mm = random.uniform(20, 300), random.uniform(0.3, 3.5)
        times = np.sort(random.uniform(0, 4 / speed_mm_s, 12))
        key = TravelKey(place_mm, place_mm - 0.2)
        found = [at for t in (0.0, *times, 4 / speed_mm_s) if (at := key.read(t, speed_mm_s * t)) is not None]
        assert found == pytest.approx([place_mm / speed_mm_s])
