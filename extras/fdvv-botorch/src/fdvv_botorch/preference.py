"""Comparisons by BoTorch: its pairwise process, and the expected utility of the best option of a pair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_botorch.models import tensor, torch_seeded
from fdvv_people.optimize.engines.preference import PreferenceEngine
from fdvv_people.optimize.engines.search import draw_feasible, fresh, generator, tried_places
from fdvv_people.optimize.problem import Problem, Trial

FEW, DRAWN = 48, 256
"""Designs among which all pairs are weighed, the most promising of so many drawn at random."""


@dataclass(frozen=True)
class PreferenceBoTorchEngine:
    """PairwiseGP and qEUBO over pairs, both designs free. An "equal" is half an answer either way."""

    trial_size: ClassVar[int] = 2
    name: str = field(default="preference-botorch", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine."""
        seed = int(generator(problem, trials, 11).integers(2**31))
        with torch_seeded(self.name, seed) as torch:
            if not any(trial.best for trial in trials):
                return PreferenceEngine().suggest(problem, trials)
            model, known = _model(torch, problem, trials)
            rng = np.random.default_rng(seed)
            net = draw_feasible(
                problem,
                lambda n: rng.random((n, len(problem.space.names))),
                tried_places(problem.space, trials),
                DRAWN,
            )
            pair = _best_pair(torch, model, known, net)
        return problem.space.of_unit(pair if seed % 2 else pair[::-1])

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend the most liked design that was compared, see Engine."""
        if not any(trial.best for trial in trials):
            raise ModelError("no comparison is answered yet, so there is no favourite")
        with torch_seeded(self.name, problem.seed & 0x7FFFFFFF) as torch:
            model, known = _model(torch, problem, trials)
            means = _moments(torch, model, known)[0]
        return problem.space.of_unit(known[int(np.argmax(means))])[0]


def _model(torch: Any, problem: Problem, trials: Sequence[Trial]) -> tuple[Any, FloatArray]:
    """Fit the pairwise process; give it and the places, (n, d), that were compared."""
    from botorch.fit import fit_gpytorch_mll
    from botorch.models.pairwise_gp import PairwiseGP, PairwiseLaplaceMarginalLogLikelihood

    answered = [trial for trial in trials if trial.best]
    both = tried_places(problem.space, answered)
    places = fresh(both, np.empty((0, both.shape[1])))
    rows = np.abs(both[:, None] - places[None]).max(axis=2).argmin(axis=1).reshape(-1, 2)
    pairs: list[tuple[int, int]] = []
    for (first, second), trial in zip(rows.tolist(), answered, strict=True):
        best = trial.best or ()
        # every answer stands twice, so that an equal one can stand once each way
        ways = best if len(best) == 2 else best * 2
        pairs += [((first, second), (second, first))[way] for way in ways if first != second]
    model = PairwiseGP(tensor(torch, places), torch.tensor(pairs).reshape(-1, 2))
    fit_gpytorch_mll(PairwiseLaplaceMarginalLogLikelihood(model.likelihood, model))
    return model, places


def _moments(torch: Any, model: Any, places: FloatArray) -> tuple[FloatArray, FloatArray]:
    with torch.no_grad():
        posterior = model.posterior(tensor(torch, places))
        return posterior.mean[:, 0].numpy(), posterior.variance[:, 0].numpy()


def _best_pair(torch: Any, model: Any, known: FloatArray, net: FloatArray) -> FloatArray:
    from botorch.acquisition.preference import qExpectedUtilityOfBestOption

    mean, variance = _moments(torch, model, net)
    hopeful = net[np.argsort(-(mean + np.sqrt(variance)))[:FEW]]
    liked = known[np.argsort(-_moments(torch, model, known)[0])[:4]]
    among = np.vstack([liked, hopeful])
    i, j = np.triu_indices(len(among), 1)
    # two designs that were both compared before would be the same question again
    asked = j >= len(liked)
    i, j = i[asked], j[asked]
    acquisition = qExpectedUtilityOfBestOption(model)
    with torch.no_grad():
        pairs = tensor(torch, np.stack([among[i], among[j]], axis=1))
        worth = np.concatenate([acquisition(part).numpy() for part in pairs.split(256)])
    k = int(np.argmax(worth))
    return np.stack([among[i[k]], among[j[k]]])
