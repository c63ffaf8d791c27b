"""Presses on several threads."""

from __future__ import annotations

from concurrent.futures import ThreadPoolExecutor

import numpy as np

from fdvv.model.surface import ForceSurface
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.noise import draw_noise
from fdvv.twin.rig import Rig
from tests.support.table_press import simulate


def test_presses_on_several_threads_are_those_of_one_to_the_bit(tactile: ForceSurface) -> None:
    rig, finger = Rig(), Finger()

    def press(k: int) -> bytes:
        gesture = plan(finger, 0.004, 0.03 + 0.002 * k)
        noise = draw_noise(rig, finger, gesture, np.random.default_rng(k))
        return simulate(rig, finger, gesture, tactile, 4.0, noise, 90.0).force_cN.tobytes()

    with ThreadPoolExecutor(3) as pool:
        assert list(pool.map(press, range(12))) == [press(k) for k in range(12)]
