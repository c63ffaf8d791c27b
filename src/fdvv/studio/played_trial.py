"""A trial that a person plays: every round on the disk before the next, the score after the last."""

from __future__ import annotations

from contextlib import AbstractContextManager
from pathlib import Path
from typing import Protocol

from fdvv.errors import InputError, ModelError
from fdvv.optimize import Trial, TrialState
from fdvv.studio._messages_play import PlayKept, PlayRound
from fdvv.studio._pointing import pointing_of, require_player
from fdvv.workflow import OptimizeSession, PlayedRounds, RoundTiming


class Runs(Protocol):
    """What those who play need of the runs."""

    def session(self, run: int) -> AbstractContextManager[OptimizeSession]:
        """Give a run to one thread at a time."""
        ...

    def hold(self, run: int) -> object:
        """Keep its folder for this studio."""
        ...

    def leave(self, run: int) -> None:
        """Undo hold()."""
        ...

    def folder(self, run: int) -> Path:
        """Give its folder."""
        ...

    def announce(self, run: int) -> None:
        """Tell that it changed."""
        ...


class PlayedTrial:
    """One beginning of one trial.

    Attributes
    ----------
    model : the button under test. seed : of everything random in its simulation.
    task : what is played. attempt : how often the trial was begun.

    Raises InputError if the trial has come to its end, or the run's task is not played here.
    """

    def __init__(self, runs: Runs, run: int, number: int) -> None:
        self._runs, self._run, self._number = runs, run, number
        self._over = False
        runs.hold(run)
        try:
            with runs.session(run) as session:
                require_player(session.setup, simulated=False)
                self.task, self.seed = pointing_of(session.setup), session.setup.seed
                trial = _open_trial(session, number)
                self.model = session.model(trial.design, f"trial {number + 1}")
                self._rounds = PlayedRounds(runs.folder(run))
                if trial.state is TrialState.SUGGESTED:
                    session.show(number)
            self.attempt = self._rounds.begin(number)
        except BaseException:
            runs.leave(run)
            raise

    def keep(self, target_s: float, activations_s: tuple[float, ...], timing: RoundTiming) -> bool:
        """Keep a round; after the last one score the trial and give True. InputError if it is over."""
        if self._over:
            raise InputError("optimise", f"trial {self._number + 1}", "is played elsewhere", "begin it again")
        self._rounds.add(self._number, target_s, activations_s, timing)
        counting = self._rounds.counting(self._number)
        if len(counting) < self.task.rounds:
            return False
        with self._runs.session(self._run) as session:
            try:
                session.done(self._number, self.task.scores([one.press for one in counting]))
            except ModelError as error:
                session.fail(self._number, str(error))
        return True

    def over(self, ask: PlayRound, activations_s: tuple[float, ...], timing: RoundTiming) -> PlayKept:
        """Keep a round that the page tells of, with what was pressed in it; InputError as of keep()."""
        target_s = (ask.target_ms + ask.display.ms) / 1e3
        finished = self.keep(target_s, activations_s, timing)
        late_ms = 1e3 * (activations_s[0] - target_s) if activations_s else None
        return PlayKept(ask.number, late_ms, timing.transport_ms, finished)

    def fail(self, reason: str) -> None:
        """Keep that this design cannot be played, and let go of the run."""
        with self._runs.session(self._run) as session:
            session.fail(self._number, reason)
        self.close()

    def close(self) -> None:
        """Let go of the run; rounds of an unfinished trial are kept and do not count."""
        if not self._over:
            self._over = True
            self._rounds.close()
            self._runs.leave(self._run)
            self._runs.announce(self._run)


def _open_trial(session: OptimizeSession, number: int) -> Trial:
    """Give a trial that may be played. InputError."""
    trials = session.trials
    if not 0 <= number < len(trials):
        raise InputError("optimise", f"trial {number + 1}", "there is none", "ask for the next one")
    trial = trials[number]
    if trial not in open_trials(session):
        raise InputError("optimise", f"trial {number + 1}", f"is {trial.state}", "ask for the next one")
    return trial


def open_trials(session: OptimizeSession) -> tuple[Trial, ...]:
    """Give the trials that are suggested or under way."""
    return tuple(one for one in session.trials if one.state in (TrialState.SUGGESTED, TrialState.SHOWN))
