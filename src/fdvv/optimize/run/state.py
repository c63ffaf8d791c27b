"""What is known of a run: its setup and its ledger, and what follows from them."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Literal

from fdvv.errors import InputError, ModelError
from fdvv.model.file import model_from_json
from fdvv.model.model import FDVVModel
from fdvv.optimize.engines.multi_objective import ParetoFront, believed_front
from fdvv.optimize.engines.registry import LINE_ENGINES, engine_of, line_engine_of, pair_engine_of
from fdvv.optimize.problem import OPEN, Answer, Comparison, Engine, Line, Trial, TrialState
from fdvv.optimize.run.blocks import Block, Played, blocks_of, played_in_block
from fdvv.optimize.run.compromise import recommended_of
from fdvv.optimize.run.ledger import Ledger
from fdvv.optimize.run.memory import RunMemory
from fdvv.optimize.run.rivals import named_rivals
from fdvv.optimize.run.setup import OptimizeSetup, designer_of, options_of, problem_of, space_of
from fdvv.optimize.space import Design
from fdvv.rendering.rig_catalog import RigCatalog

START, RETEST = "start", "retest"
"""Origins of trials that no engine suggests: the person's own design, and what is played at the end."""


class RunState:
    """A run as it is now: how far, and what it recommends. It writes nothing.

    Parameters
    ----------
    folder : of the run, with the rig that its setup names. ledger : its trials and answers.
    memory : of an earlier state of the same run; None: nothing is known of it.

    Attributes
    ----------
    folder : of the run. setup : what it is about. space, problem : what its engine is asked.
    engine : the one of scores. pair_engine, line_engine : where the task is preference one of these, which
        reads comparisons, or which stop of a line is liked best.
    warnings : what a person should know of the folder.

    Raises InputError, ModelError, BuildError.
    """

    def __init__(
        self, folder: Path, setup: OptimizeSetup, ledger: Ledger, memory: RunMemory | None = None
    ) -> None:
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
        self._rivals = named_rivals(setup.rivals)
        self._memory = memory or RunMemory()

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
    def retest_answers(self) -> tuple[Answer, ...]:
        """What was answered in the retest so far."""
        return tuple(one.answer for one in self.retest_comparisons if one.answer is not None)

    @property
    def lines(self) -> tuple[Line, ...]:
        """The lines of the search, where the engine reads these."""
        return self._ledger.lines

    @property
    def asks_for(self) -> Literal["trial", "line", "comparison"]:
        """What the search asks for, one after the other."""
        if self.line_engine:
            return "line"
        return "comparison" if self.pair_engine else "trial"

    @property
    def asked(self) -> int:
        """How many comparisons or lines the search asked for."""
        return len(self.comparisons) + len(self.lines)

    @property
    def answered(self) -> int:
        """How many comparisons or lines of the search are answered."""
        answers = [one.answer for one in self.comparisons]
        return sum(one is not None for one in (*answers, *(line.best for line in self.lines)))

    @property
    def left(self) -> int:
        """How many more trials, comparisons or lines may be suggested."""
        spent = sum(trial.state is not TrialState.ABANDONED for trial in self.trials)
        return max(0, self.setup.budget - spent - self.asked)

    @property
    def searched(self) -> bool:
        """Whether the budget is spent and nothing of the search is open."""
        unanswered = self.answered < self.asked
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
            return 0 if alike or self.start is None else blocks - len(self.retest_answers)
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
        try:
            if self.setup.several:
                return recommended_of(self.front(), self.setup, self.folder).design
            return self.best()
        except ModelError:
            return None

    def best(self) -> dict[str, float]:
        """Recommend a design by what the engine believes, not by luck. Raises ModelError if none is done."""
        closed = tuple(trial for trial in self.trials if trial.state not in OPEN)
        compared = tuple(one for one in self.comparisons if one.answer is not None)
        chosen = tuple(line for line in self.lines if line.best is not None)
        # an engine's model takes long
        return self._memory.best.of((self.setup, closed, compared, chosen), self._best)

    def _best(self) -> dict[str, float]:
        if self.pair_engine:
            return self.pair_engine.best(self.problem, self.comparisons)
        if self.line_engine:
            return self.line_engine.best(self.problem, self.lines)
        return self._scored().best(self.problem, self.trials)

    def _scored(self) -> Engine:
        if self.engine is None:
            raise InputError("run", "task", "designs of this run are compared", "ask for comparisons instead")
        return self.engine

    def front(self) -> ParetoFront:
        """Return the compromises that no other trial beats in expected scores, see `believed_front`."""
        done = tuple(trial for trial in self.trials if trial.state is TrialState.DONE)
        return self._memory.front.of((self.setup, done), lambda: believed_front(self.problem, done))

    def model(self, design: Design, name: str = "design") -> FDVVModel:
        return self._designer(design).renamed(name)

    def button(self, trial: Trial, name: str = "design") -> FDVVModel:
        """Return the button that a trial plays: its design, or the switch that takes its place."""
        rival = self._rivals.get(trial.rival) if trial.rival else None
        if rival is None or rival.model is None:
            return self.model(trial.design, name)
        return model_from_json(json.dumps(rival.model), rival.name).renamed(name)
