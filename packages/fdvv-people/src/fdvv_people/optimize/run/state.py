"""What is known of a run: its setup and its ledger, and what follows from them."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path
from typing import Literal

from fdvv.errors import ModelError
from fdvv.model.file import model_from_json
from fdvv.model.model import FDVVModel
from fdvv.rendering.rig_catalog import RigCatalog
from fdvv_people.optimize.engines.multi_objective import ParetoFront, believed_front
from fdvv_people.optimize.engines.registry import engine_of
from fdvv_people.optimize.problem import Answer, Trial, TrialState
from fdvv_people.optimize.run.blocks import Block, Played, blocks_of, played_in_block
from fdvv_people.optimize.run.compromise import recommended_of
from fdvv_people.optimize.run.ledger import Ledger
from fdvv_people.optimize.run.memory import RunMemory
from fdvv_people.optimize.run.rivals import named_rivals
from fdvv_people.optimize.run.setup import OptimizeSetup, designer_of, options_of, problem_of, space_of
from fdvv_people.optimize.space import Design

START, RETEST = "start", "retest"
"""Origins of trials that no engine suggests: the person's own design, and what is played at the end."""


class RunState:
    """A run as it is now: how far, and what it recommends. It writes nothing.

    Parameters
    ----------
    folder : of the run, with the rig that its setup names. ledger : its trials.
    memory : of an earlier state of the same run; None: nothing is known of it.

    Attributes
    ----------
    folder : of the run. setup : what it is about. space, problem : what its engine is asked.
    engine : that suggests designs.
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
        self.engine = engine_of(setup.engine, options_of(setup))
        self.warnings = ledger.warnings
        self._ledger = ledger
        self._rivals = named_rivals(setup.rivals)
        self._memory = memory or RunMemory()

    @property
    def trials(self) -> tuple[Trial, ...]:
        """The trials of the search; those of the retest are `retests`."""
        return tuple(trial for trial in map(self.name_origin, self._ledger.trials) if trial.origin != RETEST)

    @property
    def retests(self) -> tuple[Trial, ...]:
        """The trials of the retest that count, block by block, in the order they are played in."""
        trials = (trial for trial in map(self.name_origin, self._ledger.trials) if trial.origin == RETEST)
        return tuple(trial for trial in trials if trial.state is not TrialState.ABANDONED)

    def name_origin(self, trial: Trial) -> Trial:
        """Return a trial with its origin, which an earlier fdvv did not write down of a comparison."""
        if trial.origin or not trial.beside:
            return trial
        return replace(trial, origin=RETEST if trial.number >= self.setup.budget else self.engine.name)

    def trial(self, number: int) -> Trial | None:
        """Return a trial of the search or the retest; None if there is none."""
        return self._ledger.trials[number] if 0 <= number < len(self._ledger.trials) else None

    @property
    def open_trials(self) -> tuple[Trial, ...]:
        """The trials of search and retest that are under way."""
        return tuple(trial for trial in (*self.trials, *self.retests) if trial.is_open)

    @property
    def retest_answers(self) -> tuple[Answer, ...]:
        """What was answered in the retest so far, where designs are compared."""
        return tuple(trial.answer for trial in self.retests if trial.answer is not None)

    @property
    def asks_for(self) -> Literal["trial", "line", "comparison"]:
        """What the search asks for, one after the other."""
        if self.engine.trial_size > 2:
            return "line"
        return "comparison" if self.engine.trial_size == 2 else "trial"

    @property
    def answered(self) -> int:
        """How many trials of the search are scored, or their best design chosen."""
        return sum(trial.state is TrialState.DONE for trial in self.trials)

    @property
    def left(self) -> int:
        """How many more trials may be suggested."""
        spent = sum(trial.state is not TrialState.ABANDONED for trial in self.trials)
        return max(0, self.setup.budget - spent)

    @property
    def searched(self) -> bool:
        """Whether the budget is spent and nothing of the search is open."""
        return not self.left and not any(trial.is_open for trial in self.trials)

    @property
    def finished(self) -> bool:
        """Whether the search is over, and the retest where there is one."""
        return self.searched and self.retest_left == 0 and not any(trial.is_open for trial in self.retests)

    @property
    def blocks(self) -> tuple[Block, ...]:
        """The blocks of the retest that are whole; none where designs are compared."""
        over = [] if self.setup.preference else [trial for trial in self.retests if not trial.is_open]
        return blocks_of(over, self.start, self._block_size) if over else ()

    @property
    def retest_left(self) -> int:
        """How many trials of the retest are still to be suggested."""
        size = self._block_size
        # a comparison is of both designs at once
        size = min(size, 1) if self.setup.preference else size
        return max(0, self.setup.retest_pairs * size - len(self.retests))

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
        return self.first if self.setup.start is None else self.space.checked(self.setup.start)

    @property
    def first(self) -> dict[str, float] | None:
        """The first design of the search, of a line that in its middle; None at first."""
        if not self.trials:
            return None
        designs = self.trials[0].designs
        return designs[len(designs) // 2 if self.asks_for == "line" else 0]

    def recommended(self) -> dict[str, float] | None:
        """Return `best`, or a compromise; None while nothing is done. What is retested stays."""
        retested = [design for trial in self.retests if not trial.rival for design in trial.designs]
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
        closed = tuple(trial for trial in self.trials if not trial.is_open)
        # an engine's model takes long
        return self._memory.best.of((self.setup, closed), lambda: self.engine.best(self.problem, self.trials))

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
