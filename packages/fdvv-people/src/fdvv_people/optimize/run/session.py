"""An optimisation in a folder: what is asked, shown and answered, each on the disk before it counts."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import require_new_folder, write_atomic
from fdvv.rendering.rig_catalog import RigCatalog
from fdvv_people.optimize.engines.registry import check_engine
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.run.blocks import in_drawn_order
from fdvv_people.optimize.run.compromise import keep_choice
from fdvv_people.optimize.run.ledger import LEDGER_FILE, Ledger
from fdvv_people.optimize.run.memory import RunMemory
from fdvv_people.optimize.run.setup import SETUP_FILE, OptimizeSetup, read_setup, setup_text, stated
from fdvv_people.optimize.run.state import RETEST, START, RunState
from fdvv_people.optimize.space import Design
from fdvv_people.task.score import Score


class Optimization(RunState):
    """A run that can be killed at any moment and continued without loss: it asks, shows and records.

    Made by `create` or `open`, for one process at a time; a context manager.
    """

    def __init__(
        self, folder: Path, setup: OptimizeSetup, ledger: Ledger, memory: RunMemory | None = None
    ) -> None:
        super().__init__(folder, setup, ledger, memory)
        self._given: set[int] = set()

    @classmethod
    def create(cls, folder: Path, setup: OptimizeSetup, project: Path | None = None) -> Optimization:
        """Begin a run in a folder that is new or empty. Raises InputError, BuildError, OSError.

        project : where the rig that the setup names is known; it is copied into the run's folder.
        """
        folder = Path(folder)
        require_new_folder(folder, "name a new one, or resume the run in it")
        check_engine(setup.engine, setup.task)
        checked = cls(project or folder, setup, Ledger())
        if setup.space.rig and project:
            RigCatalog(project).lend(setup.space.rig, folder)
        write_atomic(folder / SETUP_FILE, setup_text(stated(setup, checked.space)))
        return cls.open(folder)

    @classmethod
    def open(cls, folder: Path, memory: RunMemory | None = None) -> Optimization:
        """Continue a run. Raises InputError where there is none, or it is damaged or in use.

        memory : what its models said when it was open before; None: nothing is known of that.
        """
        folder = Path(folder)
        setup = read_setup(folder / SETUP_FILE)
        ledger = Ledger(folder / LEDGER_FILE)
        try:
            return cls(folder, setup, ledger, memory)
        except BaseException:
            ledger.close()
            raise

    def ask(self, count: int = 1) -> tuple[Trial, ...]:
        """Return the next trials, at most count: first those left open by an earlier run, then new ones.

        New ones are on the disk when this returns, and each is suggested knowing those before it. Behind the
        budget come those of the retest. Empty once all are played.
        """
        open_ = [trial for trial in self.open_trials if trial.number not in self._given]
        trials = open_[:count]
        while len(trials) < count and (trial := self._next_trial()):
            trials.append(trial)
        self._given |= {trial.number for trial in trials}
        return tuple(trials)

    def next_trial(self) -> Trial | None:
        """Return the trial that is open, else the next one; None once all are played."""
        return next(iter(self.open_trials or self.ask()), None)

    def _next_trial(self) -> Trial | None:
        """Suggest a trial of the search, then of the retest."""
        if not self.left:
            return self._retest() if self.searched and self.retest_left else None
        if self.setup.start is not None and not self.trials and not self.setup.preference:
            return self._ledger.suggest([self.space.checked(self.setup.start)], START)
        return self._ledger.suggest(self.engine.suggest(self.problem, self.trials), self.engine.name)

    def _retest(self) -> Trial:
        """Suggest a trial of the retest.

        Each block has the start, the recommended design and every rival once, in an order that is drawn: who
        plays does not know which is which. Where designs are compared a block is one trial.
        """
        played, count = self._played(), len(self.retests)
        if self.setup.preference:
            designs = [one.design for one in in_drawn_order(played, self.setup.seed, count)]
            return self._ledger.suggest(designs, RETEST)
        block, place = divmod(count, len(played))
        one = in_drawn_order(played, self.setup.seed, block)[place]
        return self._ledger.suggest([one.design], RETEST, one.rival)

    def edit(self, number: int, design: Design) -> Trial:
        """Put a person's own design in the place of a suggestion that was not shown yet.

        InputError where it leaves the space or breaks a constraint.
        """
        checked = self.space.checked(design)
        for one in self.space.broken(checked):
            raise InputError("design", one.name, f"it does not hold: {one.text}", "change the design")
        return self._ledger.edit(number, checked)

    def show(self, number: int) -> Trial:
        """Record that a trial is being tried."""
        return self._ledger.become(number, TrialState.SHOWN)

    def answer(self, number: int, answer: Mapping[str, Score] | Sequence[int]) -> Trial:
        """Record the scores of a trial, or which of its designs are liked best, from 0.

        InputError on one of the run's objectives that is missing, on a design that the trial does not have,
        on the other kind of answer, and where it was answered before.
        """
        trial = self.trial(number)
        chosen = not isinstance(answer, Mapping)
        if trial is not None and chosen is not bool(trial.beside):
            wanted = "which of its designs is best" if trial.beside else "its scores"
            raise InputError("answer", f"trial {number}", "is of another kind", f"say {wanted}")
        if not isinstance(answer, Mapping):
            if not answer:
                raise InputError("answer", f"trial {number}", "names no design", "say which is best")
            return self._ledger.become(number, TrialState.DONE, best=answer)
        for one in self.problem.objectives:
            if one.name not in answer:
                raise InputError("scores", one.name, "is missing", f"score trial {number} in every objective")
        return self._ledger.become(number, TrialState.DONE, dict(answer))

    def give_up(self, number: int, reason: str = "", failed: bool = True) -> Trial:
        """Record that a trial has no answer.

        failed : it could not be tried or scored, and designs near it are avoided; else it was stopped, and
        does not count.
        """
        return self._ledger.become(
            number, TrialState.FAILED if failed else TrialState.ABANDONED, reason=reason
        )

    def take(self, number: int) -> Trial:
        """Recommend another trial of the front, on the disk when this returns.

        InputError before the search is over, once its retest has begun, and on what is not on the front.
        """
        if not self.setup.several or not self.searched or self.retests:
            reason = "a compromise is chosen between the search and its retest"
            raise InputError("run", "compromise", reason, "choose it then, in a run of several objectives")
        return keep_choice(self.front(), number, self.folder)

    def close(self) -> None:
        self._ledger.close()

    def __enter__(self) -> Optimization:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
