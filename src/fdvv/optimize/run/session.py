"""An optimisation in a folder: what is asked, shown and answered, each on the disk before it counts."""

from __future__ import annotations

import json
from pathlib import Path

from fdvv.errors import InputError, ModelError
from fdvv.io.files import require_new_folder, write_atomic
from fdvv.model.file import model_from_json
from fdvv.model.model import FDVVModel
from fdvv.optimize.engines.multi_objective import ParetoFront, believed_front
from fdvv.optimize.engines.registry import LINE_ENGINES, engine_of, line_engine_of, pair_engine_of
from fdvv.optimize.problem import OPEN, Answer, Comparison, Engine, Line, Trial, TrialState
from fdvv.optimize.run.blocks import Block, Played, blocks_of, in_drawn_order, played_in_block
from fdvv.optimize.run.compromise import keep_choice, recommended_of
from fdvv.optimize.run.ledger import Ledger, Step, Suggested, steps_before
from fdvv.optimize.run.rivals import named_rivals
from fdvv.optimize.run.setup import (
    SETUP_FILE,
    OptimizeSetup,
    designer_of,
    options_of,
    problem_of,
    read_setup,
    setup_text,
    space_of,
    stated,
)
from fdvv.optimize.space import Design
from fdvv.rendering.rig_catalog import RigCatalog
from fdvv.task.score import Score

LEDGER_FILE = "trials.jsonl"
START, PERSON, RETEST = "start", "person", "retest"


class Optimization:
    """A run that can be killed at any moment and continued without loss.

    Made by `create` or `open`, for one process at a time; a context manager.

    Attributes
    ----------
    folder : of the run. setup : what it is about. space, problem : what its engine is asked.
    engine : the one of scores. pair_engine, line_engine : where the task is preference one of these, which
        reads comparisons, or which stop of a line is liked best.
    warnings : what a person should know of the folder.
    """

    def __init__(self, folder: Path, setup: OptimizeSetup, ledger: Ledger) -> None:
        self.folder, self.setup = folder, setup
        self.space = space_of(setup.space, RigCatalog(folder))
        self._designer = designer_of(setup.space)
        self.problem = problem_of(setup, self.space)
        self.engine = None if setup.preference else engine_of(setup.engine, options_of(setup))
        on_lines = setup.preference and setup.engine in LINE_ENGINES
        self.line_engine = line_engine_of(setup.engine, setup.options) if on_lines else None
        pairs = setup.preference and not on_lines
        self.pair_engine = pair_engine_of(setup.engine, setup.options) if pairs else None
        self.warnings = ledger.warnings
        self._ledger = ledger
        self._given: set[int] = set()
        self._rivals = named_rivals(setup.rivals)
        self._found: tuple[int, dict[str, float] | None] = (-1, None)
        self._front: tuple[int, ParetoFront] = (-1, ParetoFront(self.problem, ()))

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
        write_atomic(folder / SETUP_FILE, setup_text(stated(setup, checked.space)))
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
        """The trials of the search; those of the retest are `retests`."""
        return tuple(trial for trial in self._ledger.trials if trial.origin != RETEST)

    @property
    def retests(self) -> tuple[Trial, ...]:
        """The trials of the retest that count, block by block, in the order they are played in."""
        retests = (trial for trial in self._ledger.trials if trial.origin == RETEST)
        return tuple(trial for trial in retests if trial.state is not TrialState.ABANDONED)

    def trial(self, number: int) -> Trial | None:
        """Return a trial of the search or the retest; None if there is none."""
        return self._ledger.trials[number] if 0 <= number < len(self._ledger.trials) else None

    @property
    def comparisons(self) -> tuple[Comparison, ...]:
        """The comparisons of the search; those beyond the budget are the retest's."""
        return self._ledger.comparisons[: self.setup.budget if self.pair_engine else 0]

    @property
    def retest_comparisons(self) -> tuple[Comparison, ...]:
        return self._ledger.comparisons[len(self.comparisons) :]

    @property
    def lines(self) -> tuple[Line, ...]:
        """The lines of the search, where the engine reads these."""
        return self._ledger.lines

    @property
    def answered(self) -> int:
        """How many comparisons or lines of the search are answered."""
        answers = [one.answer for one in self.comparisons]
        return sum(one is not None for one in (*answers, *(line.best for line in self.lines)))

    @property
    def left(self) -> int:
        """How many more trials, comparisons or lines may be suggested."""
        spent = sum(trial.state is not TrialState.ABANDONED for trial in self.trials)
        return max(0, self.setup.budget - spent - len(self.comparisons) - len(self.lines))

    @property
    def searched(self) -> bool:
        """Whether the budget is spent and nothing of the search is open."""
        unanswered = self.answered < len(self.comparisons) + len(self.lines)
        return not self.left and not unanswered and not any(trial.state in OPEN for trial in self.trials)

    @property
    def finished(self) -> bool:
        """Whether the search is over, and the retest where there is one."""
        return self.searched and self.retest_left == 0 and not any(t.state in OPEN for t in self.retests)

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The blocks of the retest that are whole."""
        over = [one for one in self.retests if one.state not in OPEN]
        return blocks_of(over, self.start, self._block_size) if over else ()

    @property
    def retest_left(self) -> int:
        """How many trials or comparisons of the retest are still to be suggested or answered."""
        blocks = self.setup.retest_pairs
        if self.setup.preference:
            alike = self.searched and self.recommended() in (None, self.start)
            answered = sum(one.answer is not None for one in self.retest_comparisons)
            return 0 if alike or self.start is None else blocks - answered
        return max(0, blocks * self._block_size - len(self.retests)) if blocks else 0

    @property
    def _block_size(self) -> int:
        """How many trials a block has, or is going to have; 0 where there is nothing to compare."""
        if self.searched:
            size = len(self._played())
            return size if size > 1 else 0
        start = self.setup.start
        return 2 + sum(start is None or one.design != start for one in self.setup.rivals)

    def _played(self) -> tuple[Played, ...]:
        start, found = self.start, self.recommended()
        return played_in_block(start, found, self.setup.rivals) if start and found else ()

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

    def _scored(self) -> Engine:
        if self.engine is None:
            raise InputError("run", "task", "designs of this run are compared", "ask for comparisons instead")
        return self.engine

    @property
    def start(self) -> dict[str, float] | None:
        """The design that the result is compared with: the person's own, or the first; None at first."""
        if self.setup.start is not None:
            return self.space.checked(self.setup.start)
        if self.comparisons:
            return self.comparisons[0].first
        if self.lines:
            return self.lines[0].middle
        return self.trials[0].design if self.trials else None

    def recommended(self) -> dict[str, float] | None:
        """Return `best`, or a compromise; None while nothing is done. What is retested stays."""
        retested = [one.design for one in self.retests if not one.rival]
        retested += [design for one in self.retest_comparisons for design in (one.first, one.second)]
        if fixed := next((design for design in retested if design != self.start), None):
            return fixed
        known = sum(trial.state not in OPEN for trial in self.trials) + self.answered
        if self._found[0] != known:  # an engine's model takes long
            self._found = known, self._recommended()
        return self._found[1]

    def _recommended(self) -> dict[str, float] | None:
        try:
            if self.setup.several:
                return recommended_of(self.front(), self.setup, self.folder).design
            return self.best()
        except ModelError:
            return None

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
        if self.line_engine:
            return self.line_engine.best(self.problem, self.lines)
        return self._scored().best(self.problem, self.trials)

    def front(self) -> ParetoFront:
        """Return the compromises that no other trial beats in expected scores, see `believed_front`."""
        known = sum(trial.state is TrialState.DONE for trial in self.trials)
        if self._front[0] != known:
            self._front = known, believed_front(self.problem, self.trials)
        return self._front[1]

    def take(self, number: int) -> Trial:
        """Recommend another trial of the front, on the disk when this returns.

        InputError before the search is over, once its retest has begun, and on what is not on the front.
        """
        if not self.setup.several or not self.searched or self.retests:
            reason = "a compromise is chosen between the search and its retest"
            raise InputError("run", "compromise", reason, "choose it then, in a run of several objectives")
        self._found = -1, None
        return keep_choice(self.front(), number, self.folder)

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

    def model(self, design: Design, name: str = "design") -> FDVVModel:
        return self._designer(design).renamed(name)

    def button(self, trial: Trial, name: str = "design") -> FDVVModel:
        """Return the button that a trial plays: its design, or the switch that takes its place."""
        rival = self._rivals.get(trial.rival) if trial.rival else None
        if rival is None or rival.model is None:
            return self.model(trial.design, name)
        return model_from_json(json.dumps(rival.model), rival.name).renamed(name)

    def close(self) -> None:
        self._ledger.close()

    def __enter__(self) -> Optimization:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def replay_differences(folder: Path) -> tuple[Suggested, ...]:
    """Suggest everything in a run anew, from what was known then; return what differs.

    None on the machine and the versions that a run was made with. InputError, OSError.
    """
    folder = Path(folder)
    replayed = Optimization(folder, read_setup(folder / SETUP_FILE), Ledger())
    return tuple(step[-1] for step in steps_before(folder / LEDGER_FILE) if not _agrees(replayed, step))


def _agrees(run: Optimization, step: Step) -> bool:
    """Return whether an engine would suggest the same again; what a person brought in always agrees."""
    trials, comparisons, lines, found = step
    if isinstance(found, Line):
        return run.line_engine is None or run.line_engine.line(run.problem, lines) == found.stops
    if isinstance(found, Comparison):
        # past the budget are the blind pairs of the retest, which no engine suggests
        if run.pair_engine is None or len(comparisons) >= run.setup.budget:
            return True
        return run.pair_engine.pair(run.problem, comparisons) == (found.first, found.second)
    if run.engine is None or found.origin != run.engine.name:
        return True
    return run.engine.suggest(run.problem, trials) == [found.design]
