"""Many presses at once."""

from __future__ import annotations

import threading
from collections.abc import Iterator

import numpy as np
import pytest

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import draw_noise
from fdvv.twin.rig import Rig
from fdvv.twin.simulate import RigPress, in_threads, simulate_rig_batch


def presses(surface: ForceSurface, count: int) -> Iterator[RigPress]:
    rig, finger, image = Rig(), Finger(), image_of(surface, 4.0).image
    for k in range(count):
        gesture = plan(finger, 0.004, 0.03 + 0.002 * k)
        yield RigPress(
            rig, finger, gesture, image, draw_noise(rig, finger, gesture, np.random.default_rng(k)), 90.0
        )


def test_threads_give_the_presses_in_order_and_to_the_bit(tactile: ForceSurface) -> None:
    alone = [press.simulate().force_cN.tobytes() for press in presses(tactile, 12)]
    assert [t.force_cN.tobytes() for t in simulate_rig_batch(presses(tactile, 12), 3)] == alone


def test_only_a_few_plans_are_taken_ahead_of_their_results() -> None:
    taken = []

    def plans() -> Iterator[int]:
        for k in range(100):
            taken.append(k)
            yield k

    results = in_threads(lambda k: k, plans(), 2)
    assert [next(results) for _ in range(5)] == [0, 1, 2, 3, 4]
    assert len(taken) <= 5 + 9


def test_two_threads_work_at_the_same_time() -> None:
    both = threading.Barrier(2, timeout=30)
    assert len(list(in_threads(lambda _: both.wait(), range(2), 2))) == 2


def test_an_error_comes_where_its_result_would_be() -> None:
    results = in_threads(lambda k: 1 / k, [2, 1, 0], 2)
    assert [next(results), next(results)] == [0.5, 1.0]
    with pytest.raises(ZeroDivisionError):
        next(results)
