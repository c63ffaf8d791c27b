"""How far a job is, as its events tell."""

from __future__ import annotations

import dataclasses
from dataclasses import dataclass

from fdvv_studio.studio.jobs import events
from fdvv_studio.studio.jobs.events import JobEvent
from fdvv_studio.studio.jobs.file import JobState


@dataclass(frozen=True)
class JobProgress:
    """How far a job is, as its events tell.

    question : number of the one that waits for an answer; 0 if none does. stage : as its events name it.
    """

    state: JobState = "waiting"
    now: str = ""
    done: int = 0
    total: int = 0
    question: int = 0
    stage: str = ""

    def after(self, event: JobEvent) -> JobProgress:
        """Return the progress after an event."""
        stage = event.stage if isinstance(event, events.StageEvent) else self.stage
        return dataclasses.replace(self._after(event), stage=stage)

    def _after(self, event: JobEvent) -> JobProgress:
        match event:
            case events.StageEvent():
                return JobProgress("running", event.text)
            case events.PressEvent():
                now = f"{event.velocity_mm_s:g} mm/s: {event.skipped or event.summary}".rstrip(": ")
                return JobProgress("running", now, event.done, event.total)
            case events.PressAsked():
                now = f"press at {event.velocity_mm_s:g} mm/s"
                return JobProgress("needs you", now, event.number - 1, event.total)
            case events.TakeAsked():
                return JobProgress("needs you", "follow the cue", event.number - 1, event.total)
            case events.TakeEvent():
                now = f"take {event.number}: {event.reason or 'good'}"
                return JobProgress("running", now, event.done, event.total)
            case events.QuestionAsked():
                now = f"question {event.number} of {event.total} at most"
                return JobProgress("needs you", now, event.number - 1, event.total, event.number)
            case events.QuestionAnswered():
                return JobProgress("running", f"answer {event.number} is kept", event.number, event.total)
            case events.JobOutcome():
                return JobProgress("running", event.headline or event.sentence, self.done, self.total)
        started = self.state != "waiting"
        return self if started else dataclasses.replace(self, state="running", question=0)
