"""Rules that tell the force at a speed from the curves at other speeds: every one that was tried.

Notation: v (k,) known speeds, F (k, nx) their forces at X_mm, w the speed wanted; a rule gives (nx,).
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import replace

import numpy as np
from scipy.interpolate import Akima1DInterpolator, CubicHermiteSpline, CubicSpline, PchipInterpolator

from fdvv.model.file import load_builtin
from fdvv.model.velocity import Interpolation
from fdvv.units import FloatArray

Rule = Callable[[FloatArray, FloatArray, float], FloatArray]
Scale = Callable[[FloatArray], FloatArray]

X_mm = np.round(np.arange(5, 81) * 0.05, 2)
MODEL = load_builtin("mx-clear")


def speed(v: FloatArray) -> FloatArray:
    """The scale of plain speed."""
    return v


def shipped(method: Interpolation) -> Rule:
    """The library's own rule, fed with straight-line curves through the forces."""
    template = MODEL.of("press")[0]
    knots = np.concatenate([X_mm[:1], X_mm, X_mm[-1:]])

    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        curves = tuple(
            replace(template, velocity_mm_s=float(s), degree=1, knots_mm=knots, control_points_cN=f)
            for s, f in zip(v, F, strict=True)
        )
        return replace(MODEL, curves=curves, interpolation=method).force_cN(X_mm, w)

    return rule


def linear_in(scale: Scale) -> Rule:
    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        u, t = scale(v), scale(np.clip(np.array([w]), v[0], v[-1]))
        return np.array([np.interp(t, u, f)[0] for f in F.T])

    return rule


def extended(share: float) -> Rule:
    """Linear, and beyond the ends on along a share of the end's secant."""

    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        held = float(np.clip(w, v[0], v[-1]))
        a, b = (0, 1) if w < v[0] else (-2, -1)
        return np.asarray(LINEAR(v, F, held) + share * (w - held) * (F[b] - F[a]) / (v[b] - v[a]))

    return rule


def shrunk(share: float) -> Rule:
    return lambda v, F, w: (1 - share) * LINEAR(v, F, w) + share * F.mean(0)


def shrunk_nested(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
    """Shrink by the share that leave-one-out on the known curves likes best."""

    def loss(share: float) -> float:
        known = range(1, v.size - 1)
        left = ((np.delete(v, i), np.delete(F, i, 0), v[i], F[i]) for i in known)
        return sum(float(np.mean((shrunk(share)(a, b, c) - d) ** 2)) for a, b, c, d in left)

    return shrunk(min((0.0, 0.25, 0.5, 0.75, 1.0), key=loss))(v, F, w)


def inverse_distance(power: float) -> Rule:
    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        weights = np.abs(v - w) ** -power
        return np.asarray(weights @ F / weights.sum())

    return rule


def gaussian_process(length: float, nugget: float, power: float) -> Rule:
    """Kriging with an unknown mean; length in units of 200 mm/s; power 2 is smooth, 1 is rough."""

    def kernel(a: FloatArray, b: FloatArray) -> FloatArray:
        return np.asarray(np.exp(-((np.abs(a[:, np.newaxis] - b) / (200 * length)) ** power) / power))

    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        K = kernel(v, v) + nugget * np.eye(v.size)
        weights = np.linalg.solve(K, kernel(v, np.array([w])))[:, 0]
        ones = np.linalg.solve(K, np.ones(v.size))
        return np.asarray((weights + ones * (1 - weights.sum()) / ones.sum()) @ F)

    return rule


def polynomial(degree: int, scale: Scale) -> Rule:
    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        c = np.linalg.lstsq(np.vander(scale(v), degree + 1), F, rcond=None)[0]
        return np.asarray((np.vander(scale(np.array([w])), degree + 1) @ c)[0])

    return rule


def low_rank(rank: int) -> Rule:
    """Principal components of the known curves, their scores linear in speed."""

    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        mean = F.mean(0)
        U, S, W = np.linalg.svd(F - mean, full_matrices=False)
        scores = [np.interp(w, v, (U * S)[:, j]) for j in range(rank)]
        return np.asarray(mean + np.array(scores) @ W[:rank])

    return rule


def hermite(tension: float, scale: Scale = speed) -> Rule:
    """Cubic pieces with central differences as slopes, less a share; tension 0 is Catmull and Rom's."""

    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        u = scale(v)
        slopes = (1 - tension) * np.gradient(F, u, axis=0)
        return np.asarray(CubicHermiteSpline(u, F, slopes, axis=0)(_held(u, scale, w)))

    return rule


def pchip_in(scale: Scale) -> Rule:
    return lambda v, F, w: np.asarray(PchipInterpolator(scale(v), F, axis=0)(_held(scale(v), scale, w)))


def pchip_secant_ends(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
    """PCHIP whose slopes at the ends are the secants there, not the parabola's."""
    slopes = PchipInterpolator(v, F, axis=0)(v, 1)
    slopes[0], slopes[-1] = ((F[b] - F[a]) / (v[b] - v[a]) for a, b in ((0, 1), (-2, -1)))
    return np.asarray(CubicHermiteSpline(v, F, slopes, axis=0)(np.clip(w, v[0], v[-1])))


def akima(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
    return np.asarray(Akima1DInterpolator(v, F, axis=0, method="makima")(np.clip(w, v[0], v[-1])))


def cubic(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
    return np.asarray(CubicSpline(v, F, axis=0)(np.clip(w, v[0], v[-1])))


def nearest_faster(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
    """The nearest curve, the faster one half-way."""
    return np.asarray(F[v.size - 1 - np.argmin(np.abs(v - w)[::-1])])


def _held(u: FloatArray, scale: Scale, w: float) -> float:
    return float(np.clip(scale(np.array([w]))[0], u[0], u[-1]))


def landmarks_mm(force_cN: FloatArray) -> FloatArray:
    """Peak, valley and the knee after it."""
    spline, x = CubicSpline(X_mm, force_cN), np.linspace(X_mm[0], X_mm[-1], 3751)
    valley = _extreme(x, -spline(x), 1.5, 2.7)
    peak = _extreme(x, spline(x), 0.5, valley)
    return np.array([peak, valley, _extreme(x, -spline(x, 2), valley + 0.1, 3.3)])


def _extreme(x: FloatArray, y: FloatArray, start: float, end: float) -> float:
    return float(x[np.argmax(np.where((x > start) & (x < end), y, -np.inf))])


def aligned(base: Rule, count: int, scale: Scale = speed) -> Rule:
    """Move the first landmarks of each curve to where they are at speed w, then apply the base rule."""

    def rule(v: FloatArray, F: FloatArray, w: float) -> FloatArray:
        marks = np.array([landmarks_mm(f)[:count] for f in F])
        u = scale(v)
        common = [np.interp(_held(u, scale, w), u, column) for column in marks.T]
        moved = [_warp(f, common, own) for f, own in zip(F, marks, strict=True)]
        return base(v, np.array(moved), w)

    return rule


def _warp(force_cN: FloatArray, common: Sequence[float], own: FloatArray) -> FloatArray:
    there = PchipInterpolator([X_mm[0], *common, X_mm[-1]], [X_mm[0], *own, X_mm[-1]])
    return np.asarray(CubicSpline(X_mm, force_cN)(there(X_mm)))


LINEAR = linear_in(speed)
SQRT = linear_in(np.sqrt)
SHIPPED: dict[str, Rule] = {str(method): shipped(method) for method in Interpolation}
RULES: dict[str, Rule] = {
    **SHIPPED,
    "nearest, faster half-way": nearest_faster,
    "linear in sqrt v": SQRT,
    "linear in log v": linear_in(np.log),
    "linear in log(1 + v/50)": linear_in(lambda v: np.log1p(v / 50)),
    "mean of all": lambda v, F, w: F.mean(0),
    "linear, 1/4 to the mean": shrunk(1 / 4),
    "linear, 1/3 to the mean": shrunk(1 / 3),
    "linear, 1/2 to the mean": shrunk(1 / 2),
    "linear, nested share to mean": shrunk_nested,
    "linear, half secant beyond": extended(0.5),
    "linear, secant beyond": extended(1.0),
    "inverse distance": inverse_distance(1),
    "inverse distance squared": inverse_distance(2),
    "pchip, secants at the ends": pchip_secant_ends,
    "pchip in sqrt v": pchip_in(np.sqrt),
    "modified Akima": akima,
    "cubic spline": cubic,
    "Catmull-Rom": hermite(0.0),
    "Catmull-Rom in sqrt v": hermite(0.0, np.sqrt),
    "Catmull-Rom, half slopes": hermite(0.5),
    "GP smooth, 20 mm/s": gaussian_process(0.1, 0.0, 2.0),
    "GP smooth, 50 mm/s": gaussian_process(0.25, 0.0, 2.0),
    "GP smooth, 100 mm/s": gaussian_process(0.5, 0.0, 2.0),
    "GP smooth, 50 mm/s, nugget": gaussian_process(0.25, 0.1, 2.0),
    "GP smooth, 100 mm/s, nugget": gaussian_process(0.5, 0.1, 2.0),
    "GP rough, 50 mm/s": gaussian_process(0.25, 0.0, 1.0),
    "GP rough, 100 mm/s": gaussian_process(0.5, 0.0, 1.0),
    "least squares line": polynomial(1, speed),
    "least squares line in sqrt v": polynomial(1, np.sqrt),
    "least squares line in log v": polynomial(1, np.log),
    "least squares parabola": polynomial(2, speed),
    "1 principal component": low_rank(1),
    "2 principal components": low_rank(2),
    "2 landmarks aligned, linear": aligned(LINEAR, 2),
    "3 landmarks aligned, linear": aligned(LINEAR, 3),
    "2 landmarks aligned, sqrt v": aligned(SQRT, 2, np.sqrt),
    "3 landmarks aligned, sqrt v": aligned(SQRT, 3, np.sqrt),
    "2 landmarks aligned, pchip": aligned(SHIPPED["pchip"], 2),
    "3 landmarks aligned, pchip": aligned(SHIPPED["pchip"], 3),
}
