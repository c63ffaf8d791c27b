"""Shipped programs on the simulated rig, upright as it is by default, pressed by the simulated finger."""

from __future__ import annotations

from itertools import pairwise

import pytest

from fdvv.device.twin import TwinDevice
from fdvv.program.compile import compile_program
from fdvv.program.library import make

GOES = {
    "button": ["up", "down", "up"],
    "dwell-ticks": ["up", "down", "dwelling", "down", "up"],
    "fast-tapping": ["ready", "dropping", "returning", "ready"],
    "multi-level": [f"level {k}" for k in (0, 1, 2, 3, 2, 1, 0)],
    "non-newtonian": ["up", "down", "up"],
    "rapid-trigger": ["up", "down", "up"],
    "returning-later": ["ready", "spent", "returning", "ready"],
}


@pytest.mark.parametrize("name", sorted(GOES))
def test_a_simulated_press_goes_through_the_states_of_the_program(name: str) -> None:
    program = make(name, cooldown_ms=60) if name == "returning-later" else make(name)
    device = TwinDevice(seed=1)
    device.upload_program(compile_program(program).image)
    states = device.press_trace(100.0).state.tolist()
    entered = [states[0], *(b for a, b in pairwise(states) if a != b)]
    assert [program.states[i].name for i in entered] == GOES[name]
