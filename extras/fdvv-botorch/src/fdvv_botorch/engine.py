"""BoTorch's noise-aware acquisition: the strong engine where torch is installed."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np

from fdvv.units import FloatArray
from fdvv_botorch.models import objective_model, tensor, torch_seeded, worth_of
from fdvv_people.optimize.engines.gp import log_success
from fdvv_people.optimize.engines.gp_model import best_of, finished
from fdvv_people.optimize.engines.search import (
    LOCAL,
    even_net,
    generator,
    most_wanted,
    sobol_places,
    tried_places,
)
from fdvv_people.optimize.problem import OPEN, Problem, Trial

STARTUP = 5
SAMPLES, FRONT_SAMPLES = 64, 32
"""Of the posterior, that an acquisition is averaged over; of a front, where each costs more."""
FRONT_NET, FRONT_LOCAL = 128, 32
"""Candidates where there is a front."""


@dataclass(frozen=True)
class BoTorchEngine:
    """Noisy expected improvement (qLogNEI), of a hypervolume (qLogNEHVI) with several objectives.

    Ament et al. (2023), Daulton et al. (2021). Known standard errors are the model's noise; trials under way
    are pending points; constraints bound the search, failed trials cast doubt on their neighbourhood; trials
    of others are the model's mean, with the weight that the person's own scores give it.
    """

    trial_size: ClassVar[int] = 1
    name: str = field(default="botorch", init=False)

    def suggest(self, problem: Problem, trials: Sequence[Trial], count: int = 1) -> list[dict[str, float]]:
        """Suggest, see Engine."""
        tried = tried_places(problem.space, trials)
        done = finished(problem, trials)
        seed = int(generator(problem, trials, 10).integers(2**31))
        with torch_seeded(self.name, seed) as torch:
            if len(done) < (STARTUP if len(finished(problem, problem.prior)) < 3 else 2):
                return problem.space.of_unit(sobol_places(problem, tried, count))
            case = _Case(torch, problem, trials, done)
            return problem.space.of_unit(_chosen(case, tried, seed, count))

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        """Recommend the design of the best posterior mean, see Engine."""
        done = best_of(problem, trials)
        with torch_seeded(self.name, problem.seed & 0x7FFFFFFF) as torch:
            case = _Case(torch, problem, trials, done)
            with torch.no_grad():
                means = case.model.posterior(case.X).mean[:, 0].numpy()
        return dict(done[int(np.argmax(means))].design)


class _Case:
    """The model of a problem's finished trials; larger is better in it."""

    def __init__(self, torch: Any, problem: Problem, trials: Sequence[Trial], done: Sequence[Trial]) -> None:
        from botorch.fit import fit_gpytorch_mll
        from botorch.models import ModelListGP
        from gpytorch.mlls import ExactMarginalLogLikelihood, SumMarginalLogLikelihood

        self.torch, self.problem, self.trials = torch, problem, trials
        made = [objective_model(torch, problem, one, done) for one in problem.objectives]
        models = [model for model, _ in made]
        self.places = problem.space.to_unit([trial.design for trial in done])
        self.X = tensor(torch, self.places)
        self.y = np.stack([y for _, y in made], axis=1)
        if len(models) == 1:
            self.model = models[0]
            fit_gpytorch_mll(ExactMarginalLogLikelihood(self.model.likelihood, self.model))
        else:
            self.model = ModelListGP(*models)
            fit_gpytorch_mll(SumMarginalLogLikelihood(self.model.likelihood, self.model))

    @property
    def single(self) -> bool:
        """Return whether there is one objective."""
        return len(self.problem.objectives) == 1

    def acquisition(self, pending: FloatArray) -> Any:
        """Make the acquisition, given places (n, d) that are under way."""
        from botorch.acquisition.logei import qLogNoisyExpectedImprovement
        from botorch.acquisition.multi_objective.logei import qLogNoisyExpectedHypervolumeImprovement
        from botorch.sampling.normal import SobolQMCNormalSampler

        samples = SAMPLES if self.single else FRONT_SAMPLES
        sampler = SobolQMCNormalSampler(self.torch.Size([samples]), seed=0)
        common = {"sampler": sampler, "X_pending": tensor(self.torch, pending) if len(pending) else None}
        if self.single:
            return qLogNoisyExpectedImprovement(self.model, self.X, prune_baseline=True, **common)
        worst = self.y.min(axis=0) - 0.1 * np.ptp(self.y, axis=0)
        return qLogNoisyExpectedHypervolumeImprovement(
            self.model, worst.tolist(), self.X, prune_baseline=True, **common
        )


def _chosen(case: _Case, tried: FloatArray, seed: int, count: int) -> FloatArray:
    problem, trials = case.problem, case.trials
    pending = problem.space.to_unit([trial.design for trial in trials if trial.state in OPEN])
    net = even_net(problem, seed)[: None if case.single else FRONT_NET]
    local = LOCAL if case.single else FRONT_LOCAL
    about = case.places[np.argsort(-case.y.mean(axis=1))[:2]]
    chosen = np.empty((0, tried.shape[1]))
    for i in range(count):
        gain = worth_of(case.torch, case.acquisition(np.vstack([pending, chosen])))

        def worth(places: FloatArray, gain: Any = gain) -> FloatArray:
            return np.asarray(gain(places) + log_success(problem.space, trials, places))

        place = most_wanted(problem, worth, net, np.vstack([tried, chosen]), seed + i, about, local=local)
        chosen = np.vstack([chosen, place])
    return chosen
