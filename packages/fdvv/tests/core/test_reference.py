"""The compiled tick against the readable one: equal bit by bit over random rigs, programs and presses."""

from __future__ import annotations

import numpy as np

from fdvv.firmware.core import OUTPUTS, Core
from tests.support.campaign import campaign
from tests.support.core.program import Program
from tests.support.core.tick import Reference
from tests.support.random_presses import random_inputs, random_settings
from tests.support.random_programs import random_image


def compare(seed: int, ticks: int) -> None:
    """Run both on the same case; events, announcements, a disarming and a new program included."""
    rng = np.random.default_rng(seed)
    settings = random_settings(rng)
    image, inputs = random_image(rng, settings), random_inputs(rng, ticks, settings)
    core, reference = Core(settings, image), Reference(settings, Program(image))
    core.arm()
    events = rng.integers(0, 32, ticks)
    happens = rng.random(ticks) < 0.05
    names = OUTPUTS.names or ()
    for k, given in enumerate(inputs):
        if happens[k]:
            core.event(int(events[k]))
            reference.events.add(int(events[k]))
        if rng.random() < 0.005:
            core.announce(8 + int(events[k]) * 300)
            reference.announced = 8 + int(events[k]) * 300
        if rng.random() < 0.003:
            core.disarm()
        elif rng.random() < 0.05:
            core.arm()
        outputs = core.tick(given)
        got = {name: int(outputs[name]) for name in names}
        wanted = reference.tick({name: int(given[name]) for name in given.dtype.names or ()}, got["mode"])
        assert got == wanted, f"seed {seed}, tick {k}"


@campaign("block", range(100), part=2)
def test_the_compiled_tick_equals_the_readable_one_over_a_million_ticks(block: int) -> None:
    for seed in range(10):
        compare(10_000 + 10 * block + seed, 1000)
