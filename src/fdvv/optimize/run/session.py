"""An optimisation in a folder: what is asked, shown and answered, each on the disk before it counts."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import require_new_folder, write_atomic
from fdvv.optimize.engines.registry import check_engine
from fdvv.optimize.problem import OPEN, Answer, Comparison, Line, Trial, TrialState
from fdvv.optimize.run.blocks import in_drawn_order
from fdvv.optimize.run.compromise import keep_choice
from fdvv.optimize.run.ledger import LEDGER_FILE, Ledger
from fdvv.optimize.run.memory import RunMemory
from fdvv.optimize.run.setup import SETUP_FILE, OptimizeSetup, read_setup, setup_text, stated
from fdvv.optimize.run.state import RETEST, START, RunState
from fdvv.optimize.space import Design
from fdvv.rendering.rig_catalog import RigCatalog
from fdvv.task.score import Score


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
        check_engine(setup.engine)
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

        New ones are on the disk when this returns, and each is suggested knowing those before it. Empty once
        the budget is spent. InputError where designs are compared, not scored.
        """
        self._scored()
        open_ = [t for t in self.trials if t.state in OPEN and t.number not in self._given]
        trials = open_[:count]
        while len(trials) < count and self.left:
            trials.append(self._suggested())
        self._given |= {trial.number for trial in trials}
        return tuple(trials)

    def _suggested(self) -> Trial:
        if self.setup.start is not None and not self.trials:
            return self._ledger.suggest(self.space.checked(self.setup.start), START)
        engine = self._scored()
        (design,) = engine.suggest(self.problem, self.trials)
        return self._ledger.suggest(design, engine.name)

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

    def done(self, number: int, scores: dict[str, Score]) -> Trial:
        """Record the scores of a trial. Raises InputError where one of the run's objectives is missing."""
        for one in self.problem.objectives:
            if one.name not in scores:
                raise InputError("scores", one.name, "is missing", f"score trial {number} in every objective")
        return self._ledger.become(number, TrialState.DONE, scores)

    def fail(self, number: int, reason: str) -> Trial:
        """Record that a trial could not be tried or scored; designs near it are avoided."""
        return self._ledger.become(number, TrialState.FAILED, reason=reason)

    def abandon(self, number: int, reason: str = "") -> Trial:
        """Record that a trial was stopped; it does not count."""
        return self._ledger.become(number, TrialState.ABANDONED, reason=reason)

    def compare(self) -> Comparison | None:
        """Return the next two designs to be compared: the unanswered first; None once all is answered.

        Behind the budget come those of the retest, start and recommended design, in a drawn order. They are
        on the disk when this returns. InputError where the run's task is not preference, and where its
        search is by lines and not over.
        """
        if not self.setup.preference:
            raise InputError("run", "task", "designs of this run are scored", "ask for trials instead")
        if self.pair_engine is None and not self.searched:
            raise InputError("run", "engine", "this run searches along lines", "ask for lines instead")
        unanswered = next((one for one in self._ledger.comparisons if one.answer is None), None)
        if unanswered is not None:
            return unanswered
        if not self.left:
            more = self.retest_left > 0
            return self._ledger.pair(*self._blind(len(self.retest_comparisons))) if more else None
        assert self.pair_engine is not None
        return self._ledger.pair(*self.pair_engine.pair(self.problem, self.comparisons))

    def answer(self, number: int, answer: Answer | str) -> Comparison:
        """Record which of two designs was preferred. Raises InputError where it was answered before."""
        if answer not in tuple(Answer):
            raise InputError("answer", str(number), f"is {answer!r}", f"say {', '.join(Answer)}")
        return self._ledger.answer(number, answer)

    def line(self) -> Line | None:
        """Return the next line, on the disk when this returns: the unanswered first; None once all are.

        InputError where the run's engine does not search along lines.
        """
        if self.line_engine is None:
            raise InputError("run", "engine", f"{self.setup.engine} has no lines", "begin another run")
        unanswered = next((one for one in self.lines if one.best is None), None)
        if unanswered is not None:
            return unanswered
        return self._ledger.line(self.line_engine.line(self.problem, self.lines)) if self.left else None

    def choose(self, number: int, best: int) -> Line:
        """Record which stop of a line is liked best. InputError on no stop, or if one was chosen before."""
        return self._ledger.choose(number, best)

    def take(self, number: int) -> Trial:
        """Recommend another trial of the front, on the disk when this returns.

        InputError before the search is over, once its retest has begun, and on what is not on the front.
        """
        if not self.setup.several or not self.searched or self.retests:
            reason = "a compromise is chosen between the search and its retest"
            raise InputError("run", "compromise", reason, "choose it then, in a run of several objectives")
        return keep_choice(self.front(), number, self.folder)

    def retest(self) -> Trial | None:
        """Return the next trial of the retest, on the disk when this returns; None where there is none.

        Each block has the start, the recommended design and every rival once, in an order that is drawn: who
        plays does not know which is which.
        """
        if open_ := next((one for one in self.retests if one.state in OPEN), None):
            return open_
        if self.setup.preference or not self.searched or not self.retest_left:
            return None
        played = self._played()
        block, place = divmod(len(self.retests), len(played))
        one = in_drawn_order(played, self.setup.seed, block)[place]
        return self._ledger.suggest(one.design, RETEST, one.rival)

    def _blind(self, pair: int) -> tuple[dict[str, float], dict[str, float]]:
        """Return both designs of a comparison in its drawn order."""
        first, second = in_drawn_order(self._played(), self.setup.seed, pair)
        return first.design, second.design

    def close(self) -> None:
        self._ledger.close()

    def __enter__(self) -> Optimization:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()
