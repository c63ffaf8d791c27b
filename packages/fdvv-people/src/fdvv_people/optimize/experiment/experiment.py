"""The whole experiment on simulated people: training, a week's gap, validation. Simulated."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.parallel.campaign import EachItem, Item, Progress, Result, run_campaign
from fdvv.parallel.executor import Executor
from fdvv.units import FloatArray
from fdvv_people.optimize.experiment.setup import LEVELS, OPTIMAL, RANDOM, ExperimentSetup, begin_experiment
from fdvv_people.optimize.experiment.train import Observation, Train, Training, Validate
from fdvv_people.stats.anova import Anova, repeated_measures_anova
from fdvv_people.stats.effect_size import averaged_rounds, rounds_as_people
from fdvv_people.stats.post_hoc import PairedTest, post_hoc

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
        """Return mean asynchronies as (people, buttons, levels, rounds)."""
        setup = self.setup
        shape = (setup.people, len(setup.buttons), len(LEVELS), setup.rounds)
        found = np.full(shape, np.nan)
        for one in self.observations:
            place = one.person, setup.buttons.index(one.button), LEVELS.index(one.level), one.round
            found[place] = one.asynchrony_ms
        return found

    def training_ms(self, level: str) -> FloatArray:
        """Return the scores of the trials of a level as (people, trials), NaN where a trial failed."""
        rows = [
            [t.scores["asynchrony_ms"].value if t.scores else np.nan for t in training.trials]
            for training in self.trainings
            if training.level == level
        ]
        return np.array(rows, dtype=np.float64)

    def to_dict(self) -> dict[str, Any]:
        """Return the observations and designs found, for a file."""
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
    """Run the experiment in a folder, or continue it; the same setup gives the same result anywhere.

    Every trial of a training is on the disk before the next one; a killed run trains no trial twice.
    executor : the processes that people are shared between. stage : progress.

    Raises InputError (a folder of something else, an unknown engine or button), BuildError, OSError,
    WorkerError if a process failed.
    """
    setup = begin_experiment(folder, setup)
    places = [(person, level) for person in range(setup.people) for level in LEVELS]
    trained = _shared(executor, Train(setup, folder / TRAINING_FOLDER), places, partial(stage, "training"))
    best = {(one.person, one.level): one.best for one in trained}
    people = list(range(setup.people))
    observed = _shared(executor, Validate(setup, best), people, partial(stage, "validation"))
    return ExperimentResult(setup, tuple(trained), tuple(one for rows in observed for one in rows))


def _shared(
    executor: Executor,
    work: Callable[[Item], Result],
    items: Sequence[Item],
    progress: Progress,
) -> list[Result]:
    """Return the result of every item, in their order."""
    found: dict[Item, Result] = {}
    run_campaign(
        executor,
        EachItem(work),
        items,
        lambda *rows: found.update(zip(*rows, strict=True)),
        progress=progress,
    )
    return [found[item] for item in items]


FACTORS = ("button", "level")


@dataclass(frozen=True)
class ButtonMean:
    """How one button did at one level.

    Attributes
    ----------
    mean_ms : over people. people_sd_ms : between people, rounds averaged first. rounds_sd_ms : between all
        rounds of all people, as the paper's STD may be. lost_ratio : share of presses lost.
    """

    button: str
    level: str
    mean_ms: float
    people_sd_ms: float
    rounds_sd_ms: float
    lost_ratio: float


@dataclass(frozen=True)
class ExperimentVerdict:
    """The statistics of an experiment.

    Attributes
    ----------
    anova : people counted as people, rounds averaged first. switches_anova : without the random design.
    rounds_anova : every round counted as a person, as the paper's F(5, 95) does; None with one round.
    pairs : all pairs of buttons, levels and rounds averaged. by_level : the optimised one against each other.
    """

    means: tuple[ButtonMean, ...]
    anova: Anova
    switches_anova: Anova
    rounds_anova: Anova | None
    pairs: tuple[PairedTest, ...]
    by_level: Mapping[str, tuple[PairedTest, ...]]

    @property
    def against(self) -> tuple[PairedTest, ...]:
        """The pairs of the optimised button."""
        return tuple(one for one in self.pairs if one.first == OPTIMAL)

    def to_dict(self) -> dict[str, Any]:
        """Return every figure by name."""
        return {
            "means": [asdict(one) for one in self.means],
            "anova": _anova_dict(self.anova),
            "anova_without_random": _anova_dict(self.switches_anova),
            "anova_rounds_counted_as_people": self.rounds_anova and _anova_dict(self.rounds_anova),
            "pairs": [asdict(one) for one in self.pairs],
            "by_level": {level: [asdict(one) for one in pairs] for level, pairs in self.by_level.items()},
        }


def judge_experiment(result: ExperimentResult) -> ExperimentVerdict:
    """Test an experiment's scores. Raises ModelError where a cell is missing or nothing can be tested."""
    scores, setup = result.scores_ms(), result.setup
    averaged = averaged_rounds(scores)
    return ExperimentVerdict(
        tuple(_mean(result, scores, button, level) for level in LEVELS for button in setup.buttons),
        repeated_measures_anova(averaged, FACTORS),
        repeated_measures_anova(averaged[:, [b != RANDOM for b in setup.buttons]], FACTORS),
        repeated_measures_anova(rounds_as_people(scores), FACTORS) if setup.rounds > 1 else None,
        post_hoc(averaged.mean(axis=2), setup.buttons, seed=setup.seed),
        {
            level: post_hoc(averaged[:, :, i], setup.buttons, OPTIMAL, setup.seed)
            for i, level in enumerate(LEVELS)
        },
    )


def _mean(result: ExperimentResult, scores: FloatArray, button: str, level: str) -> ButtonMean:
    setup = result.setup
    found = scores[:, setup.buttons.index(button), LEVELS.index(level)]
    lost = [o.lost_ratio for o in result.observations if (o.button, o.level) == (button, level)]
    if not lost:
        raise ModelError(f"nobody met {button} at the level {level}")
    figures = found.mean(), np.std(found.mean(axis=1), ddof=1), np.std(found, ddof=1), np.mean(lost)
    return ButtonMean(button, level, *map(float, figures))


def _anova_dict(anova: Anova) -> dict[str, Any]:
    names = "corrected_effect_df", "corrected_error_df"
    effects = [{**asdict(one), **dict(zip(names, one.corrected_df, strict=True))} for one in anova.effects]
    return {"counted": anova.people, "effects": effects}
