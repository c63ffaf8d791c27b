"""Force balance of one press, filtered by a window: linear in most parameters of the rig.

For every window w between the stops, with the sensor's filter r and cone m_s given,

    int w (f + r f') = int w coil + viscous v + friction sign v - weight + (mass + m_s) a - play

Derivatives are taken of the window, never of the signal (modulating functions, Shinbrot 1957).
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property, lru_cache

import numpy as np
import numpy.typing as npt

from fdvv.compensation.identification.own_force import NODES, hats
from fdvv.compensation.presses import rig_columns
from fdvv.compensation.tables import bin_force
from fdvv.errors import FitError, ModelError
from fdvv.model.press import Press
from fdvv.units import FloatArray

BoolArray = npt.NDArray[np.bool_]
cN_PER_N = 100.0
cN_PER_g_m_s2 = 0.1
"""A gram accelerated by 1 m/s2 needs 0.1 cN."""
DRAG_cN = cN_PER_N / 1000.0
"""A drag of 1 N s/m at 1 mm/s."""
DEGREE = 5
KNOT_s = 1e-3
"""Spacing of the window's knots; it extends three of them to both sides."""
NOISE_CUT_percentile = 98.0
"""Larger differences are impacts, not noise."""
SHORTEST_ticks, SHORTEST_s = 40, 0.1
"""A record has so many ticks, or lasts so long: a loop of 250 Hz has 25 in that time."""


@lru_cache(maxsize=8)
def windows(tick_s: float) -> tuple[FloatArray, ...]:
    """Return a B-spline window of sum 1 and its first three derivatives (1/s, ...), (2 reach + 1,) each.

    Its knots lie on ticks, so sums over samples are exact for polynomials up to its degree.
    """
    from scipy.interpolate import BSpline

    ticks = max(1, round(KNOT_s / tick_s))
    reach = ticks * (DEGREE + 1) // 2
    knots = (np.arange(DEGREE + 2) - (DEGREE + 1) / 2) * ticks * tick_s
    spline = BSpline.basis_element(knots, extrapolate=False)
    at = np.arange(-reach, reach + 1) * tick_s
    shapes = [spline, *(spline.derivative(order) for order in (1, 2, 3))]
    return tuple(np.nan_to_num(shape(at)) / ticks for shape in shapes)


def convolve(window: FloatArray, signal: FloatArray) -> FloatArray:
    """Convolve a signal with a window, (n,); beyond its ends the signal holds its end values."""
    return np.convolve(np.pad(signal, window.size // 2, mode="edge"), window, mode="valid")


def convolve_columns(window: FloatArray, signals: FloatArray) -> FloatArray:
    """Convolve every column of (n, k) signals with a window; see convolve()."""
    from scipy.ndimage import convolve1d

    return np.asarray(convolve1d(signals, window, axis=0, mode="nearest"))


@dataclass(frozen=True, eq=False)
class Ticks:
    """A press on even ticks, (n,) each: displacement and force as sensed, the command, and invalid rows.

    cut : the command was saturated, or a tick is missing here.
    """

    tick_s: float
    t_s: FloatArray
    sensed_mm: FloatArray
    force_cN: FloatArray
    commanded_cN: FloatArray
    cut: BoolArray

    @cached_property
    def motion(self) -> tuple[FloatArray, ...]:
        """Sensed displacement and its first three derivatives, windowed; mm, s."""
        return tuple(convolve(window, self.sensed_mm) for window in windows(self.tick_s))

    def ahead_mm(self, lag_s: float) -> FloatArray:
        """Return the true displacement if the sensed one passes a first-order lag of lag_s."""
        return self.motion[0] + lag_s * self.motion[1]


def ticks_of(press: Press, name: str, tick_s: float | None = None) -> Ticks:
    """Return a press as its rig recorded it, on even ticks. FitError names it if that is too little.

    tick_s : period of the loop; the median of the record's ticks if None.
    """
    if press.commanded_cN is None:
        raise FitError(f"{name} holds no commanded force; identification needs presses on a rig")
    t_s, sensed, force = rig_columns(press)
    rows = slice(None) if press.tick is None else press.tick
    command = press.commanded_cN[rows]
    if t_s.size < SHORTEST_ticks and not (t_s.size > 1 and t_s[-1] - t_s[0] >= SHORTEST_s):
        raise FitError(
            f"{name} has {t_s.size} ticks, at least {SHORTEST_ticks} are needed; record whole presses"
        )
    if not np.isfinite([sensed, force, command]).all():
        raise FitError(f"{name} holds numbers that are not finite; record it again")
    tick_s = tick_s or float(np.median(np.diff(t_s)))
    even = np.arange(t_s[0], t_s[-1] + 0.5 * tick_s, tick_s)
    cut = np.zeros(t_s.size, np.bool_) if press.saturated is None else press.saturated[rows].copy()
    cut[1:] |= np.diff(t_s) > 1.5 * tick_s
    displacement, measured, commanded = (np.interp(even, t_s, column) for column in (sensed, force, command))
    return Ticks(tick_s, even, displacement, measured, commanded, np.interp(even, t_s, cut) > 0)


def noise(columns: list[FloatArray]) -> float:
    """Estimate the rms of white noise from third differences."""
    squares = np.concatenate([np.diff(column, 3) ** 2 for column in columns])
    clipped = np.minimum(squares, np.percentile(squares, NOISE_CUT_percentile))
    return float(np.sqrt(clipped.mean() / 20.0))


PARAMETERS = (
    *("gain_0", "gain_1", "gain_2", "viscous_N_s_m", "back_emf_N_s_m", "friction_cN", "weight_cN", "mass_g"),
    *("half_play_cN", "stick_cN", "side_ratio", "position_lag_s", "command_delay_s", "electric_lag_s"),
)
"""Estimated parameters, in the order of every vector; the own force's values follow. Three are nonlinear."""
GAIN = slice(0, 3)
VISCOUS, BACK_EMF, FRICTION, WEIGHT, MASS, PLAY, STICK, SIDE, LAG, DELAY, ELECTRIC = range(3, 14)
OWN = slice(ELECTRIC + 1, ELECTRIC + 1 + NODES)
NUMBER_COUNT, COUNT = OWN.start, OWN.stop
LINEAR = slice(0, LAG)
MOVING = (VISCOUS, BACK_EMF, MASS, LAG)
"""Parameters whose columns contain the noise of the sensed position."""
MASS_cN = cN_PER_g_m_s2 / 1000.0
"""A gram accelerated by 1 mm/s2."""
STRIBECK_mm_s = 25.0
"""Speed over which static friction fades to sliding friction; bushings have 5 to 60."""
SLIDING_mm_s = 4.0
"""Width of the smoothed sign function of dry friction."""
STILL_mm_s = 15.0
"""A slower cap may stick, and friction then takes any value up to its limit."""
MARGIN_mm = 0.1
"""Distance to the stops; bounce there is left out."""
LEAST_cN = 5.0
"""Below this force the finger may have left the cap."""
NUDGE_s = 2e-5
EVEN_s, TURN_cN = 1e-3, 0.5
"""Smoothing of the reading, to both sides, and half of the change that counts as a reversal."""


@dataclass(frozen=True)
class Sensor:
    """The finger's force sensor, from its data sheet and its filter's parts.

    Attributes
    ----------
    filter_s : time constant of its filter.
    cone_g : mass that moves with the cap between sensor and cap; negative between finger and sensor.
    noise_cN : rms, of the data sheet; None: what the presses show.
    """

    filter_s: float = 3.33e-4
    cone_g: float = 2.0
    noise_cN: float | None = None


def usable_windows(ticks: Ticks, lag_s: float, travel_mm: float) -> BoolArray:
    """Return which windows lie between the stops, in motion, with the finger on the cap, (n,)."""
    x = ticks.ahead_mm(lag_s)
    floor = min(travel_mm, float(np.median(x[x > x.max() - 0.3]))) - MARGIN_mm
    reach = windows(ticks.tick_s)[0].size // 2
    between = (x > MARGIN_mm) & (x < floor) & (ticks.sensed_mm > 0.5 * MARGIN_mm)
    still = np.abs(convolve(np.full(2 * reach + 1, 1.0 / (2 * reach + 1)), ticks.motion[1])) < STILL_mm_s
    bad = ~between | still | (ticks.force_cN < LEAST_cN) | ticks.cut
    count = np.concatenate([[0], np.cumsum(bad)])
    whole = np.zeros(x.size, np.bool_)
    middle = np.arange(reach, x.size - reach)
    whole[middle] = count[middle + reach + 1] == count[middle - reach]
    return whole


def true_runs(rows: BoolArray) -> list[tuple[int, int]]:
    """Return the first row of every run of True, and the row after its last."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], rows, [False]])))
    return [(int(a), int(b)) for a, b in turns.reshape(-1, 2)]


def finger_force_cN(ticks: Ticks, sensor: Sensor) -> FloatArray:
    """Return the windowed force on the finger, the sensor's filter inverted, (n,)."""
    mean, slope = (convolve(w, ticks.force_cN) for w in windows(ticks.tick_s)[:2])
    return mean + sensor.filter_s * slope


def columns(ticks: Ticks, numbers: FloatArray, stretch: FloatArray) -> FloatArray:
    """Return the regressors of the linear numbers, (n, 11); stretch is that of the sensor's play, -1 to 1.

    The regressor of back-EMF depends on the gain in numbers.
    """
    lag, electric = numbers[LAG], numbers[ELECTRIC]
    window = windows(ticks.tick_s)[0]
    _, v, a, jerk = ticks.motion
    v, a = v + lag * a, a + lag * jerk
    command = np.interp(ticks.t_s - numbers[DELAY], ticks.t_s, ticks.commanded_cN)
    x = ticks.ahead_mm(lag)
    lagged = (first_order_lag(command * x**power, electric, ticks.tick_s) for power in range(3))
    pushes = [convolve(window, push) for push in lagged]
    sliding = np.tanh(v / SLIDING_mm_s)
    rub, stick, side = (
        convolve(window, sliding * load)
        for load in (np.ones(v.size), np.exp(-np.abs(v) / STRIBECK_mm_s), ticks.force_cN)
    )
    rest = [
        DRAG_cN * v,
        braking(ticks, numbers),
        rub,
        np.full(v.size, -1.0),
        MASS_cN * a,
        -stretch,
        stick,
        side,
    ]
    return np.stack([*pushes, *rest], axis=1)


def braking(ticks: Ticks, numbers: FloatArray) -> FloatArray:
    """Return gain^2 v, windowed and lagged by the coil, cN per N s/m, (n,): d/dt of the integral of gain^2.

    The integral is expanded around the sensed displacement to second order in its lag.
    """
    gain = np.polynomial.Polynomial(numbers[GAIN])
    bend = np.asarray((gain * gain).deriv()(ticks.sensed_mm), dtype=np.float64)
    second = 0.5 * bend * (numbers[LAG] * ticks.motion[1]) ** 2
    slope = DRAG_cN * convolve(windows(ticks.tick_s)[1], second)
    first = _rate_after_lag(ticks, _integral(gain * gain, ticks.sensed_mm), numbers)
    return first + first_order_lag(slope, numbers[ELECTRIC], ticks.tick_s)


def braking_slopes(ticks: Ticks, numbers: FloatArray) -> FloatArray:
    """Return the derivative of the braking force by each coefficient of the gain, (n, 3)."""
    gain = np.polynomial.Polynomial(numbers[GAIN])
    bases = [np.polynomial.Polynomial.basis(power) for power in range(3)]
    inner = [_integral(2.0 * gain * basis, ticks.sensed_mm) for basis in bases]
    slopes = np.stack([_rate_after_lag(ticks, each, numbers) for each in inner], axis=1)
    return np.asarray(numbers[BACK_EMF] * slopes)


def _integral(of: np.polynomial.Polynomial, x_mm: FloatArray) -> FloatArray:
    return np.asarray(of.integ()(x_mm), dtype=np.float64)


def _rate_after_lag(ticks: Ticks, signal: FloatArray, numbers: FloatArray) -> FloatArray:
    first, second = (convolve(w, signal) for w in windows(ticks.tick_s)[1:3])
    return first_order_lag(DRAG_cN * (first + numbers[LAG] * second), numbers[ELECTRIC], ticks.tick_s)


def predict(
    ticks: Ticks, numbers: FloatArray, stretch: FloatArray, sensor: Sensor, step_mm: float
) -> FloatArray:
    """Return the windowed force that these parameters predict, (n,); step_mm: of the own force's values."""
    places = step_mm * np.arange(NODES)
    own = np.interp(ticks.ahead_mm(numbers[LAG]), places, numbers[OWN])
    described = columns(ticks, numbers, stretch) @ with_cone(numbers, sensor)
    return np.asarray(described + convolve(windows(ticks.tick_s)[0], own))


def with_cone(numbers: FloatArray, sensor: Sensor) -> FloatArray:
    """Return the linear numbers with the sensor's cone added to the mass, (11,)."""
    loaded = numbers[LINEAR].copy()
    loaded[MASS] += sensor.cone_g
    return loaded


def slopes(
    ticks: Ticks, numbers: FloatArray, stretch: FloatArray, sensor: Sensor, step_mm: float
) -> tuple[FloatArray, FloatArray]:
    """Return the predicted force, (n,), and its derivative by every parameter, (n, COUNT)."""
    jacobian = np.empty((ticks.t_s.size, COUNT))
    jacobian[:, LINEAR] = columns(ticks, numbers, stretch)
    own = hats(ticks.ahead_mm(numbers[LAG]), step_mm)
    jacobian[:, OWN] = convolve_columns(windows(ticks.tick_s)[0], own)
    force = jacobian[:, LINEAR] @ with_cone(numbers, sensor) + jacobian[:, OWN] @ numbers[OWN]
    jacobian[:, GAIN] += braking_slopes(ticks, numbers)
    for place in (LAG, DELAY, ELECTRIC):
        nudged = numbers.copy()
        nudged[place] += NUDGE_s
        jacobian[:, place] = (predict(ticks, nudged, stretch, sensor, step_mm) - force) / NUDGE_s
    return force, jacobian


def play_stretch(ticks: Ticks) -> FloatArray:
    """Return the state of the force sensor's play along the force, (n,).

    1 while the reading follows a rising force, -1 a falling one. Between them the reading is constant; the
    mean of a forward and a backward pass is 0 there.
    """
    count = 2 * max(1, round(EVEN_s / ticks.tick_s)) + 1
    force = convolve(windows(ticks.tick_s)[0], ticks.force_cN)
    even = convolve(np.full(count, 1.0 / count), force)
    return 0.5 * (_stretch(even) - _stretch(even[::-1])[::-1])


def _stretch(force_cN: FloatArray) -> FloatArray:
    held, stretch = float(force_cN[0]), np.empty(force_cN.size)
    for i, force in enumerate(force_cN.tolist()):
        held = min(max(held, force - TURN_cN), force + TURN_cN)
        stretch[i] = (force - held) / TURN_cN
    return stretch


def noise_windows(
    tick_s: float, numbers: FloatArray, sensor: Sensor
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return the windows through which noise enters.

    (k,) noise of the force; (k,) noise of the position into the expected force; (4, k) into the columns of
    MOVING. Back-EMF uses the gain at mid-stroke, without lag.
    """
    w0, w1, w2, w3 = windows(tick_s)
    lag, mass = numbers[LAG], numbers[MASS] + sensor.cone_g
    braked = (numbers[0] + numbers[1] + numbers[2]) ** 2
    drag = numbers[VISCOUS] + braked * numbers[BACK_EMF]
    v, a = DRAG_cN * (w1 + lag * w2), MASS_cN * (w2 + lag * w3)
    into = np.stack([v, braked * v, a, MASS_cN * mass * w3 + DRAG_cN * drag * w2])
    return w0 + sensor.filter_s * w1, mass * a + drag * v, into


@dataclass(frozen=True)
class Delays:
    """Delays of a rig.

    The force sensed at time t acted at the displacement sensed ``position_s`` later, and was commanded
    from the table at the displacement sensed ``command_s`` earlier. 0 for both is the paper's law: a force
    is compared with the target, and corrected, at the displacement sensed with it.
    """

    position_s: float = 0.0
    command_s: float = 0.0

    def __post_init__(self) -> None:
        if not (abs(self.position_s) < 0.1 and abs(self.command_s) < 0.1):
            raise ModelError(f"delays must be less than 0.1 s, got {self}")


def acting_at_mm(t_s: FloatArray, sensed_mm: FloatArray, delays: Delays) -> FloatArray:
    """Estimate the true displacement at the time of each sensed force, (n,)."""
    return np.interp(t_s + delays.position_s, t_s, sensed_mm) if delays.position_s else sensed_mm


def observe(
    t_s: FloatArray,
    sensed_mm: FloatArray,
    force_cN: FloatArray,
    rows: slice,
    target_cN: FloatArray,
    grid_mm: FloatArray,
    delays: Delays,
) -> FloatArray:
    """Assign the force of one stroke to the bins of its table: (n,), NaN where unknown.

    t_s, sensed_mm, force_cN : (m,) the whole press as the rig recorded it; rows those of the stroke.
    Without delays this is ``bin_force``. With them each sample's shortfall is taken at the displacement
    where it acted and assigned to the displacement that commanded it; target minus the result is then
    the mean shortfall of each bin.
    """
    if delays == Delays():
        return bin_force(sensed_mm[rows], force_cN[rows], grid_mm)
    acting = acting_at_mm(t_s, sensed_mm, delays)[rows]
    commanded = np.interp(t_s[rows] - delays.command_s, t_s, sensed_mm)
    shortfall = np.interp(acting, grid_mm, target_cN) - force_cN[rows]
    return target_cN - bin_force(commanded, shortfall, grid_mm)


def first_order_lag(signal: FloatArray, lag_s: float, tick_s: float) -> FloatArray:
    """Filter a signal, linear between ticks, by a first-order lag, starting at its first value."""
    from scipy.signal import lfilter

    if lag_s <= 0.0:
        return signal
    keep = float(np.exp(-tick_s / lag_s))
    mean = lag_s / tick_s * (1.0 - keep)
    return np.asarray(lfilter([1 - mean, mean - keep], [1, -keep], signal, zi=[mean * signal[0]])[0])
