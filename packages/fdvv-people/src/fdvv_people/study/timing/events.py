"""What happens in a timing session, event by event: plain, validation by code only.

With the plan these records determine the state of the session. They do not tell what a code hides.
"""

from __future__ import annotations

from typing import ClassVar, Literal

from fdvv_people.study.plan.events import SessionEvent
from fdvv_people.study.timing.schedule import TimingFace
from fdvv_people.task.rounds import RoundTiming
from fdvv_people.task.score import Score
from fdvv_people.task.task import TaskPress

Surface = Literal["page", "device", "table", "simulated"]
"""What is pressed: a button that this machine simulates, a device, a switch or key, or nothing real."""


class TimingStarted(SessionEvent, frozen=True):
    """The session started, with its trials. seed : of what the engine draws."""

    word: ClassVar[str] = "began"
    person: str
    language: str
    seed: int
    trials: tuple[TimingFace, ...]
    simulated: bool = False


class ButtonDesigned(SessionEvent, frozen=True):
    """The engine, origin, suggested the design of a training trial, which nobody has pressed yet."""

    word: ClassVar[str] = "designed"
    number: int
    design: dict[str, float]
    origin: str


class SwitchPlaced(SessionEvent, frozen=True):
    """The switch or key of a trial is under the hand."""

    word: ClassVar[str] = "placed"
    number: int


class TimedBegun(SessionEvent, frozen=True):
    """A trial was begun, or went on.

    attempt : 1, and one more each time it went on or was begun again. on : what is pressed.
    """

    word: ClassVar[str] = "begun"
    number: int
    attempt: int
    on: Surface


class RoundKept(SessionEvent, frozen=True):
    """One round: a press of pointing, or a second of tapping.

    attempt : of the trial, as it was begun. round : from 1, of those that count. target_s : when the target
    was seen; None of tapping. activations_s : when the key went down, rising. Both on the clock of
    timing.source.
    """

    word: ClassVar[str] = "round"
    number: int
    attempt: int
    round: int
    target_s: float | None
    activations_s: tuple[float, ...]
    timing: RoundTiming

    @property
    def press(self) -> TaskPress:
        """Return it as tasks score it."""
        return TaskPress(self.target_s, self.activations_s)


class TimedScored(SessionEvent, frozen=True):
    """All rounds of a trial are there; what they score."""

    word: ClassVar[str] = "scored"
    number: int
    scores: dict[str, Score]


class DesignFailed(SessionEvent, frozen=True):
    """The design of a training trial cannot be rendered or scored; the engine avoids it."""

    word: ClassVar[str] = "failed"
    number: int
    reason: str


class TrainingEnded(SessionEvent, frozen=True):
    """The training is over, and the gap begins."""

    word: ClassVar[str] = "trained"
