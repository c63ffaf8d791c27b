"""A Gaussian process over the unit cube that knows how noisy each score is.

Notation: X (n, d) places, y (n,) standardised scores, R diag of the squared standard errors, H (n, b) basis
functions with weights w ~ N(w0, S), K the covariance of f. y = H w + f(X) + noise; the posterior is that of
universal kriging (Rasmussen & Williams, Gaussian Processes for Machine Learning, 2.7), the kernel's numbers
are the most probable ones under the priors below, found by scikit-learn's regressor.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Any, ClassVar

import numpy as np
import numpy.typing as npt

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_people.optimize.engines.search import missing
from fdvv_people.optimize.problem import Problem, Trial, TrialState
from fdvv_people.optimize.space import LENGTH, DesignSpace
from fdvv_people.task.score import Objective

LENGTH_SPREAD = 0.7
"""SD of the prior of a log length; its mean is that of the space, times the root of d, ranges 1 wide."""
SIGNAL, SIGNAL_BESIDE = (0.1, 0.5), (-1.2, 0.7)
KNOWN_NOISE, UNKNOWN_NOISE = (-4.0, 1.0), (-2.0, 1.0)
"""Priors of log variances, parts of the scores' own: of f, alone or beside what others' trials explain, and
of noise beyond, or without, known errors."""
BOUNDS = (1e-2, 1e2)
NOISE_BOUNDS = (1e-4, 4.0)
ITERATIONS = 60
ROUNDS = 2
"""How often weights and kernel are fitted in turn."""
TREND = 1.0
"""SD of what a person gains or loses over a run, in standardised scores, before the first."""
Prior = tuple[float, float]
"""Mean and SD of a log variance."""


@dataclass(frozen=True, eq=False)
class Basis:
    """Functions that may explain a part of the scores: a trend over time, what others did.

    Attributes
    ----------
    of : (n, b) in the scores' unit, from places (n, d). weight, spread : (b,) mean and SD of the weights
        before any score.
    """

    of: Callable[[FloatArray], FloatArray]
    weight: FloatArray
    spread: FloatArray

    def about(self, places: FloatArray) -> Basis:
        """Take off the means at some places: what is alike at all of them explains no difference."""
        middle = self.of(places).mean(axis=0)
        return replace(self, of=lambda others: self.of(others) - middle)


@dataclass(frozen=True, eq=False)
class Observed:
    """Scores to learn from, smaller is better.

    Attributes
    ----------
    places : (n, d). values, errors : (n,) score and its standard error; errors nan where unknown.
    trend : (n,) how far ahead of now a score lies on a person's way, 0 now; None where nobody changes.
    faded : (n,) by what the noise of a score has grown since; None where none has.
    """

    places: FloatArray
    values: FloatArray
    errors: FloatArray
    trend: FloatArray | None = None
    faded: FloatArray | None = None

    def more(self, place: FloatArray, value: float) -> Observed:
        """Add one of now, its error unknown."""
        return Observed(
            np.vstack([self.places, place]),
            np.append(self.values, value),
            np.append(self.errors, np.nan),
            None if self.trend is None else np.append(self.trend, 0.0),
            None if self.faded is None else np.append(self.faded, 1.0),
        )


@dataclass(frozen=True, eq=False)
class Belief:
    """The posterior of f after some scores.

    Attributes
    ----------
    observed : the scores. kernel : of scikit-learn, fitted. centre, scale : that standardised the scores.
    """

    observed: Observed
    kernel: Any
    noise: FloatArray
    centre: float
    scale: float
    basis: Basis | None = None

    @cached_property
    def _solved(self) -> dict[str, FloatArray]:
        from scipy.linalg import cho_factor, cho_solve

        y = (self.observed.values - self.centre) / self.scale
        X = self.observed.places
        factor = cho_factor(self.kernel(X) + np.diag(self.noise), lower=True)
        H = _functions(self.basis, X, self.observed.trend, self.scale)
        w0, spread = _weights(self.basis, self.observed.trend)
        precision = np.diag(spread**-2.0)
        KH = cho_solve(factor, H)
        cov = np.linalg.inv(H.T @ KH + precision)
        w = w0 + cov @ (KH.T @ (y - H @ w0))
        return {"L": factor[0], "KH": KH, "cov": cov, "w": w, "a": cho_solve(factor, y - H @ w)}

    @property
    def weights(self) -> FloatArray:
        """The weights of the basis functions, (b,), of standardised scores."""
        return self._solved["w"]

    def predict(self, places: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return mean and SD of f, (n,) each, in the scores' unit; noise is not in it."""
        from scipy.linalg import solve_triangular

        solved, cross = self._solved, self.kernel(self.observed.places, places)
        now = None if self.observed.trend is None else np.zeros(len(places))
        H = _functions(self.basis, places, now, self.scale)
        mean = self.centre + self.scale * (H @ self.weights + cross.T @ solved["a"])
        root = solve_triangular(solved["L"], cross, lower=True)
        # what the basis leaves to the weights, whose own doubt comes on top
        rest = H - cross.T @ solved["KH"]
        prior = self.kernel.diag(places)
        variance = prior - (root**2).sum(axis=0) + (rest @ solved["cov"] * rest).sum(axis=1)
        return mean, self.scale * np.sqrt(np.maximum(variance, 1e-12))

    def mean(self, places: FloatArray) -> FloatArray:
        """Return the mean alone, (n,): much cheaper than with its SD."""
        now = None if self.observed.trend is None else np.zeros(len(places))
        H = _functions(self.basis, places, now, self.scale)
        cross = self.kernel(places, self.observed.places)
        return np.asarray(self.centre + self.scale * (H @ self.weights + cross @ self._solved["a"]))

    def best_of(self, done: Sequence[Trial]) -> dict[str, float]:
        """Return the design of best mean among the trials whose scores were learned from."""
        return dict(done[int(np.argmin(self.predict(self.observed.places)[0]))].design)

    def with_fantasy(self, place: FloatArray) -> Belief:
        """Believe that a trial under way comes out as expected: its mean stays, its spread goes."""
        value = float(self.predict(place[None])[0][0])
        quiet = np.append(self.noise, np.median(self.noise))
        return Belief(
            self.observed.more(place, value), self.kernel, quiet, self.centre, self.scale, self.basis
        )


def believe(
    observed: Observed,
    basis: Basis | None = None,
    starts: int = 2,
    few: npt.NDArray[np.int64] | None = None,
    length: float = LENGTH,
) -> Belief:
    """Learn from at least one score. Raises BuildError without scikit-learn.

    few : scores that the kernel's numbers are fitted to, by place; all, unless there are very many.
    length : that is expected of the kernel, as `DesignSpace` has it.
    """
    values, basis = observed.values, basis and basis.about(observed.places)
    centre = float(np.mean(values))
    # one score, or all alike, tell no scale
    scale = float(np.std(values)) or max(abs(centre), 1.0)
    ratio = pooled(observed.errors) / scale
    known = np.isfinite(ratio)
    faded = 1.0 if observed.faded is None else observed.faded
    fixed = np.where(known, ratio, 0.0) ** 2 * faded
    H = _functions(basis, observed.places, observed.trend, scale)
    weights, belief = _weights(basis, observed.trend)[0], None
    for _ in range(ROUNDS if H.shape[1] else 1):
        rest = (values - centre) / scale - H @ weights
        some = slice(None) if few is None else few
        priors = SIGNAL if basis is None else SIGNAL_BESIDE, KNOWN_NOISE if known.all() else UNKNOWN_NOISE
        kernel, white = _fitted(observed.places[some], rest[some], fixed[some], priors, starts, length)
        belief = Belief(observed, kernel, fixed + white * faded, centre, scale, basis)
        weights = belief.weights
    assert belief is not None
    return belief


def _functions(basis: Basis | None, places: FloatArray, trend: FloatArray | None, scale: float) -> FloatArray:
    """Return the values, (n, b), of all that may explain standardised scores beside f."""
    columns = [] if basis is None else [basis.of(places) / scale]
    return np.hstack([np.zeros((len(places), 0)), *columns, *([] if trend is None else [trend[:, None]])])


def _weights(basis: Basis | None, trend: FloatArray | None) -> tuple[FloatArray, FloatArray]:
    """Return mean and SD, (b,), of the weights of these functions before any score."""
    weight, spread = (np.zeros(0), np.zeros(0)) if basis is None else (basis.weight, basis.spread)
    return (weight, spread) if trend is None else (np.append(weight, 0.0), np.append(spread, TREND))


def pooled(errors: FloatArray) -> FloatArray:
    """Draw standard errors half-way to their common size: each is itself a guess from few presses."""
    known = np.isfinite(errors)
    if not known.any():
        return errors
    return np.asarray(np.sqrt(0.5 * (errors**2 + np.mean(errors[known] ** 2))))


def _fitted(
    X: FloatArray, y: FloatArray, fixed: FloatArray, priors: tuple[Prior, Prior], starts: int, length: float
) -> tuple[Any, float]:
    """Fit lengths, signal and what is left as noise; return the kernel without the noise, and the noise."""
    d = X.shape[1]
    signal, noise = priors
    mean = np.array([signal[0], *[np.log(length * np.sqrt(d))] * d, noise[0]])
    spread = np.array([signal[1], *[LENGTH_SPREAD] * d, noise[1]])
    numbers = (1.0, BOUNDS), (np.exp(mean[1:-1]), BOUNDS), (np.exp(noise[0]), NOISE_BOUNDS)
    search = _search(mean, spread, starts)
    # two places nearly the same would leave the matrix singular
    kernel = fitted_process("gp", X, y, *numbers, alpha=fixed + 1e-8, optimizer=search).kernel_
    return kernel.k1, float(kernel.k2.noise_level)


Bounded = tuple[Any, tuple[float, float]]
"""Where a search begins, and its bounds."""


def fitted_process(
    part: str, X: FloatArray, y: FloatArray, signal: Bounded, length: Bounded, noise: Bounded, **options: Any
) -> Any:
    """Fit scikit-learn's regressor with a Matern-5/2 kernel and white noise.

    options : of the regressor. Without scikit-learn, BuildError names the part that needs it.
    """
    try:
        from sklearn.gaussian_process import GaussianProcessRegressor
        from sklearn.gaussian_process.kernels import ConstantKernel, Matern, WhiteKernel
    except ImportError as error:
        raise missing(part, "optimize", error) from error
    kernel = ConstantKernel(*signal) * Matern(*length, nu=2.5) + WhiteKernel(*noise)
    regressor = GaussianProcessRegressor(kernel, **options)
    with warnings.catch_warnings():
        # a length at its bound is a parameter that does not matter, which is no fault
        warnings.simplefilter("ignore")
        return regressor.fit(X, y)


def _search(mean: FloatArray, spread: FloatArray, starts: int) -> Callable[..., tuple[FloatArray, float]]:
    """Make scikit-learn's optimiser search the most probable kernel, from the prior's middle and beside."""

    def search(nll: Any, _: FloatArray, bounds: FloatArray) -> tuple[FloatArray, float]:
        from scipy.optimize import Bounds, minimize

        def cost(theta: FloatArray) -> tuple[float, FloatArray]:
            value, slope = nll(theta, eval_gradient=True)
            off = (theta - mean) / spread
            return float(value + 0.5 * off @ off), slope + off / spread

        shifts = np.random.default_rng(0).normal(0.0, 1.0, (starts - 1, mean.size))
        begins: Sequence[FloatArray] = [mean, *(mean + spread * shifts)]
        how: dict[str, Any] = {
            "jac": True,
            "method": "L-BFGS-B",
            "bounds": Bounds(*bounds.T),
            "options": {"maxiter": ITERATIONS},
        }
        ends = [minimize(cost, np.clip(begin, *bounds.T), **how) for begin in begins]
        best = min(ends, key=lambda end: float(end.fun))
        return best.x, float(best.fun)

    return search


def finished(problem: Problem, trials: Sequence[Trial]) -> list[Trial]:
    """Return the trials that have a score for every objective."""
    names = [one.name for one in problem.objectives]
    return [t for t in trials if t.state is TrialState.DONE and all(name in t.scores for name in names)]


def score_table(objectives: Sequence[Objective], done: Sequence[Trial]) -> tuple[FloatArray, FloatArray]:
    """Return scores, turned so that smaller is better, and their errors, (n, m) each; nan where unknown."""
    scores = [trial.scores[one.name] for trial in done for one in objectives]
    # NumPy makes nan of an error that is None
    columns = np.array([(score.value, score.error) for score in scores], dtype=np.float64)
    values, errors = columns.reshape(len(done), len(objectives), 2).transpose(2, 0, 1)
    return values * [one.sign for one in objectives], errors


def observed(space: DesignSpace, objective: Objective, done: Sequence[Trial]) -> Observed:
    """Gather the scores of finished trials, turned so that smaller is better."""
    values, errors = score_table([objective], done)
    return Observed(space.to_unit([trial.design for trial in done]), values[:, 0], errors[:, 0].copy())


def belief_of(space: DesignSpace, objective: Objective, done: Sequence[Trial]) -> Belief:
    """Learn what a space's designs score in an objective from finished trials, at least one."""
    return believe(observed(space, objective, done), length=space.length)


def believed_best(problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
    """Recommend the tried design whose posterior mean is best. Raises ModelError."""
    done = best_of(problem, trials)
    return belief_of(problem.space, problem.objectives[0], done).best_of(done)


class RecommendsBelievedBest:
    """An engine of scores without a model of its own: it recommends what a Gaussian process believes best."""

    trial_size: ClassVar[int] = 1

    def best(self, problem: Problem, trials: Sequence[Trial]) -> dict[str, float]:
        return believed_best(problem, trials)


def best_of(problem: Problem, trials: Sequence[Trial]) -> list[Trial]:
    """Return the finished trials that one is to be recommended of. ModelError if there is no such one."""
    if len(problem.objectives) != 1:
        raise ModelError("several objectives have no single best design; choose from the Pareto front")
    done = finished(problem, trials)
    if not done:
        raise ModelError("no trial is done yet, so there is no best design")
    return done


MOST, FITTED = 1000, 150
"""Trials of others that are learned from, and that lengths are fitted to; of more, as many spread evenly."""
WEIGHT, SPREAD = 1.0, 0.6
"""Of the others' mean in a person's scores, before the first of them: the same, and a doubt."""


def prior_basis(problem: Problem) -> Basis | None:
    """Return what others' trials let expect: their mean, and how people differ from it; None without any."""
    done = finished(problem, problem.prior)
    if len(done) < 3:
        return None
    few = [done[i] for i in _spread(len(done), MOST)]
    objective, d = problem.objectives[0], len(problem.space.names)
    scores = observed(problem.space, objective, few)
    known = [trial.components or () for trial in few]
    count = min(map(len, known))
    rows = [components[:count] for components in known]
    components = objective.sign * np.array(rows, dtype=np.float64).reshape(len(few), count)
    unknown = np.full(len(few), np.nan)
    columns = [(scores.values, scores.errors), *((column.copy(), unknown) for column in components.T)]
    # as bytes, by which what was learned of them is kept
    beliefs = [_learned(scores.places.tobytes(), y.tobytes(), error.tobytes(), d) for y, error in columns]
    centre = [float(np.mean(belief.mean(scores.places))) for belief in beliefs]

    def of(places: FloatArray) -> FloatArray:
        return np.column_stack([belief.mean(places) for belief in beliefs]) - centre

    # a component's own unit is the standard deviation between people
    return Basis(of, np.array([WEIGHT, *[0.0] * count]), np.array([SPREAD, *[1.0] * count]))


@lru_cache(maxsize=64)
def _learned(places: bytes, values: bytes, errors: bytes, d: int) -> Belief:
    """Learn of the others once for all suggestions of a run."""
    X = np.frombuffer(places).reshape(-1, d)
    scores = Observed(X, np.frombuffer(values), np.frombuffer(errors))
    return believe(scores, starts=1, few=_spread(len(X), FITTED))


def _spread(count: int, most: int) -> npt.NDArray[np.int64]:
    """Return at most so many places, evenly over count."""
    return np.unique(np.linspace(0, count - 1, most).astype(np.int64))
