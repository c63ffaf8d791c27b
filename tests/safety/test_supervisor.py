"""The supervisor does what its oracle does, call by call."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from tests.safety import _scenes
from tests.safety._script import Script
from tests.support.campaign import campaign


@pytest.mark.parametrize("scene", _scenes.DIRECTED, ids=lambda scene: scene.__name__)
def test_each_scene_goes_as_the_oracle_says(scene: Callable[[Script], None]) -> None:
    script = Script()
    scene(script)
    assert script.play() == ""


@campaign("seed", range(100), part=5)
def test_10_000_random_ticks_go_as_the_oracle_says(seed: int) -> None:
    script = Script()
    _scenes.chance(script, seed, 10_000)
    assert script.play() == ""
