"""The whole experiment on simulated people: training, a week's gap, validation. Simulated."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.units import FloatArray
from fdvv.workflow._executor import Executor
from fdvv.workflow._experiment_setup import LEVELS, ExperimentSetup, begin_experiment
from fdvv.workflow._experiment_train import Observation, Train, Training, Validate

Stage = Callable[[str, int, int], None]
"""Called with a label, steps done and steps in all."""
TRAINING_FOLDER = "training"


@dataclass(frozen=True)
class ExperimentResult:
    """What was observed; simulated.

    Attributes
    ----------
    trainings : by person, then level. observations : in the order they were made, person by person.
    """

    setup: ExperimentSetup
    trainings: tuple[Training, ...]
    observations: tuple[Observation, ...]

    def scores_ms(self) -> FloatArray:
        """Give mean asynchronies as (people, buttons, levels, rounds)."""
        setup = self.setup
        shape = (setup.people, len(setup.buttons), len(LEVELS), setup.rounds)
        found = np.full(shape, np.nan)
        for one in self.observations:
            place = one.person, setup.buttons.index(one.button), LEVELS.index(one.level), one.round
            found[place] = one.asynchrony_ms
        return found

    def training_ms(self, level: str) -> FloatArray:
        """Give the scores of the trials of a level as (people, trials), NaN where a trial failed."""
        rows = [
            [t.scores["asynchrony_ms"].value if t.scores else np.nan for t in training.trials]
            for training in self.trainings
            if training.level == level
        ]
        return np.array(rows, dtype=np.float64)

    def training_of(self, person: int, level: str) -> Training:
        """Give the training of a person and level. StopIteration if there is none."""
        return next(t for t in self.trainings if (t.person, t.level) == (person, level))

    def to_dict(self) -> dict[str, Any]:
        """Give the observations and designs found, for a file."""
        return {
            "seed": self.setup.seed,
            "engine": self.setup.engine,
            "people": self.setup.people,
            "prior_designs": {level: len(trials) for level, trials in self.setup.prior.items()},
            "observations": [asdict(one) for one in self.observations],
            "designs": [
                {"person": one.person, "level": one.level, "parameters": one.best} for one in self.trainings
            ],
            "simulated": True,
        }


def run_experiment(
    folder: Path,
    setup: ExperimentSetup,
    executor: Executor,
    stage: Stage = lambda _label, _done, _total: None,
) -> ExperimentResult:
    """Run the experiment in a folder, or go on with it; the same setup gives the same result anywhere.

    Every trial of a training is on the disk before the next one; a killed run trains no trial twice.
    executor : the processes that people are shared between. stage : progress.

    Raises InputError (a folder of something else, an unknown engine or button), BuildError, OSError,
    WorkerError if a process failed.
    """
    setup = begin_experiment(folder, setup)
    places = [(person, level) for person in range(setup.people) for level in LEVELS]
    trained = _shared(executor, Train(setup, folder / TRAINING_FOLDER), places, "training", stage)
    best = {(one.person, one.level): one.best for one in trained}
    people = list(range(setup.people))
    observed = _shared(executor, Validate(setup, best), people, "validation", stage)
    return ExperimentResult(setup, tuple(trained), tuple(one for rows in observed for one in rows))


def _shared(
    executor: Executor, work: Callable[[Any], Any], chunks: list[Any], label: str, stage: Stage
) -> list[Any]:
    """Work on all chunks and give what was found in their order."""
    found: list[Any] = [None] * len(chunks)
    stage(label, 0, len(chunks))
    for done, (place, one) in enumerate(executor.run(work, chunks), 1):
        found[place] = one
        stage(label, done, len(chunks))
    return found
