"""Does a rig fit the file it is known from? Asked of the first presses on it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from fdvv.compensation.identification.drift import find_drift
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import FitError, PartFault
from fdvv.model.press import Press
from fdvv.rendering.session_run import PressDone, Progress

CHECKED_presses = 2
"""A single press of the same rig showed a change in 2 of 85 cases without a cell (benchmarks.known_rig)."""
REMEDY = "it has changed, or is another one: leave out its rig file to identify it anew"


class RigCheck:
    """Holds the first presses on a rig against what is known of it.

    A press that the known rig cannot explain counts by itself, a change of some quantity only once each of
    the CHECKED_presses shows one: single presses of the same rig do now and then.
    loop_closed : presses are made with the force loop closed.
    """

    def __init__(self, rig: RigModel, travel_mm: float, loop_closed: bool) -> None:
        self._rig, self._travel_mm, self._loop_closed = rig, travel_mm, loop_closed
        self._summaries: list[str] = []
        self._over = False

    def difference(self, press: Press) -> PartFault | None:
        """Return what differs as far as this press shows it, at most once; None if nothing does.

        An uninformative press leaves the check to the next.
        """
        if self._over:
            return None
        with suppress(FitError):
            drift = find_drift(self._rig, press, self._travel_mm, loop_closed=self._loop_closed)
            self._summaries.append(drift.summary)
            whole = len(self._summaries) == CHECKED_presses
            differs = drift.unexplained or (whole and all(self._summaries))
            self._over = whole or differs
            seen = f"the rig is not as its file says: {drift.summary}"
            return PartFault(drift.part, seen, REMEDY) if differs else None
        return None


def with_rig_check(
    progress: Progress,
    notice: Callable[[str], None],
    rig: RigModel | None,
    travel_mm: float,
    loop_closed: bool,
) -> Progress:
    """Wrap what is called after every press, so that the first ones used are held against a known rig.

    notice : gets one line with what differs and what to do, at most once. rig : None checks nothing.
    """
    if rig is None:
        return progress
    check = RigCheck(rig, travel_mm, loop_closed)

    def check_press(done: PressDone) -> None:
        if done.press is not None and not done.skipped and (fault := check.difference(done.press)):
            notice(f"warning: {fault}")
        progress(done)

    return check_press
