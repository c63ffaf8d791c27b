"""What a tick costs the Cortex-M0+, and that none is late on the whole board: figures are emulated."""

from __future__ import annotations

import numpy as np
import pytest
from benchmarks import core_cost, m0

from tests.firmware import _m0
from tests.firmware._simavr import say
from tests.support.campaign import in_turn

pytestmark = pytest.mark.firmware


WORST_CYCLES, WORST_CYCLES_AHEAD = 2700, 3100
TRANSITION_CYCLES = 30
LOAD_TICKS = 100_000


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, dict[str, int]]:
    _m0.require_tools()
    return core_cost.build(tmp_path_factory.mktemp("core"), core_cost.board_flags())


@pytest.mark.parametrize(("ahead", "worst"), [(False, WORST_CYCLES), (True, WORST_CYCLES_AHEAD)])
def test_the_dearest_of_many_ticks_stays_within_its_cycles(
    built: tuple[bytes, dict[str, int]], ahead: bool, worst: int
) -> None:
    found = core_cost.random_cycles(built, 40, 500, ahead=ahead)
    say(
        f"{len(found)} random ticks{', looking ahead' * ahead}: median {np.median(found):.0f}, "
        f"worst {max(found)} cycles, no wait states"
    )
    assert len(found) >= 20_000
    assert max(found) <= worst


def test_a_transition_that_does_not_hold_stays_within_its_cycles(built: tuple[bytes, dict[str, int]]) -> None:
    few, many = (float(np.median(core_cost.full_cycles(built, count, 0))) for count in (0, 48))
    assert 0 < many - few <= 48 * TRANSITION_CYCLES


@pytest.mark.slow
@in_turn(3)
def test_no_tick_is_late_in_uploading_and_pressing_for_long() -> None:
    load = m0.run_load(_m0.build(_m0.CONTROLLER), LOAD_TICKS, m0.rate_settings(250, 25))
    say(f"{load}")
    assert load.ticks >= LOAD_TICKS
    assert load.late == 0
    assert load.lost_records == 0
