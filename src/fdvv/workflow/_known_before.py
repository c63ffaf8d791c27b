"""A rig that is known before a session: does it still hold, and what is kept for the next one."""

from __future__ import annotations

from typing import Any

from fdvv.compensate import KnownRig, Method, RigAware, RigMemory, drifted
from fdvv.errors import FitError
from fdvv.model import Press
from fdvv.workflow._session_events import PressDone, Progress
from fdvv.workflow._session_log import PressLog
from fdvv.workflow._session_run import Course

REMEDY = "leave out what was known of it and it is identified again"


def remembered(method: Method[Any], state: Any) -> RigMemory | None:
    """Give what a rig has taught a method; None of a method that keeps nothing beyond its tables."""
    return method.remembered(state) if isinstance(method, RigAware) else None


def drift_told(method: Method[Any], course: Course[Any], log: PressLog) -> Progress:
    """Give a course's progress that holds the first press used on a rig known before against what is known.

    What has changed is told as a notice. A press that tells too little of it leaves that to the next; a
    session that goes on has been told already.
    """
    memory = method.memory if isinstance(method, RigAware) else None
    if memory is None or log.used:
        return course.progress
    known, asked = memory.known, False

    def told(done: PressDone) -> None:
        nonlocal asked
        if not asked and done.press is not None and not done.skipped:
            change = _change(known, done.press, course.travel_mm)
            asked = change is not None
            if change:
                course.guide.notice(f"warning: the rig is not as it was known: {change}; {REMEDY}")
        course.progress(done)

    return told


def _change(known: KnownRig, press: Press, travel_mm: float) -> str | None:
    """Tell what has changed, empty text if nothing has; None if the press tells too little."""
    try:
        return drifted(known, press, travel_mm)
    except FitError:
        return None
