"""What the scores of an experiment say: means, analysis of variance, pairs after it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.study import (
    Anova,
    PairedTest,
    averaged_rounds,
    post_hoc,
    repeated_measures_anova,
    rounds_as_people,
)
from fdvv.units import FloatArray
from fdvv.workflow._experiment import ExperimentResult
from fdvv.workflow._experiment_setup import LEVELS, OPTIMAL, RANDOM

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
        """Get the pairs of the optimised button."""
        return tuple(one for one in self.pairs if one.first == OPTIMAL)

    def mean_of(self, button: str, level: str) -> ButtonMean:
        """Give the mean of a button at a level. StopIteration if there is none."""
        return next(one for one in self.means if (one.button, one.level) == (button, level))

    def to_dict(self) -> dict[str, Any]:
        """Give every figure by name."""
        return {
            "means": [asdict(one) for one in self.means],
            "anova": _anova_dict(self.anova),
            "anova_without_random": _anova_dict(self.switches_anova),
            "anova_rounds_counted_as_people": self.rounds_anova and _anova_dict(self.rounds_anova),
            "pairs": [asdict(one) for one in self.pairs],
            "by_level": {level: [asdict(one) for one in pairs] for level, pairs in self.by_level.items()},
        }


def judge_experiment(result: ExperimentResult) -> ExperimentVerdict:
    """Test an experiment's scores. ModelError where a cell is missing or nothing can be tested."""
    scores, setup = result.scores_ms(), result.setup
    averaged = averaged_rounds(scores)
    tables = {
        level: post_hoc(averaged[:, :, i], setup.buttons, OPTIMAL, setup.seed)
        for i, level in enumerate(LEVELS)
    }
    rounds = setup.rounds > 1
    return ExperimentVerdict(
        tuple(_mean(result, scores, button, level) for level in LEVELS for button in setup.buttons),
        repeated_measures_anova(averaged, FACTORS),
        repeated_measures_anova(averaged[:, [b != RANDOM for b in setup.buttons]], FACTORS),
        repeated_measures_anova(rounds_as_people(scores), FACTORS) if rounds else None,
        post_hoc(averaged.mean(axis=2), setup.buttons, seed=setup.seed),
        tables,
    )


def _mean(result: ExperimentResult, scores: FloatArray, button: str, level: str) -> ButtonMean:
    setup = result.setup
    found = scores[:, setup.buttons.index(button), LEVELS.index(level)]
    lost = [o.lost_ratio for o in result.observations if (o.button, o.level) == (button, level)]
    if not lost:
        raise ModelError(f"nobody met {button} at the level {level}")
    people_sd = float(np.std(found.mean(axis=1), ddof=1))
    spread = float(np.std(found, ddof=1))
    return ButtonMean(button, level, float(found.mean()), people_sd, spread, float(np.mean(lost)))


def _anova_dict(anova: Anova) -> dict[str, Any]:
    effects = [
        {
            **asdict(effect),
            "corrected_effect_df": effect.corrected_df[0],
            "corrected_error_df": effect.corrected_df[1],
        }
        for effect in anova.effects
    ]
    return {"counted": anova.people, "effects": effects}
