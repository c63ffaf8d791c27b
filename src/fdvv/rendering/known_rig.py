"""Does a rig fit the file it is known from? Asked of the first presses on it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress

from fdvv.compensation.identification.drift import detect_drift
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.errors import FitError
from fdvv.rendering.session_run import PressDone, Progress

CHECKED_presses = 2
"""A difference that the first press does not show stands out in the second, at another place of its noise."""
REMEDY = "it has changed, or is another one: leave out its rig file to identify it anew"


def with_rig_check(
    progress: Progress,
    notice: Callable[[str], None],
    rig: RigModel | None,
    travel_mm: float,
    loop_closed: bool,
) -> Progress:
    """Wrap what is called after every press, so that the first ones used are held against a known rig.

    notice : gets one line with what differs and what to do, at most once. rig : None checks nothing.
    loop_closed : presses are made with the force loop closed. An uninformative press leaves the check to the
    next.
    """
    if rig is None:
        return progress
    left = CHECKED_presses

    def checked(done: PressDone) -> None:
        nonlocal left
        if left and done.press is not None and not done.skipped:
            with suppress(FitError):
                change = detect_drift(rig, done.press, travel_mm, loop_closed=loop_closed)
                left -= 1
                if change:
                    left = 0
                    notice(f"warning: the rig is not as its file says: {change}; {REMEDY}")
        progress(done)

    return checked
