"""Where the cap was between frames: markers and force joined by the cap's own equation of motion.

At 200 mm/s a camera of 256 frames a second sees the stroke five times, a snap perhaps once. The force is
sampled four times as often, and ``M x'' = F - U(x)`` ties it to the motion: M is the mass of cap and tip,
U the force of the button on its cap at this velocity, alike in all presses of it. Paths of all presses (cubic
splines between the samples of the force) and U (a curve known beforehand plus a spline) are found together
as least squares over the frames, weighted by their noise, and over the equation, weighted by what it leaves
out. Gauss-Newton; the paths are eliminated press by press.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray, N_from_cN, cN_from_N, m_from_mm


@dataclass(frozen=True)
class EvenBasis:
    """Cubic B-splines on even knots over start, start + step, ...; pieces + 3 of them.

    Attributes
    ----------
    start, step : first knot and spacing, in the unit of what is passed to rows.
    pieces : number of spans.
    """

    start: float
    step: float
    pieces: int

    @property
    def size(self) -> int:
        return self.pieces + 3

    def rows(self, at: FloatArray, derivative: int = 0) -> FloatArray:
        """Evaluate every function or its derivative of order 0 to 2, (len(at), size); ends held."""
        place = np.clip((at - self.start) / self.step, 0.0, float(self.pieces))
        left = np.minimum(place.astype(np.int64), self.pieces - 1)
        u = place - left
        matrix = np.zeros((at.size, self.size))
        for k, weight in enumerate(_WEIGHTS[derivative](u)):
            matrix[np.arange(at.size), left + k] = weight / self.step**derivative
        return matrix


_WEIGHTS: tuple[Callable[[FloatArray], tuple[FloatArray, ...]], ...] = (
    lambda u: ((1 - u) ** 3 / 6, (3 * u**3 - 6 * u**2 + 4) / 6, (3 * (u + u**2 - u**3) + 1) / 6, u**3 / 6),
    lambda u: (-((1 - u) ** 2) / 2, (3 * u**2 - 4 * u) / 2, (1 + 2 * u - 3 * u**2) / 2, u**2 / 2),
    lambda u: (1 - u, 3 * u - 2, 1 - 3 * u, u),
)
"""The four splines that are not 0 on a span, over its part u of 0 to 1; their slopes; their bends."""


def rough(size: int) -> FloatArray:
    """Return the matrix of third differences, (size - 3, size), which a smooth spline keeps small."""
    return np.diff(np.eye(size), 3, axis=0)


CurveOfForce = Callable[[FloatArray], tuple[FloatArray, FloatArray]]
"""From displacements (mm) to force (cN) and stiffness (cN/mm)."""
ROUNDS, SETTLED_N = 8, 2e-4
"""At most so many steps, fewer where the last one changed the button's force by less."""
TABLE = 1001
"""Points of a tabulated force: 5 um apart on a key."""
SEATED = 0.02
"""Weight of the equation while the cap is at its upper stop."""
OUTSIDE_mm = 0.3
"""U is a spline from this far above rest to this far below the lowest place; beyond, it holds."""


@dataclass(frozen=True)
class Fusion:
    """What the fusion takes for granted.

    Attributes
    ----------
    moving_g : mass of what moves, cap and tip of the sensor.
    frame_noise_mm : of the place seen in one frame, rms.
    left_out_m_s2 : what the equation leaves out (friction that changes, noise of the force), rms.
    pieces : spans of the spline that U may differ by from what was known; more where nothing was.
    roughness_N : by how much its third differences may differ from 0, rms.
    unknown_N : by how much U may differ from what was known, rms.
    seat_mm : above this depth the upper stop has part in the force, and the equation is not held to.
    """

    moving_g: float
    frame_noise_mm: float = 0.03
    left_out_m_s2: float = 3.0
    pieces: int = 6
    roughness_N: float = 0.1
    unknown_N: float = 0.1
    seat_mm: float = 0.06

    def __post_init__(self) -> None:
        for name, value in vars(self).items():
            if name != "seat_mm" and not 0 < value < math.inf:
                raise ModelError(f"{name} must be above 0, got {value}")


@dataclass(frozen=True, eq=False)
class Seen:
    """One stroke as it was seen and felt.

    Attributes
    ----------
    t_s, force_cN : (n,) even times, at least 4, and the force there.
    frame_s, frame_mm : (k,) frames from the first to the last of those times.
    guess_mm : (n,) a first guess of the path.
    """

    t_s: FloatArray
    force_cN: FloatArray
    frame_s: FloatArray
    frame_mm: FloatArray
    guess_mm: FloatArray

    def __post_init__(self) -> None:
        if self.t_s.size < 4 or self.frame_s.size < 2:
            sizes = f"{self.t_s.size} and {self.frame_s.size}"
            raise ModelError(f"a stroke needs 4 samples and 2 frames, got {sizes}")


@dataclass(frozen=True, eq=False)
class Path:
    """The path of one stroke at its samples: place, speed and acceleration, (n,) each."""

    displacement_mm: FloatArray
    velocity_mm_s: FloatArray
    acceleration_m_s2: FloatArray


@dataclass(eq=False)
class _Stroke:
    """Matrices of one stroke, and its path as coefficients so far."""

    frames: FloatArray
    places: FloatArray
    speeds: FloatArray
    accelerations_m_s2: FloatArray
    frame_mm: FloatArray
    force_N: FloatArray
    path: FloatArray


def fuse(strokes: Sequence[Seen], known: CurveOfForce, settings: Fusion) -> tuple[list[Path], CurveOfForce]:
    """Find the paths of all strokes of one kind at one velocity, and the force of the button that they share.

    known : U as far as it is known beforehand, of a slow probe or a lower velocity; zero if it is not.
    """
    work = [_stroke(seen) for seen in strokes]
    low = min(float(s.guess_mm.min()) for s in strokes) - OUTSIDE_mm
    high = max(float(s.guess_mm.max()) for s in strokes) + OUTSIDE_mm
    basis = EvenBasis(low, (high - low) / settings.pieces, settings.pieces)
    shared_N = _first(work, basis, known)
    for _ in range(ROUNDS):
        before_N, shared_N = shared_N, _improve(work, basis, shared_N, known, settings)
        if float(np.abs(shared_N - before_N).max()) < SETTLED_N:
            break
    return [_path(stroke) for stroke in work], _curve(basis, shared_N, known)


def _stroke(seen: Seen) -> _Stroke:
    step_s = float(seen.t_s[1] - seen.t_s[0])
    basis = EvenBasis(float(seen.t_s[0]), step_s, seen.t_s.size - 1)
    places = basis.rows(seen.t_s)
    return _Stroke(
        basis.rows(seen.frame_s),
        places,
        basis.rows(seen.t_s, 1),
        m_from_mm(basis.rows(seen.t_s, 2)),
        seen.frame_mm,
        N_from_cN(seen.force_cN),
        np.asarray(np.linalg.lstsq(places, seen.guess_mm, rcond=None)[0]),
    )


def _path(s: _Stroke) -> Path:
    return Path(s.places @ s.path, s.speeds @ s.path, s.accelerations_m_s2 @ s.path)


def _prior_N(known: CurveOfForce, x_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    force_cN, stiffness_cN_mm = known(x_mm)
    return N_from_cN(force_cN), N_from_cN(stiffness_cN_mm)


def _first(work: Sequence[_Stroke], basis: EvenBasis, known: CurveOfForce) -> FloatArray:
    """Fit the spline to the measured force, as if nothing had mass."""
    x = np.concatenate([stroke.places @ stroke.path for stroke in work])
    rest = np.concatenate([stroke.force_N for stroke in work]) - _prior_N(known, x)[0]
    smooth = 0.02 * np.sqrt(x.size / basis.size) * rough(basis.size)
    target = np.concatenate([rest, np.zeros(smooth.shape[0])])
    return np.asarray(np.linalg.lstsq(np.vstack([basis.rows(x), smooth]), target, rcond=None)[0])


def _improve(
    work: Sequence[_Stroke], basis: EvenBasis, shared_N: FloatArray, known: CurveOfForce, settings: Fusion
) -> FloatArray:
    moving_kg = 1e-3 * settings.moving_g
    sure_1_N = 1 / (moving_kg * settings.left_out_m_s2)
    penalty = rough(basis.size) / settings.roughness_N
    square = penalty.T @ penalty + np.eye(basis.size) / settings.unknown_N**2
    slope = penalty.T @ (penalty @ shared_N) + shared_N / settings.unknown_N**2
    solved = []
    for stroke in work:
        x = stroke.places @ stroke.path
        rows, bends = basis.rows(x), basis.rows(x, 1)
        known_N, known_N_mm = _prior_N(known, x)
        button_N, button_N_mm = known_N + rows @ shared_N, known_N_mm + bends @ shared_N
        moved_N = moving_kg * (stroke.accelerations_m_s2 @ stroke.path)
        # a cap at its upper stop obeys the stop, which no curve shows
        weight_1_N = sure_1_N * np.where(x < settings.seat_mm, SEATED, 1.0)
        equation = weight_1_N * (moved_N - stroke.force_N + button_N)
        off = (stroke.frames @ stroke.path - stroke.frame_mm) / settings.frame_noise_mm
        miss = np.concatenate([equation, off])
        by_place = moving_kg * stroke.accelerations_m_s2 + button_N_mm[:, None] * stroke.places
        by_path = np.vstack([weight_1_N[:, None] * by_place, stroke.frames / settings.frame_noise_mm])
        by_shared = np.vstack([weight_1_N[:, None] * rows, np.zeros((stroke.frame_mm.size, basis.size))])
        # a trace of the identity keeps this solvable where neither frame nor equation holds a spline
        normal = by_path.T @ by_path + 1e-7 * np.eye(by_path.shape[1])
        answer = np.linalg.solve(normal, by_path.T @ np.column_stack([by_shared, miss]))
        left = by_shared - by_path @ answer[:, :-1]
        square += left.T @ left
        slope += left.T @ (miss - by_path @ answer[:, -1])
        solved.append(answer)
    change_N = -np.linalg.solve(square, slope)
    for stroke, answer in zip(work, solved, strict=True):
        stroke.path = stroke.path - answer[:, -1] - answer[:, :-1] @ change_N
    return np.asarray(shared_N + change_N)


def _curve(basis: EvenBasis, shared_N: FloatArray, known: CurveOfForce) -> CurveOfForce:
    """Tabulate the button's force without extrapolating a slope."""
    x = np.linspace(basis.start, basis.start + basis.step * basis.pieces, TABLE)
    return table_curve(x, cN_from_N(_prior_N(known, x)[0] + basis.rows(x) @ shared_N))


def zero_curve(x_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return zero force and stiffness, the start where nothing is known of the button."""
    return np.zeros_like(x_mm), np.zeros_like(x_mm)


def table_curve(x_mm: FloatArray, force_cN: FloatArray) -> CurveOfForce:
    """Make a curve from a table with x rising: lines between its points, the end values held."""
    stiffness = np.diff(force_cN) / np.diff(x_mm)

    def curve(at_mm: FloatArray) -> tuple[FloatArray, FloatArray]:
        i = np.clip(np.searchsorted(x_mm, at_mm, side="right") - 1, 0, stiffness.size - 1)
        inside = (at_mm >= x_mm[0]) & (at_mm <= x_mm[-1])
        return np.interp(at_mm, x_mm, force_cN), np.where(inside, stiffness[i], 0.0)

    return curve


def undo_filter(values: FloatArray, step_s: float, filter_s: float) -> FloatArray:
    """Undo an RC filter before a converter, (n,) even samples.

    Between samples the input is taken as a line, for which the filter is exact:
    ``y[k] = e y[k-1] + p u[k] + q u[k-1]``, ``e = exp(-step/filter)``, ``p = 1 - (1-e) filter/step``,
    ``q = (1-e) filter/step - e``. That is solved for u. Noise grows by about 1.6 at 1 ms and 0.333 ms.

    Raises ModelError for a filter slower than 0.9 steps, where the recursion would ring or diverge.
    """
    from scipy.signal import lfilter, lfiltic

    if filter_s == 0 or values.size == 0:
        return values
    if not 0 < filter_s <= 0.9 * step_s:
        raise ModelError(
            f"a filter of {1e3 * filter_s:g} ms cannot be undone at steps of {1e3 * step_s:g} ms; "
            "sample faster, or state 0 to leave it in"
        )
    fade = math.exp(-step_s / filter_s)
    slow = (1 - fade) * filter_s / step_s
    here, before = 1 - slow, slow - fade
    # a record begins settled: input and output were the first value for long
    start = lfiltic([1.0, -fade], [here, before], y=[values[0]], x=[values[0]])
    undone, _ = lfilter([1.0, -fade], [here, before], values, zi=start)
    return np.asarray(undone)


def even(t_s: FloatArray, values: FloatArray, step_s: float) -> tuple[FloatArray, FloatArray]:
    """Resample at even times; missing samples are interpolated linearly."""
    count = round((float(t_s[-1]) - float(t_s[0])) / step_s) + 1
    times = t_s[0] + step_s * np.arange(count)
    return times, np.interp(times, t_s, values)


def undo_play(force_cN: FloatArray, play_cN: float) -> FloatArray:
    """Undo a sensor's play: it reads half of it too little while the force rises, too much while it falls.

    force_cN : (n,) even samples. Its direction is found from four samples around, and where it goes
    nowhere, nothing is added.
    """
    if play_cN == 0 or force_cN.size < 5:
        return force_cN
    ahead = np.concatenate([force_cN[2:], np.repeat(force_cN[-1], 2)])
    behind = np.concatenate([np.repeat(force_cN[0], 2), force_cN[:-2]])
    return np.asarray(force_cN + 0.5 * play_cN * np.clip((ahead - behind) / (2 * play_cN), -1.0, 1.0))
