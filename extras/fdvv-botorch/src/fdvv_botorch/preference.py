"""Comparisons by BoTorch: its pairwise process, and the expected utility of the best option of a pair."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from fdvv.errors import ModelError
from fdvv.optimize.engines.preference import Pair, PreferenceEngine, compared_places
from fdvv.optimize.engines.search import draw_feasible, fresh, generator
from fdvv.optimize.problem import Answer, Comparison, Problem
from fdvv.units import FloatArray
from fdvv_botorch.models import tensor, torch_seeded

FEW, DRAWN = 48, 256
"""Designs among which all pairs are weighed, the most promising of so many drawn at random."""


@dataclass(frozen=True)
class PreferenceBoTorchEngine:
    """PairwiseGP and qEUBO over pairs, both designs free. An "equal" is half an answer either way."""

    name: str = field(default="preference-botorch", init=False)

    def pair(self, problem: Problem, comparisons: Sequence[Comparison]) -> Pair:
        """Suggest, see PairEngine."""
        seed = int(generator(problem, comparisons, 11).integers(2**31))
        with torch_seeded(self.name, seed) as torch:
            if not any(one.answer is not None for one in comparisons):
                return PreferenceEngine().pair(problem, comparisons)
            model, known = _model(torch, problem, comparisons)
            rng = np.random.default_rng(seed)
            net = draw_feasible(
                problem,
                lambda n: rng.random((n, len(problem.space.names))),
                compared_places(problem, comparisons),
                DRAWN,
            )
            first, second = problem.space.of_unit(_best_pair(torch, model, known, net))
        return (first, second) if seed % 2 else (second, first)

    def best(self, problem: Problem, comparisons: Sequence[Comparison]) -> dict[str, float]:
        """Recommend the most liked design that was compared, see PairEngine."""
        if not any(one.answer is not None for one in comparisons):
            raise ModelError("no comparison is answered yet, so there is no favourite")
        with torch_seeded(self.name, problem.seed & 0x7FFFFFFF) as torch:
            model, known = _model(torch, problem, comparisons)
            means = _moments(torch, model, known)[0]
        return problem.space.of_unit(known[int(np.argmax(means))])[0]


def _model(torch: Any, problem: Problem, comparisons: Sequence[Comparison]) -> tuple[Any, FloatArray]:
    """Fit the pairwise process; give it and the places, (n, d), that were compared."""
    from botorch.fit import fit_gpytorch_mll
    from botorch.models.pairwise_gp import PairwiseGP, PairwiseLaplaceMarginalLogLikelihood

    answered = [one for one in comparisons if one.answer is not None]
    both = compared_places(problem, answered)
    places = fresh(both, np.empty((0, both.shape[1])))
    rows = np.abs(both[:, None] - places[None]).max(axis=2).argmin(axis=1).reshape(-1, 2)
    pairs: list[tuple[int, int]] = []
    for (first, second), one in zip(rows.tolist(), answered, strict=True):
        # every answer stands twice, so that an equal one can stand once each way
        ways = {Answer.FIRST: (0, 0), Answer.SECOND: (1, 1), Answer.EQUAL: (0, 1)}[one.answer or Answer.EQUAL]
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
