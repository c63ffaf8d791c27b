"""The optimisations of a project: opened while somebody uses them, told to every page that looks."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from threading import Lock, RLock

from msgspec import Struct

from fdvv.errors import InputError
from fdvv.optimize import TrialState
from fdvv.studio._messages_optimize import OptimizeChanged
from fdvv.studio._played_trial import PlayedTrial
from fdvv.studio._pointing import require_player
from fdvv.studio._simulated_play import SimulatedPlay
from fdvv.studio._studio import Studio
from fdvv.studio._watchers import Watchers
from fdvv.workflow import OptimizeSession, OptimizeSetup

FOLDER = "optimize"


@dataclass(eq=False)
class Held:
    """A session that somebody uses, and by how many."""

    session: OptimizeSession | None = None
    users: int = 0
    lock: RLock = field(default_factory=RLock)


class Optimizations:
    """The runs in ``optimize/NUMBER`` of a project."""

    def __init__(self, studio: Studio) -> None:
        self._project, self._folder = studio.project, studio.project / FOLDER
        self._held: dict[int, Held] = {}
        self._played: dict[int, PlayedTrial] = {}
        self._simulated: dict[int, SimulatedPlay] = {}
        self._found: dict[int, tuple[int, dict[str, float]]] = {}
        self.watchers = Watchers[Struct]()
        # whoever is inside a session may take this one, so nobody who has it waits for a session
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
            OptimizeSession.create(self._folder / str(run), setup, self._project).close()
        self.announce(run)
        return run

    def folder(self, run: int) -> Path:
        """Give the folder of a run that there is. InputError."""
        if run not in self.runs():
            raise InputError("optimise", f"run {run}", "there is none", "choose one from the list")
        return self._folder / str(run)

    @contextmanager
    def session(self, run: int) -> Iterator[OptimizeSession]:
        """Give a run to one thread at a time; its folder is held as long as anybody uses it. InputError."""
        held = self.hold(run)
        try:
            with held.lock:
                held.session = held.session or OptimizeSession.open(self._folder / str(run))
                yield held.session
        finally:
            self.leave(run)

    def hold(self, run: int) -> Held:
        """Keep a run's folder for this studio until leave(), once it was opened. InputError."""
        self.folder(run)
        with self._lock:
            held = self._held.setdefault(run, Held())
            held.users += 1
        return held

    def leave(self, run: int) -> None:
        """Undo hold()."""
        with self._lock:
            held = self._held[run]
            held.users -= 1
            if not held.users:
                del self._held[run]
                if held.session:
                    held.session.close()

    def play(self, run: int, trial: int) -> PlayedTrial:
        """Begin a trial, or begin it again; whoever plays this run elsewhere no longer does. InputError."""
        with self._turn:
            before = self._played.pop(run, None)
            if before:
                before.close()
            played = self._played[run] = PlayedTrial(self, run, trial)
        self.announce(run)
        return played

    def simulate(self, run: int, person: int, trials: int) -> None:
        """Have a simulated person play so many trials. InputError if one is, or a person plays."""
        with self.session(run) as session:
            require_player(session.setup, simulated=True)
        with self._lock:
            known = self._simulated.get(run)
            if known and known.running:
                raise InputError(
                    "optimise", f"run {run}", "a simulated person is at it", "stop that one first"
                )
            self._simulated[run] = SimulatedPlay(self, run, person, trials)

    def simulated(self, run: int) -> SimulatedPlay | None:
        """Give who plays a run, or played it last since the studio began."""
        with self._lock:
            return self._simulated.get(run)

    def found(self, run: int, session: OptimizeSession) -> dict[str, float] | None:
        """Give what a run recommends, anew once more is done: its engine's belief, or the front's knee."""
        done = sum(one.state is TrialState.DONE for one in session.trials)
        done += sum(one.answer is not None for one in session.comparisons)
        if not done:
            return None
        if self._found.get(run, (0, {}))[0] != done:
            several = len(session.problem.objectives) > 1
            self._found[run] = (done, session.front().knee().design if several else session.best())
        return self._found[run][1]

    def announce(self, run: int) -> None:
        """Tell all pages that a run changed."""
        self.watchers.tell(OptimizeChanged(run))

    def close(self) -> None:
        """End everything that is at work; what is on the disk stays."""
        simulated, played = list(self._simulated.values()), list(self._played.values())
        for person in simulated:
            person.close()
        for trial in played:
            trial.close()
