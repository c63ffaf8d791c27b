"""The balance of forces of one press, looked at through a window: linear in most numbers of the rig.

For every window w that lies between the stops, with the sensor's filter r and cone m_s known,

    int w (f + r f') = int w coil + viscous v + friction sign v - weight + (mass + m_s) a - play

Derivatives fall on the window, never on what was sensed (the method of modulating functions, Shinbrot 1957).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.compensate._known_rig import DRAG_cN, cN_PER_g_m_s2
from fdvv.compensate._lag import late
from fdvv.compensate._ticks import BoolArray, Ticks, through, windows
from fdvv.units import FloatArray

NUMBERS = (
    *("gain_0", "gain_1", "gain_2", "viscous_N_s_m", "back_emf_N_s_m", "friction_cN", "weight_cN", "mass_g"),
    *("half_play_cN", "position_lag_s", "command_delay_s", "electric_lag_s"),
)
"""What is estimated, in the order of every vector; the last three are not linear."""
GAIN = slice(0, 3)
VISCOUS, BACK_EMF, FRICTION, WEIGHT, MASS, PLAY, LAG, DELAY, ELECTRIC = range(3, 12)
LINEAR = slice(0, LAG)
MOVING = (VISCOUS, BACK_EMF, MASS, LAG)
"""Numbers whose columns hold the noise of the sensed position."""

MASS_cN = cN_PER_g_m_s2 / 1000.0
"""A gram accelerated by 1 mm/s2."""
SLIDING_mm_s = 4.0
"""Below it friction is not yet, or no longer, whole."""
STILL_mm_s = 15.0
"""Slower than that a cap may stick, and then friction is anything up to its whole."""
MARGIN_mm = 0.1
"""To the stops: where the cap bounces is not looked at."""
LEAST_cN = 5.0
"""Below it the finger may have left the cap."""
NUDGE_s = 2e-5
EVEN_s, TURN_cN = 1e-3, 0.5
"""The reading is evened out over this time to both sides; it has turned once it came back by twice this."""


@dataclass(frozen=True)
class Sensor:
    """The finger's force sensor, as its data sheet and its filter's parts tell.

    Attributes
    ----------
    filter_s : time constant of its filter.
    cone_g : what moves with the cap before the force is sensed.
    """

    filter_s: float = 3.33e-4
    cone_g: float = 2.0


def usable(ticks: Ticks, lag_s: float, travel_mm: float) -> BoolArray:
    """Find the windows, by their middle, between the stops, moving, with the finger on the cap, (n,)."""
    x = ticks.ahead_mm(lag_s)
    floor = min(travel_mm, float(np.median(x[x > x.max() - 0.3]))) - MARGIN_mm
    reach = windows(ticks.tick_s)[0].size // 2
    between = (x > MARGIN_mm) & (x < floor) & (ticks.sensed_mm > 0.5 * MARGIN_mm)
    still = np.abs(through(np.full(2 * reach + 1, 1.0 / (2 * reach + 1)), ticks.motion[1])) < STILL_mm_s
    bad = ~between | still | (ticks.force_cN < LEAST_cN) | ticks.cut
    count = np.concatenate([[0], np.cumsum(bad)])
    whole = np.zeros(x.size, np.bool_)
    middle = np.arange(reach, x.size - reach)
    whole[middle] = count[middle + reach + 1] == count[middle - reach]
    return whole


def spans(rows: BoolArray) -> list[tuple[int, int]]:
    """Give first row and row after the last of every unbroken run."""
    turns = np.flatnonzero(np.diff(np.concatenate([[False], rows, [False]])))
    return [(int(a), int(b)) for a, b in turns.reshape(-1, 2)]


def felt_cN(ticks: Ticks, sensor: Sensor) -> FloatArray:
    """Give the force on the finger through the window, its filter undone, (n,)."""
    mean, slope = (through(w, ticks.force_cN) for w in windows(ticks.tick_s)[:2])
    return mean + sensor.filter_s * slope


def columns(ticks: Ticks, numbers: FloatArray, stretch: FloatArray) -> FloatArray:
    """Give what each linear number is multiplied by, (n, 9); stretch is that of the sensor's play, -1 to 1.

    The column of back-EMF depends on the gain in numbers.
    """
    lag, electric = numbers[LAG], numbers[ELECTRIC]
    window = windows(ticks.tick_s)[0]
    _, v, a, jerk = ticks.motion
    v, a = v + lag * a, a + lag * jerk
    command = np.interp(ticks.t_s - numbers[DELAY], ticks.t_s, ticks.commanded_cN)
    x = ticks.ahead_mm(lag)
    pushes = [through(window, late(command * x**power, electric, ticks.tick_s)) for power in range(3)]
    rub = through(window, np.tanh(v / SLIDING_mm_s))
    rest = [DRAG_cN * v, braking(ticks, numbers), rub, np.full(v.size, -1.0), MASS_cN * a, -stretch]
    return np.stack([*pushes, *rest], axis=1)


def braking(ticks: Ticks, numbers: FloatArray) -> FloatArray:
    """Give gain^2 v through window and coil, cN per N s/m, (n,): the derivative of the integral of gain^2.

    The integral's place is expanded around the sensed one to second order in its lag.
    """
    gain = np.polynomial.Polynomial(numbers[GAIN])
    bend = np.asarray((gain * gain).deriv()(ticks.sensed_mm), dtype=np.float64)
    second = 0.5 * bend * (numbers[LAG] * ticks.motion[1]) ** 2
    slope = DRAG_cN * through(windows(ticks.tick_s)[1], second)
    first = _derived(ticks, _integral(gain * gain, ticks.sensed_mm), numbers)
    return first + late(slope, numbers[ELECTRIC], ticks.tick_s)


def braking_slopes(ticks: Ticks, numbers: FloatArray) -> FloatArray:
    """Give how the force of braking changes with each coefficient of the gain, (n, 3)."""
    gain = np.polynomial.Polynomial(numbers[GAIN])
    bases = [np.polynomial.Polynomial.basis(power) for power in range(3)]
    inner = [_integral(2.0 * gain * basis, ticks.sensed_mm) for basis in bases]
    slopes = np.stack([_derived(ticks, each, numbers) for each in inner], axis=1)
    return np.asarray(numbers[BACK_EMF] * slopes)


def _integral(of: np.polynomial.Polynomial, x_mm: FloatArray) -> FloatArray:
    return np.asarray(of.integ()(x_mm), dtype=np.float64)


def _derived(ticks: Ticks, signal: FloatArray, numbers: FloatArray) -> FloatArray:
    first, second = (through(w, signal) for w in windows(ticks.tick_s)[1:3])
    return late(DRAG_cN * (first + numbers[LAG] * second), numbers[ELECTRIC], ticks.tick_s)


def predicted(ticks: Ticks, numbers: FloatArray, stretch: FloatArray, sensor: Sensor) -> FloatArray:
    """Give the force that these numbers expect through the window, (n,)."""
    return np.asarray(columns(ticks, numbers, stretch) @ with_cone(numbers, sensor))


def with_cone(numbers: FloatArray, sensor: Sensor) -> FloatArray:
    """Give the linear numbers as the sensor feels them, (9,)."""
    felt = numbers[LINEAR].copy()
    felt[MASS] += sensor.cone_g
    return felt


def slopes(
    ticks: Ticks, numbers: FloatArray, stretch: FloatArray, sensor: Sensor
) -> tuple[FloatArray, FloatArray]:
    """Give the expected force, (n,), and how it changes with every number, (n, 12)."""
    linear = columns(ticks, numbers, stretch)
    force = linear @ with_cone(numbers, sensor)
    linear[:, GAIN] += braking_slopes(ticks, numbers)
    nudged = []
    for place in (LAG, DELAY, ELECTRIC):
        other = numbers.copy()
        other[place] += NUDGE_s
        nudged.append((predicted(ticks, other, stretch, sensor) - force) / NUDGE_s)
    return force, np.column_stack([linear, *nudged])


def play_stretch(ticks: Ticks) -> FloatArray:
    """Tell how far the play of the force sensor is stretched along the force, (n,).

    1 while the reading follows a rising force, -1 along a falling one. Between them the reading stands still;
    looking from both sides of it gives 0 there.
    """
    span = max(1, round(EVEN_s / ticks.tick_s))
    even = through(
        np.full(2 * span + 1, 1.0 / (2 * span + 1)), through(windows(ticks.tick_s)[0], ticks.force_cN)
    )
    return 0.5 * (_stretch(even) - _stretch(even[::-1])[::-1])


def _stretch(force_cN: FloatArray) -> FloatArray:
    held, found = float(force_cN[0]), np.empty(force_cN.size)
    for i, force in enumerate(force_cN.tolist()):
        held = min(max(held, force - TURN_cN), force + TURN_cN)
        found[i] = (force - held) / TURN_cN
    return found


def noise_windows(
    tick_s: float, numbers: FloatArray, sensor: Sensor
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Give the windows through which noise enters.

    (k,) noise of the force; (k,) noise of the position into the expected force; (4, k) into the columns of
    MOVING. Back-EMF counts at mid-stroke's gain and without its lag.
    """
    w0, w1, w2, w3 = windows(tick_s)
    lag, mass = numbers[LAG], numbers[MASS] + sensor.cone_g
    braked = (numbers[0] + numbers[1] + numbers[2]) ** 2
    drag = numbers[VISCOUS] + braked * numbers[BACK_EMF]
    v, a = DRAG_cN * (w1 + lag * w2), MASS_cN * (w2 + lag * w3)
    into = np.stack([v, braked * v, a, MASS_cN * mass * w3 + DRAG_cN * drag * w2])
    return w0 + sensor.filter_s * w1, mass * a + drag * v, into
