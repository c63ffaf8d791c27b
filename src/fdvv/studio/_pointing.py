"""The task that a person plays on the page: temporal pointing, timed exactly."""

from __future__ import annotations

from fdvv.errors import InputError
from fdvv.optimize import TemporalPointing
from fdvv.workflow import OptimizeSetup

TASK = "temporal-pointing"


def playable(setup: OptimizeSetup) -> bool:
    """Tell whether a person can play a run's task on the page."""
    return setup.task == TASK


def require_player(setup: OptimizeSetup, simulated: bool) -> None:
    """Refuse to mix presses of people with simulated ones in a run. InputError."""
    if setup.simulated is not simulated:
        who = "a simulated person" if setup.simulated else "a person"
        raise InputError("optimise", "player", f"{who} plays this run", "begin another run")


def pointing_of(setup: OptimizeSetup) -> TemporalPointing:
    """Give the task of a run as the page plays it. InputError if it is another one.

    The clocks tell times, not frames of a strip, so nothing is rounded to them.
    """
    if not playable(setup):
        raise InputError("optimise", setup.task, "is not played on the page", "use fdvv optimize")
    also = tuple(one.name for one in setup.objectives[1:])
    return TemporalPointing(setup.level or "easy", setup.presses, quantised=False, also=also)
