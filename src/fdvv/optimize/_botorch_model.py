"""BoTorch's model of one objective: known noise, and what others did as its mean."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from fdvv.optimize._belief import observed
from fdvv.optimize._engine import Objective, Problem
from fdvv.optimize._gp import Basis, Observed, believe, pooled
from fdvv.optimize._prior import prior_basis
from fdvv.optimize._torch import tensor
from fdvv.optimize._trial import Trial
from fdvv.units import FloatArray


def objective_model(
    torch: Any, problem: Problem, objective: Objective, done: Sequence[Trial]
) -> tuple[Any, FloatArray]:
    """Make a SingleTaskGP, not fitted yet, and give the scores, (n,), standardised, larger is better."""
    from botorch.models import SingleTaskGP

    scores = observed(problem.space, objective, done)
    y, variance, scale = _standard(scores)
    expected = prior_basis(replace(problem, objectives=(objective,)))
    basis = expected and expected.about(scores.places)
    model = SingleTaskGP(
        tensor(torch, scores.places),
        tensor(torch, y[:, None]),
        tensor(torch, variance[:, None]) if np.isfinite(variance).all() else None,
        mean_module=None if basis is None else _mean(torch, basis, _weight(scores, basis) / scale),
        outcome_transform=None,
    )
    return model, y


def _weight(scores: Observed, basis: Basis) -> float:
    """Give the weight that the person's own scores give to what others did."""
    return float(believe(scores, basis).weights[0])


def _standard(scores: Observed) -> tuple[FloatArray, FloatArray, float]:
    """Turn scores so that larger is better, standardised; variances of noise, nan where unknown; scale."""
    scale = float(np.std(scores.values)) or max(abs(float(np.mean(scores.values))), 1.0)
    y = -(scores.values - np.mean(scores.values)) / scale
    return y, np.maximum((pooled(scores.errors) / scale) ** 2, 1e-6), scale


def _mean(torch: Any, basis: Basis, weight: float) -> Any:
    """Make a mean of what others did, with the weight that the person's own scores give it."""
    from gpytorch.means import Mean

    class OthersMean(Mean):  # type: ignore[misc]
        def forward(self, x: Any) -> Any:
            rows = x.detach().reshape(-1, x.shape[-1]).numpy()
            # of them a small value is good, in the model a large one
            return tensor(torch, -weight * basis.of(rows)[:, 0]).reshape(x.shape[:-1])

    return OthersMean()
