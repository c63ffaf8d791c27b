"""BoTorch's model of one objective: known noise, and what others did as its mean."""

from __future__ import annotations

import importlib
import importlib.util
import warnings
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import numpy as np

from fdvv.errors import BuildError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.gp_model import Basis, Observed, believe, observed, pooled, prior_basis
from fdvv_people.optimize.problem import Problem, Trial
from fdvv_people.task.score import Objective

REST = 32
"""Places that an acquisition of torch is asked at once for, at most: it keeps a graph of each."""


@contextmanager
def torch_seeded(part: str, seed: int) -> Iterator[Any]:
    """Yield torch in one thread, in double precision and with a seed, and put all back. BuildError."""
    try:
        with warnings.catch_warnings():
            # of old ways that botorch's own parts go
            warnings.simplefilter("ignore")
            importlib.import_module("botorch")
            torch: Any = importlib.import_module("torch")
    except ImportError as error:
        raise BuildError(f"the engine {part} needs {error.name}: pip install botorch") from error
    threads = torch.get_num_threads()
    try:
        torch.set_num_threads(1)
        with torch.random.fork_rng(devices=[]), warnings.catch_warnings():
            # of a fit that could not be bettered, and of scores that are standardised here already
            warnings.simplefilter("ignore")
            torch.manual_seed(seed)
            yield torch
    finally:
        torch.set_num_threads(threads)


def tensor(torch: Any, rows: FloatArray) -> Any:
    """Return an array as a tensor of double precision."""
    return torch.tensor(np.ascontiguousarray(rows), dtype=torch.double)


def worth_of(torch: Any, acquisition: Any) -> Callable[[FloatArray], FloatArray]:
    """Make an acquisition of single places one of arrays: (n, d) to (n,)."""

    def worth(places: FloatArray) -> FloatArray:
        with torch.no_grad():
            parts = tensor(torch, places)[:, None].split(REST * 8)
            return np.concatenate([acquisition(part).numpy() for part in parts]).astype(np.float64)

    return worth


def torch_there() -> bool:
    """Return whether the BoTorch engines can be used here."""
    return all(importlib.util.find_spec(name) for name in ("torch", "botorch"))


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
    return float(believe(scores, basis).weights[0])


def _standard(scores: Observed) -> tuple[FloatArray, FloatArray, float]:
    scale = float(np.std(scores.values)) or max(abs(float(np.mean(scores.values))), 1.0)
    y = -(scores.values - np.mean(scores.values)) / scale
    return y, np.maximum((pooled(scores.errors) / scale) ** 2, 1e-6), scale


def _mean(torch: Any, basis: Basis, weight: float) -> Any:
    from gpytorch.means import Mean

    class OthersMean(Mean):  # type: ignore[misc]
        def forward(self, x: Any) -> Any:
            rows = x.detach().reshape(-1, x.shape[-1]).numpy()
            # of them a small value is good, in the model a large one
            return tensor(torch, -weight * basis.of(rows)[:, 0]).reshape(x.shape[:-1])

    return OthersMean()
