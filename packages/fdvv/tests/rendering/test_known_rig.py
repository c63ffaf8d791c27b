"""The first presses on a rig that is known from a file say when it is another one. Simulated."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin
from fdvv.rendering.compensate import CompensationResult, compensate
from fdvv.rendering.known_rig import CHECKED_presses
from fdvv.rendering.probe import probe
from fdvv.rendering.session_run import Guide, PressDone
from fdvv.twin.files import load_rig
from fdvv.twin.rig import Rig

CLEAR, RED = load_builtin("mx-clear"), load_builtin("mx-red")
WITH_CELL = load_rig("recommended")
WITHOUT = replace(WITH_CELL, load_cell=replace(WITH_CELL.load_cell, fitted="no"))
SPEEDS_mm_s = [50.0, 100.0]


@pytest.fixture(scope="module", params=[WITH_CELL, WITHOUT], ids=["cell", "no cell"])
def rig(request: pytest.FixtureRequest) -> Rig:
    found: Rig = request.param
    return found


@pytest.fixture(scope="module")
def at_once(rig: Rig) -> CompensationResult:
    """Return a table for another button, computed from what a rig was known by, without a press."""
    met = compensate(TwinDevice(rig, seed=1), CLEAR, [50.0, 100.0, 150.0, 200.0], RigAware(rounds=0))
    return compensate(TwinDevice(rig), RED, SPEEDS_mm_s, RigAware(0, met.learned_rig))


def rougher(rig: Rig) -> Rig:
    return replace(rig, mover=replace(rig.mover, coulomb_N=rig.mover.coulomb_N + 0.06))


def judged(table: CompensationResult, rig: Rig, seed: int) -> tuple[list[str], list[int]]:
    """Probe a table on a rig; return the notices, and how many presses had been made at each."""
    notices, presses, made = list[str](), list[int](), 0

    def press(_done: PressDone) -> None:
        nonlocal made
        made += 1

    def notice(text: str) -> None:
        notices.append(text)
        presses.append(made + 1)  # it is called before the press is reported

    about = ("", None, Guide(notice=notice), table.outcome.tuning)
    device = TwinDevice(rig, seed=seed)
    probe(device, RED, table.surface, SPEEDS_mm_s, 2, press, *about, known_rig=table.known_rig)
    return notices, presses


def test_the_same_rig_under_other_hands_says_nothing(rig: Rig, at_once: CompensationResult) -> None:
    assert at_once.presses == 0
    for seed in (5, 6, 7):
        assert judged(at_once, rig, seed)[0] == []


def test_another_rig_is_noticed_within_two_presses_with_what_differs_and_what_to_do(
    rig: Rig, at_once: CompensationResult
) -> None:
    (line,), (after,) = judged(at_once, rougher(rig), 5)
    assert after <= CHECKED_presses
    assert line.startswith("warning: the rig is not as its file says: ")
    assert "friction rose" in line
    assert line.endswith("leave out its rig file to identify it anew")
