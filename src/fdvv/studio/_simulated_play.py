"""A simulated person plays trials of a run, one after the other, in a thread of the server."""

from __future__ import annotations

import logging
from threading import Event, Thread

from fdvv.errors import FdvvError
from fdvv.optimize import SimulatedUser, TrialState, draw_users
from fdvv.studio._played_trial import Runs
from fdvv.studio._pointing import pointing_of
from fdvv.studio._told import told
from fdvv.workflow import score_design

log = logging.getLogger("fdvv.studio")


class SimulatedPlay:
    """Trials that a simulated person plays. What is done is in the run's ledger, whatever ends the studio.

    Attributes
    ----------
    person : seed of who plays. done, total : trials. running : whether still at it.
    fault : why it ended early; empty if it did not.
    """

    def __init__(self, runs: Runs, run: int, person: int, trials: int) -> None:
        self.person, self.done, self.total = person, 0, trials
        self.running, self.fault = True, ""
        self._runs, self._run = runs, run
        self._stop = Event()
        runs.hold(run)
        self._thread = Thread(target=self._play, name="simulated play", daemon=True)
        self._thread.start()

    def close(self) -> None:
        """Stop after the trial under way; waits until then."""
        self._stop.set()
        self._thread.join()

    def _play(self) -> None:
        try:
            (user,) = draw_users(1, self.person)
            while not self._stop.is_set() and self.done < self.total and self._one(user):
                self.done += 1
                self._runs.announce(self._run)
        except FdvvError as error:
            self.fault = told(error)
        except Exception:
            log.exception("a simulated play failed")
            self.fault = "it failed; the studio's terminal tells why"
        finally:
            self.running = False
            self._runs.leave(self._run)
            self._runs.announce(self._run)

    def _one(self, user: SimulatedUser) -> bool:
        """Play the next trial; False if there is none."""
        with self._runs.session(self._run) as session:
            task, seed = pointing_of(session.setup), session.setup.seed
            waiting = [one for one in session.trials if one.state is TrialState.SUGGESTED]
            trials = waiting[:1] or session.ask()
            if not trials:
                return False
            trial = session.show(trials[0].number)
            model = session.model(trial.design)
        before = task.rounds * trial.number
        scores = score_design(task, model, user, seed + trial.number, presses_before=before)
        with self._runs.session(self._run) as session:
            session.done(trial.number, scores)
        return True
