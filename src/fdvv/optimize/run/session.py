"""An optimisation in a folder: what is asked, shown and answered, each on the disk before it counts."""

from __future__ import annotations

from pathlib import Path

from fdvv.errors import InputError
from fdvv.io.files import require_new_folder, write_atomic
from fdvv.model.model import FDVVModel
from fdvv.optimize.engines.multi_objective import ParetoFront, pareto_front
from fdvv.optimize.engines.registry import engine_of, pair_engine_of
from fdvv.optimize.problem import OPEN, Answer, Comparison, Engine, Score, Trial, TrialState
from fdvv.optimize.run.ledger import Ledger, Step, steps_before
from fdvv.optimize.run.setup import (
    SETUP_FILE,
    OptimizeSetup,
    designer_of,
    problem_of,
    read_setup,
    setup_text,
    space_of,
)
from fdvv.optimize.space import Design
from fdvv.rendering.rig_catalog import RigCatalog

LEDGER_FILE = "trials.jsonl"
START, PERSON = "start", "person"


class Optimization:
    """A run that can be killed at any moment and continued without loss.

    Made by `create` or `open`, for one process at a time; a context manager.

    Attributes
    ----------
    folder : of the run. setup : what it is about. space, problem : what its engine is asked.
    engine, pair_engine : the one of scores, or the one of comparisons where the task is preference.
    warnings : what a person should know of the folder.
    """

    def __init__(self, folder: Path, setup: OptimizeSetup, ledger: Ledger) -> None:
        self.folder, self.setup = folder, setup
        self.space = space_of(setup.space, RigCatalog(folder))
        self._designer = designer_of(setup.space)
        self.problem = problem_of(setup, self.space)
        self.engine = None if setup.preference else engine_of(setup.engine, setup.options)
        self.pair_engine = pair_engine_of(setup.engine, setup.options) if setup.preference else None
        self.warnings = ledger.warnings
        self._ledger = ledger
        self._given: set[int] = set()

    @classmethod
    def create(cls, folder: Path, setup: OptimizeSetup, project: Path | None = None) -> Optimization:
        """Begin a run in a folder that is new or empty. Raises InputError, BuildError, OSError.

        project : where the rig that the setup names is known; it is copied into the run's folder.
        """
        folder = Path(folder)
        require_new_folder(folder, "name a new one, or resume the run in it")
        checked = cls(project or folder, setup, Ledger())
        if setup.space.rig and project:
            RigCatalog(project).lend(setup.space.rig, folder)
        write_atomic(folder / SETUP_FILE, setup_text(checked.setup))
        return cls.open(folder)

    @classmethod
    def open(cls, folder: Path) -> Optimization:
        """Continue a run. Raises InputError where there is none, or it is damaged or in use."""
        folder = Path(folder)
        setup = read_setup(folder / SETUP_FILE)
        ledger = Ledger(folder / LEDGER_FILE)
        try:
            return cls(folder, setup, ledger)
        except BaseException:
            ledger.close()
            raise

    @property
    def trials(self) -> tuple[Trial, ...]:
        return self._ledger.trials

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        return self._ledger.comparisons

    @property
    def left(self) -> int:
        """How many more trials, or comparisons, may be suggested."""
        spent = sum(trial.state is not TrialState.ABANDONED for trial in self.trials)
        return max(0, self.setup.budget - (len(self.comparisons) if self.pair_engine else spent))

    @property
    def finished(self) -> bool:
        """Whether the budget is spent and nothing is open."""
        unanswered = any(one.answer is None for one in self.comparisons)
        return not self.left and not unanswered and not any(trial.state in OPEN for trial in self.trials)

    def ask(self, count: int = 1) -> tuple[Trial, ...]:
        """Return the next trials, at most count: first those left open by an earlier run, then new ones.

        New ones are on the disk when this returns, and each is suggested knowing those before it. Empty once
        the budget is spent. InputError where designs are compared, not scored.
        """
        self._scored()
        left = [t for t in self.trials if t.state in OPEN and t.number not in self._given]
        trials = left[:count]
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

    def _scored(self) -> Engine:
        if self.engine is None:
            raise InputError("run", "task", "designs of this run are compared", "ask for comparisons instead")
        return self.engine

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

    def best(self) -> dict[str, float]:
        """Recommend a design by what the engine believes, not by luck. Raises ModelError if none is done."""
        if self.pair_engine:
            return self.pair_engine.best(self.problem, self.comparisons)
        return self._scored().best(self.problem, self.trials)

    def front(self) -> ParetoFront:
        """Return the compromises that no other trial beats, where there are several objectives."""
        return pareto_front(self.problem, self.trials)

    def compare(self) -> Comparison | None:
        """Return the next two designs to be compared: the unanswered first; None once the budget is spent.

        They are on the disk when this returns. InputError where the run's task is not preference.
        """
        if self.pair_engine is None:
            raise InputError("run", "task", "designs of this run are scored", "ask for trials instead")
        unanswered = next((one for one in self.comparisons if one.answer is None), None)
        if unanswered is not None or not self.left:
            return unanswered
        return self._ledger.pair(*self.pair_engine.pair(self.problem, self.comparisons))

    def answer(self, number: int, answer: Answer | str) -> Comparison:
        """Record which of two designs was preferred. Raises InputError where it was answered before."""
        if answer not in tuple(Answer):
            raise InputError("answer", str(number), f"is {answer!r}", f"say {', '.join(Answer)}")
        return self._ledger.answer(number, answer)

    def model(self, design: Design, name: str = "design") -> FDVVModel:
        return self._designer(design).renamed(name)

    def close(self) -> None:
        self._ledger.close()

    def __enter__(self) -> Optimization:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def replay_differences(folder: Path) -> tuple[Trial | Comparison, ...]:
    """Suggest every trial and comparison of a run anew, from what was known then; return those that differ.

    None on the machine and the versions that a run was made with. InputError, OSError.
    """
    folder = Path(folder)
    replayed = Optimization(folder, read_setup(folder / SETUP_FILE), Ledger())
    return tuple(step[-1] for step in steps_before(folder / LEDGER_FILE) if not _agrees(replayed, step))


def _agrees(run: Optimization, step: Step) -> bool:
    """Return whether an engine would suggest the same again; what a person brought in always agrees."""
    trials, comparisons, found = step
    if isinstance(found, Comparison):
        pair = run.pair_engine and run.pair_engine.pair(run.problem, comparisons)
        return pair == (found.first, found.second)
    if run.engine is None or found.origin != run.engine.name:
        return True
    return run.engine.suggest(run.problem, trials) == [found.design]
