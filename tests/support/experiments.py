"""An experiment with invented scores."""

from __future__ import annotations

import numpy as np

from fdvv_people.optimize.experiment.experiment import ExperimentResult
from fdvv_people.optimize.experiment.setup import ExperimentSetup, blocks_of
from fdvv_people.optimize.experiment.train import Observation, Training


def invented(optimal_ms: float, noise_ms: float = 2.0) -> ExperimentResult:
    """Make scores in which only the optimised button differs, by so much less."""
    setup, random = ExperimentSetup(people=8), np.random.default_rng(3)
    observed = []
    for person in range(8):
        base = 90 + 6 * random.normal()
        for block in blocks_of(setup, person):
            for place, button in enumerate(block.buttons):
                score = base + noise_ms * random.normal() + (optimal_ms if button == "optimal" else 0.0)
                score += 11 if block.level == "hard" else 0
                fields = person, block.level, block.round, place, button, score, 1.0, 0.0
                observed.append(Observation(*fields))
    trainings = [Training(p, level, (), {}) for p in range(8) for level in ("easy", "hard")]
    return ExperimentResult(setup, tuple(trainings), tuple(observed))
