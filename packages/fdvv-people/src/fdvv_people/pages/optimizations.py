"""The optimisation runs of a project: open while in use, with their players, announced to every page."""

from __future__ import annotations

import logging
from collections import defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Event, Lock, RLock, Thread

from msgspec import Struct

from fdvv.errors import FdvvError, InputError
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.people.taste import Taste, draw_taste, rate
from fdvv_people.optimize.people.user import SimulatedUser, draw_users
from fdvv_people.optimize.problem import TrialState
from fdvv_people.optimize.run.memory import RunMemory
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup
from fdvv_people.pages.played_trial import PlayedTrial, pointing_of, require_player
from fdvv_people.task.questionnaire import LIKING, liking_score
from fdvv_studio.studio.contract import Message, Watchers, error_line
from fdvv_studio.studio.studio import Studio

log = logging.getLogger("fdvv_studio.studio")


class OptimizeChanged(Message, tag="changed"):
    """A run is not what it was."""

    run: int


class SimulatedPlay:
    """Trials that a simulated person plays. What is done is in the run's ledger, whatever ends the studio.

    person : seed of who plays. done, total : trials. running : whether still at it.
    fault : why it ended early; empty if it did not.
    """

    def __init__(self, runs: Optimizations, run: int, person: int, trials: int) -> None:
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
            (user,), taste = draw_users(1, self.person), draw_taste(0, self.person)
            while not self._stop.is_set() and self.done < self.total and self._one(user, taste):
                self.done += 1
                self._runs.announce(self._run)
        except FdvvError as error:
            self.fault = error_line(error)
        except Exception:
            log.exception("a simulated play failed")
            self.fault = "it failed; the studio's terminal tells why"
        finally:
            # who sees that it ended may open the folder
            self._runs.leave(self._run)
            self.running = False
            self._runs.announce(self._run)

    def _one(self, user: SimulatedUser, taste: Taste) -> bool:
        """Play the next trial; False if there is none."""
        with self._runs.session(self._run) as session:
            task, seed = pointing_of(session.setup), session.setup.seed
            waiting = [one for one in session.open_trials if one.state is TrialState.SUGGESTED]
            trial = next(iter(waiting or session.ask()), None)
            if trial is None:
                return False
            if trial.state is TrialState.SUGGESTED:
                trial = session.show(trial.number)
            model = session.button(trial)
        # the person learns from every press, so the trials before this one count; the session is left while
        # the trial is simulated, which takes long, so that pages can read the run
        before = task.rounds * trial.number
        scores = score_design(task, model, user, seed + trial.number, presses_before=before)
        with self._runs.session(self._run) as session:
            if session.setup.asks_liking:
                scores[LIKING.name] = liking_score(rate(model, taste, seed + trial.number))
            session.answer(trial.number, scores)
        return True


FOLDER = "optimize"


@dataclass(eq=False)
class OpenRun:
    """An open run and the number of its users."""

    session: Optimization | None = None
    users: int = 0
    lock: RLock = field(default_factory=RLock)


class Optimizations:
    """The runs in ``optimize/NUMBER`` of a project."""

    def __init__(self, studio: Studio) -> None:
        self._project, self._folder = studio.project, studio.project / FOLDER
        self._held: dict[int, OpenRun] = {}
        self._played: dict[int, PlayedTrial] = {}
        self._simulated: dict[int, SimulatedPlay] = {}
        self._memories = defaultdict[int, RunMemory](RunMemory)
        self.watchers = Watchers[Struct]()
        # a thread inside a session may take this lock, so its holder must not wait for a session
        self._lock = RLock()
        self._turn = Lock()

    def runs(self) -> list[int]:
        """List the numbers of all runs, the newest first."""
        if not self._folder.is_dir():
            return []
        names = [path.name for path in self._folder.iterdir() if path.is_dir()]
        return sorted((int(name) for name in names if name.isdecimal()), reverse=True)

    def create(self, setup: OptimizeSetup) -> int:
        """Begin a run. InputError, ModelError, BuildError, OSError."""
        with self._lock:
            run = max(self.runs(), default=0) + 1
            Optimization.create(self._folder / str(run), setup, self._project).close()
        self.announce(run)
        return run

    def folder(self, run: int) -> Path:
        """Return the folder of an existing run. InputError."""
        if run not in self.runs():
            raise InputError("optimise", f"run {run}", "there is none", "choose one from the list")
        return self._folder / str(run)

    @contextmanager
    def session(self, run: int) -> Iterator[Optimization]:
        """Open a run for one thread at a time; its folder stays locked while it is in use. InputError."""
        held = self.hold(run)
        try:
            with held.lock:
                held.session = held.session or Optimization.open(self._folder / str(run), self._memories[run])
                yield held.session
        finally:
            self.leave(run)

    def hold(self, run: int) -> OpenRun:
        """Keep a run's folder for this studio until leave(), once it was opened. InputError."""
        self.folder(run)
        with self._lock:
            held = self._held.setdefault(run, OpenRun())
            held.users += 1
        return held

    def leave(self, run: int) -> None:
        with self._lock:
            held = self._held[run]
            held.users -= 1
            if not held.users:
                del self._held[run]
                if held.session:
                    held.session.close()

    def play(self, run: int, trial: int) -> PlayedTrial:
        """Begin a trial, or begin it again, and end play of this run elsewhere. InputError."""
        with self._turn:
            before = self._played.pop(run, None)
            if before:
                before.close()
            played = self._played[run] = PlayedTrial(self, run, trial)
        self.announce(run)
        return played

    def simulate(self, run: int, person: int, trials: int) -> None:
        """Start a simulated person. InputError if one is at work, or a person plays this run."""
        with self.session(run) as session:
            require_player(session.setup, simulated=True)
        with self._lock:
            known = self._simulated.get(run)
            if known and known.running:
                reason = "a simulated person is at it"
                raise InputError("optimise", f"run {run}", reason, "stop that one first")
            self._simulated[run] = SimulatedPlay(self, run, person, trials)

    def simulated(self, run: int) -> SimulatedPlay | None:
        """Return the simulated player of a run, also after it ended; None if there was none."""
        with self._lock:
            return self._simulated.get(run)

    def take(self, run: int, trial: int) -> None:
        """Recommend another compromise of a run's front. InputError, see `Optimization.take`."""
        with self.session(run) as session:
            session.take(trial)
        self.announce(run)

    def announce(self, run: int) -> None:
        self.watchers.tell(OptimizeChanged(run))

    def close(self) -> None:
        """End everything that is at work; what is on the disk stays."""
        players: list[SimulatedPlay | PlayedTrial] = [*self._simulated.values(), *self._played.values()]
        for player in players:
            player.close()
