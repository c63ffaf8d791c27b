"""The core on a Cortex-M0+ and the core in this process do the same, to the bit. Emulated."""

from __future__ import annotations

import numpy as np
import pytest

from fdvv.firmware.core import Core
from fdvv.protocol.tables import Refusal, Settings
from tests.firmware._core_on_arm import CoreOnArm, board_flags, compile_core
from tests.support.campaign import campaign
from tests.support.random_presses import random_inputs, random_settings
from tests.support.random_programs import random_image

pytestmark = pytest.mark.firmware


@pytest.fixture(scope="module", params=["-Os", "-O2", board_flags()])
def code(request: pytest.FixtureRequest, tmp_path_factory: pytest.TempPathFactory) -> bytes:
    return compile_core(tmp_path_factory.mktemp("core"), request.param)


def agree(code: bytes, seed: int, ticks: int, pieces: int = 8) -> int:
    """Run one random program and press on both, with random host events; return the ticks that rendered."""
    rng = np.random.default_rng(seed)
    settings = random_settings(rng)
    image, inputs = random_image(rng, settings), random_inputs(rng, ticks, settings)
    here, there = Core(settings, image), CoreOnArm(code, settings, image)
    assert there.refusal == Refusal.NONE
    here.arm()
    rendered = 0
    for part in np.array_split(inputs, pieces):
        event, velocity_mm_s16 = int(rng.integers(32)), int(rng.integers(8, 16000))
        for core in (here, there):
            core.event(event)
            core.announce(velocity_mm_s16)
        ours, theirs = here.run(part), there.run(part)
        assert ours.tobytes() == theirs.tobytes(), f"seed {seed}: the cores differ"
        rendered += int(np.count_nonzero(ours["enable"]))
    return rendered


@campaign("block", range(40), part=1)
def test_a_million_ticks_of_random_programs_and_presses_agree_to_the_bit(code: bytes, block: int) -> None:
    rendered = sum(agree(code, 1000 + 10 * block + seed, 2500) for seed in range(10))
    assert rendered > 12_500, "most of these ticks should render"


def test_a_corrupted_image_is_refused_there_as_here(code: bytes) -> None:
    rng = np.random.default_rng(7)
    image = bytearray(random_image(rng, Settings()))
    image[100] ^= 1
    assert CoreOnArm(code, Settings(), bytes(image)).refusal == Refusal.CHECKSUM
