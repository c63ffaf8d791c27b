"""What tests of jobs share: short orders, and waiting for what happens."""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any

from fdvv.rendering.settings import CompensateSettings, TuneSettings
from fdvv_studio.studio.jobs.events import JobEvent, PressEvent
from fdvv_studio.studio.jobs.file import JobRow
from fdvv_studio.studio.jobs.jobs import Jobs
from fdvv_studio.studio.jobs.orders import CompensateOrder, TuneOrder

DEVICES = ("twin", "host")
PATIENCE_s = 40.0
PRESSES = 60
"""Of long_learning."""


def learning(settings: dict[str, Any] | None = None, **changed: Any) -> CompensateOrder:
    """A short job: one speed, few presses."""
    short = CompensateSettings(**{"velocities_mm_s": (100.0,), "rounds": 1, **(settings or {})})
    about = {"button": "builtin:mx-clear", "name": "clear", "settings": short, "probe_presses": 1}
    return CompensateOrder(**{**about, **changed})


def long_learning(**changed: Any) -> CompensateOrder:
    """A job that takes many presses, so that it can be stopped on its way."""
    return learning({"method": "paper", "rounds": 2, "presses": PRESSES // 2}, **changed)


def tuning(**changed: Any) -> TuneOrder:
    """A short tuning."""
    short = TuneSettings(velocities_mm_s=(100.0,), comparisons=2)
    about = {"button": "builtin:mx-clear", "name": "clear tuned", "settings": short}
    return TuneOrder(**{**about, **changed})


class Follower:
    """Follows the events of one job; waits for one of them, or for the end."""

    def __init__(self, jobs: Jobs, job: str, from_event: int = 0) -> None:
        self.events: list[JobEvent] = []
        self.numbers: list[int] = []
        self._news = threading.Condition()
        self._jobs, self._job = jobs, job
        self.end = jobs.job(job).listen(from_event, self._heard)

    def _heard(self, number: int, events: Sequence[JobEvent]) -> None:
        with self._news:
            self.numbers += range(number, number + len(events))
            self.events += events
            self._news.notify_all()

    def wait(self, wanted: Callable[[JobEvent], bool]) -> JobEvent:
        """Wait for an event that is wanted."""
        with self._news:
            assert self._news.wait_for(lambda: any(map(wanted, self.events)), PATIENCE_s), self.events[-3:]
            return next(event for event in self.events if wanted(event))

    @property
    def learned_from(self) -> int:
        """Presses that were used to learn from, so far."""
        pressed = (e for e in self.events if isinstance(e, PressEvent) and e.stage == "compensate")
        return max((event.done for event in pressed), default=0)

    def over(self) -> JobRow:
        """Wait until the job is over for now; return its row."""
        start = self._jobs.job(self._job).start
        if start:
            start.wait(PATIENCE_s)
        return self._jobs.job(self._job).row
