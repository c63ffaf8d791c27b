"""Training and validation of one simulated person: the work of an experiment that processes share."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache
from pathlib import Path

from fdvv.model.file import load_builtin
from fdvv.model.model import FDVVModel
from fdvv_people.optimize.experiment.setup import (
    LEVELS,
    OPTIMAL,
    RANDOM,
    Block,
    ExperimentSetup,
    blocks_of,
    level_order,
)
from fdvv_people.optimize.paper_space import paper_model, paper_space
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.people.user import SimulatedUser, draw_user
from fdvv_people.optimize.people.week import a_week_later, random_design
from fdvv_people.optimize.problem import Trial
from fdvv_people.optimize.run.player import SimulatedPlayer, about_player, play_seed
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import SETUP_FILE, OptimizeSetup
from fdvv_people.task.pointing import TemporalPointing

TRAINING, VALIDATION = 1, 2
"""Phases of an experiment, as seeds know them."""
LOST = "lost_ratio"


@dataclass(frozen=True)
class Training:
    """What a person and level came to.

    Attributes
    ----------
    trials : all, by number. best : the design that the engine recommends.
    """

    person: int
    level: str
    trials: tuple[Trial, ...]
    best: dict[str, float]


@dataclass(frozen=True)
class Observation:
    """One mean score of the validation.

    Attributes
    ----------
    person, round, place : from 0; place of the button within its block.
    asynchrony_ms, error_ms : mean of |asynchrony| over the presses, lost rounds among them, and its standard
        error. lost_ratio : share of presses that missed or triggered too early.
    """

    person: int
    level: str
    round: int
    place: int
    button: str
    asynchrony_ms: float
    error_ms: float
    lost_ratio: float


@dataclass(frozen=True)
class Train:
    """Train one person at one level, in a folder that keeps every trial; called in any process."""

    setup: ExperimentSetup
    folder: Path

    def __call__(self, place: tuple[int, str]) -> Training:
        """Begin or continue the training. Raises InputError, BuildError, OSError."""
        person, level = place
        with self._session(person, level) as session:
            self._player(person, level).play(session)
            return Training(person, level, session.trials, session.best())

    def _session(self, person: int, level: str) -> Optimization:
        folder = self.folder / f"person-{person + 1:02}-{level}"
        if (folder / SETUP_FILE).exists():
            return Optimization.open(folder)
        setup = self.setup
        run_setup = OptimizeSetup(
            engine=setup.engine,
            options=setup.options,
            level=level,
            seed=play_seed(setup.seed, TRAINING, person, LEVELS.index(level)),
            budget=setup.trials,
            prior=setup.prior.get(level, ()),
            simulated=True,
            about={**about_player(person, setup.rig, setup.presses), "drawn_with_seed": setup.seed},
        )
        return Optimization.create(folder, run_setup)

    def _player(self, person: int, level: str) -> SimulatedPlayer:
        setup = self.setup
        before = level_order(person).index(level) * setup.trials * setup.presses
        seed = play_seed(setup.seed, TRAINING, person, LEVELS.index(level), 1)
        task = TemporalPointing(level, setup.presses)
        return SimulatedPlayer(draw_user(person, setup.seed), task, setup.rig, seed, before)


@dataclass(frozen=True)
class Validate:
    """One person presses all buttons a week later; called in any process.

    Attributes
    ----------
    best : the design found in training, by person and level.
    """

    setup: ExperimentSetup
    best: dict[tuple[int, str], dict[str, float]]

    def __call__(self, person: int) -> tuple[Observation, ...]:
        """Return the person's scores in the order they were made. Raises InputError on an unknown button."""
        setup = self.setup
        practised = len(LEVELS) * setup.trials * setup.presses
        user = a_week_later(draw_user(person, setup.seed), setup.gap, practised, setup.seed)
        return tuple(
            self._observed(user, block, place)
            for block in blocks_of(setup, person)
            for place in range(len(block.buttons))
        )

    def _observed(self, user: SimulatedUser, block: Block, place: int) -> Observation:
        setup, number = self.setup, block.first + place
        scores = score_design(
            TemporalPointing(block.level, setup.presses, also=(LOST,)),
            self._model(block.buttons[place], block),
            user,
            play_seed(setup.seed, VALIDATION, block.person, number),
            rig=setup.rig,
            presses_before=number * setup.presses,
        )
        score = scores["asynchrony_ms"]
        place_of = block.person, block.level, block.round, place, block.buttons[place]
        return Observation(*place_of, score.value, score.error or 0.0, scores[LOST].value)

    def _model(self, button: str, block: Block) -> FDVVModel:
        if button == OPTIMAL:
            return paper_model(self.best[block.person, block.level], OPTIMAL)
        if button == RANDOM:
            return paper_model(random_design(paper_space(), self.setup.seed, block.person), RANDOM)
        return _rival(button)


_rival = cache(load_builtin)
