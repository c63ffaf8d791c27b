"""A rig with a load cell whose loop is too slow or too late renders by tables, and says so."""

from __future__ import annotations

from dataclasses import replace

import pytest

from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.model.file import load_builtin
from fdvv.rendering.compensate import compensate
from fdvv.rendering.session_run import Guide
from fdvv.twin.files import load_rig
from fdvv.twin.rig import Rig

BUTTON = load_builtin("mx-clear")


def celled(tick_s: float, mass_kg: float) -> Rig:
    """The recommended rig with another loop and mover."""
    rig = load_rig("recommended")
    control = replace(rig.controller, tick_s=tick_s, compute_s=1e-5 * round(3e4 * tick_s))
    return replace(rig, controller=control, mover=replace(rig.mover, mass_kg=mass_kg))


@pytest.mark.slow
def test_where_no_gain_is_stable_the_session_goes_on_by_tables_without_losing_a_press() -> None:
    made: list[str] = []
    learned = compensate(
        TwinDevice(celled(2e-3, 0.04)),
        BUTTON,
        [50.0, 100.0],
        RigAware(rounds=1),
        progress=lambda done: made.append(done.message),
    )
    assert (learned.outcome.presses, learned.skipped) == (6, ())
    assert learned.outcome.tuning.loop is None
    assert learned.outcome.sentence.startswith("rendered by tables, not by the loop: gain")
    assert any("no gain of the force loop is stable" in message for message in made)
    assert learned.learned_rig is not None


def test_a_loop_below_500_Hz_says_before_the_first_press_that_it_learns_tables() -> None:
    notices: list[str] = []
    learned = compensate(
        TwinDevice(celled(4e-3, 0.012)),
        BUTTON,
        [50.0],
        RigAware(rounds=1),
        guide=Guide(notice=notices.append),
    )
    assert notices == [
        "a loop of 250 Hz is too slow to hold the force by the load cell (it takes 500): "
        "tables are learned instead"
    ]
    assert learned.method.startswith("rig-aware")
