"""What a tick costs the Cortex-M0+, and that none is late on the whole board: figures are emulated."""

from __future__ import annotations

import importlib.util
import sys
from types import ModuleType

import numpy as np
import pytest

from tests.firmware import _m0
from tests.firmware._simavr import say

pytestmark = pytest.mark.firmware


def benchmark(name: str) -> ModuleType:
    """Return a module of the folder benchmarks, which is no part of the package."""
    where = _m0.REPOSITORY / "benchmarks" / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"benchmark_{name}", where)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    sys.modules[spec.name] = module  # where its records look for their types
    spec.loader.exec_module(module)
    return module


CORE_COST, BOARD = benchmark("core_cost"), benchmark("m0")
WORST_CYCLES, WORST_CYCLES_AHEAD = 2700, 3100
TRANSITION_CYCLES = 30
LOAD_TICKS = 100_000


@pytest.fixture(scope="module")
def built(tmp_path_factory: pytest.TempPathFactory) -> tuple[bytes, dict[str, int]]:
    _m0.require_tools()
    built: tuple[bytes, dict[str, int]] = CORE_COST.build(
        tmp_path_factory.mktemp("core"), CORE_COST.board_flags()
    )
    return built


@pytest.mark.parametrize(("ahead", "worst"), [(False, WORST_CYCLES), (True, WORST_CYCLES_AHEAD)])
def test_the_dearest_of_many_ticks_stays_within_its_cycles(
    built: tuple[bytes, dict[str, int]], ahead: bool, worst: int
) -> None:
    found = CORE_COST.random_cycles(built, 40, 500, ahead=ahead)
    say(
        f"{len(found)} random ticks{', looking ahead' * ahead}: median {np.median(found):.0f}, "
        f"worst {max(found)} cycles, no wait states"
    )
    assert len(found) >= 20_000
    assert max(found) <= worst


def test_a_transition_that_does_not_hold_stays_within_its_cycles(built: tuple[bytes, dict[str, int]]) -> None:
    few, many = (float(np.median(CORE_COST.full_cycles(built, count, 0))) for count in (0, 48))
    assert 0 < many - few <= 48 * TRANSITION_CYCLES


@pytest.mark.slow
def test_no_tick_is_late_in_uploading_and_pressing_for_long() -> None:
    load = BOARD.run_load(_m0.build(_m0.CONTROLLER), LOAD_TICKS, BOARD.rate_settings(250, 25))
    say(f"{load}")
    assert load.ticks >= LOAD_TICKS
    assert load.late == 0
    assert load.lost_records == 0
