"""A trial that a person plays: every round on the disk before the next, the score after the last."""

from __future__ import annotations

from typing import TYPE_CHECKING, Annotated, Literal

from msgspec import Meta

from fdvv.errors import InputError, ModelError
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.task.pointing import TemporalPointing
from fdvv_people.task.rounds import ClockSource, RoundTiming, TaskRounds
from fdvv_people.task.task import TaskPress
from fdvv_studio.studio.contract import Message

if TYPE_CHECKING:
    from fdvv_people.pages.optimizations import Optimizations

Count = Annotated[int, Meta(ge=0, le=2**31)]
Time = Annotated[float, Meta(ge=0, le=1e12)]
Delay = Annotated[float, Meta(ge=0, le=1000)]
Hand = Literal["key", "analog", "mouse", "touch", "pen", "button"]


class PlayDelay(Message):
    """A delay and how far it may be off."""

    ms: Delay
    error_ms: Delay


class RoundOver(Message):
    """A round is over: what times it, of every task.

    start_ms, end_ms : presses between count.
    display : from drawing to light. input : from finger to the browser's event.
    clock_ms, clock_error_ms : the server's clock less the page's; None where it is not known yet.
    frame_ms : between two pictures. hand, input : of a device's key "button" and nothing: it has its own.
    """

    number: Count
    start_ms: Time
    end_ms: Time
    hand: Hand
    display: PlayDelay
    input: PlayDelay
    clock_ms: Annotated[float, Meta(ge=-1e15, le=1e15)] | None
    clock_error_ms: Delay | None
    frame_ms: Delay

    def timing(
        self, source: ClockSource, pressed: PlayDelay, transport_ms: float | None, hand: str
    ) -> RoundTiming:
        """Return how the round was timed. pressed : delay from the finger to what reports a press."""
        return RoundTiming(
            source,
            self.display.ms,
            self.display.error_ms,
            pressed.ms,
            pressed.error_ms,
            self.clock_ms,
            self.clock_error_ms,
            transport_ms,
            self.frame_ms,
            hand,
        )


class PlayRound(RoundOver, tag="round"):
    """A round is over: keep it. target_ms : when the target was drawn."""

    target_ms: Time


class PlayStrip(Message):
    """The strip of temporal pointing, in pixels from where bullets start."""

    pixels: int
    zone_px: int
    zone_half_px: int
    speed_px_s: float


def strip_of(task: TemporalPointing) -> PlayStrip:
    """Return the strip on which a task is played."""
    half_px = int(task.zone_px // 2)
    return PlayStrip(round(task.strip_px), round(task.target_px), half_px, task.speed_px_s)


class PlayKept(Message, tag="kept"):
    """A round is on the disk.

    late_ms : of the key against the target, None if it did not go down. transport_ms : from hand to
    simulation, taken out; None without a press, and of a device.
    """

    number: int
    late_ms: float | None
    transport_ms: float | None
    finished: bool


TASK = "temporal-pointing"


def playable(setup: OptimizeSetup) -> bool:
    return setup.task == TASK


def require_player(setup: OptimizeSetup, simulated: bool) -> None:
    """Refuse to mix presses of people with simulated ones in a run. InputError."""
    if setup.simulated is not simulated:
        who = "a simulated person" if setup.simulated else "a person"
        raise InputError("optimise", "player", f"{who} plays this run", "begin another run")


def pointing_of(setup: OptimizeSetup) -> TemporalPointing:
    """Return the task of a run as the page plays it. InputError if it is another one.

    The clocks tell times, not frames of a strip, so nothing is rounded to them.
    """
    if not playable(setup):
        raise InputError("optimise", setup.task, "is not played on the page", "use fdvv optimize")
    return TemporalPointing(setup.level or "easy", setup.presses, quantised=False, also=setup.task_also)


class PlayedTrial:
    """One beginning of one trial.

    model : the button under test. seed : of everything random in its simulation.
    task : what is played. attempt : how often the trial was begun.

    Raises InputError if the trial has come to its end or waits for answers, or the run's task is not played
    here.
    """

    def __init__(self, runs: Optimizations, run: int, number: int) -> None:
        self._runs, self._run, self._number = runs, run, number
        self._over = False
        runs.hold(run)
        try:
            with runs.session(run) as session:
                require_player(session.setup, simulated=False)
                self.task, self.seed = pointing_of(session.setup), session.setup.seed
                trial = _open_trial(session, number)
                self._asks = session.setup.asks_liking
                self.model = session.button(trial, f"trial {number + 1}")
                self._rounds = TaskRounds(runs.folder(run))
                try:
                    self.attempt = self._begin(session, trial)
                except BaseException:
                    self._rounds.close()
                    raise
        except BaseException:
            runs.leave(run)
            raise

    def _begin(self, session: Optimization, trial: Trial) -> int:
        """Begin the trial, or begin it again; return how often it was. InputError if it waits for answers."""
        if self._asks and self._all_pressed():
            raise InputError("optimise", f"trial {trial.number + 1}", "waits for answers", "rate it first")
        if trial.state is TrialState.SUGGESTED:
            session.show(trial.number)
        return self._rounds.begin(trial.number)

    def _all_pressed(self) -> bool:
        return len(self._rounds.counting(self._number)) >= self.task.rounds

    def keep(self, ask: PlayRound, activations_s: tuple[float, ...], timing: RoundTiming) -> PlayKept:
        """Keep a round with what was pressed in it; score the trial after the last. InputError.

        A trial with a questionnaire is not scored before it is answered.
        """
        if self._over:
            raise InputError("optimise", f"trial {self._number + 1}", "is played elsewhere", "begin it again")
        target_s = (ask.target_ms + ask.display.ms) / 1e3
        self._rounds.add(self._number, target_s, activations_s, timing)
        finished = self._all_pressed()
        if finished and not self._asks:
            self._score([one.press for one in self._rounds.counting(self._number)])
        late_ms = 1e3 * (activations_s[0] - target_s) if activations_s else None
        return PlayKept(ask.number, late_ms, timing.transport_ms, finished)

    def _score(self, presses: list[TaskPress]) -> None:
        with self._runs.session(self._run) as session:
            try:
                session.answer(self._number, self.task.scores(presses))
            except ModelError as error:
                session.give_up(self._number, str(error))

    def fail(self, reason: str) -> None:
        """Keep that this design cannot be played, and let go of the run."""
        with self._runs.session(self._run) as session:
            session.give_up(self._number, reason)
        self.close()

    def close(self) -> None:
        """Release the run; rounds of an unfinished trial are kept and do not count."""
        if not self._over:
            self._over = True
            self._rounds.close()
            self._runs.leave(self._run)
            self._runs.announce(self._run)


def _open_trial(session: Optimization, number: int) -> Trial:
    trial = session.trial(number)
    if trial is None:
        raise InputError("optimise", f"trial {number + 1}", "there is none", "ask for the next one")
    if not trial.is_open:
        raise InputError("optimise", f"trial {number + 1}", f"is {trial.state}", "ask for the next one")
    return trial
