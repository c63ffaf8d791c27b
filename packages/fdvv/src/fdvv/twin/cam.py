"""From slow press and release curves to spring, cam and friction: the identification of a real button.

A leaf that a cam deflects by h(x) with force N gives the slider N h'(x), which is the fall of its energy
W(x). What press and release have in common beyond the spring is therefore -dW/dx, and its integral from where
the leaf has left the cam gives W, hence N and h, without a word on friction; what parts the two curves is
friction, and over N its coefficient. See docs/explanation/real-buttons.md.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fdvv.errors import ModelError
from fdvv.twin.button import BUILT, BuiltCam, ButtonPhysics, Leaf
from fdvv.units import FloatArray

CELL_m = 1e-5
MARGIN_m = 1.5e-4
"""The table goes on by this much above the resting cap and below the bottom stop."""
TOUCHES_N, GONE_N = 0.006, 0.0015
"""The leaf last takes or gives more than the first, then leaves the cam where it falls below the second."""
RECEDE_m = 5e-5
MOST_FRICTION = 0.6
TAIL = (0.65, 0.9)
"""Part of the travel where the spring is alone."""


@dataclass(frozen=True, eq=False)
class Cam:
    """What the button does at x, slowly; columns (n,) at equidistant x, all SI.

    Attributes
    ----------
    x_m : displacement of the slider in its housing, margins included.
    elastic_N : the spring, or the dome between its two curves.
    height_m : of the cam where it would hold the leaf, 0 where the leaf just reaches the fixed contact.
    normal_N : of the cam on the leaf; 0 for a dome.
    rail_N : friction that does not come from the leaf, or the dome's arm.
    friction_ratio : coefficient of friction between cam and leaf.
    preload_N : of the leaf where it just reaches the fixed contact.
    """

    x_m: FloatArray
    elastic_N: FloatArray
    height_m: FloatArray
    normal_N: FloatArray
    rail_N: FloatArray
    friction_ratio: FloatArray
    preload_N: float


def identify(button: ButtonPhysics) -> Cam:
    """Identify spring, cam and friction; ModelError if the curves cannot be a leaf's.

    A button with a built cam is taken as it is built.
    """
    if button.cam is not None:
        return _sample_cam(button, button.cam)
    x, middle_N, half_N = _curves(button)
    if button.curve.kind == "dome":
        nothing = np.zeros_like(x)
        return Cam(x, middle_N, nothing, nothing, _arm(button, middle_N, half_N), nothing, 0.0)
    return _leaf_cam(button, x, middle_N, half_N)


def _curves(button: ButtonPhysics) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Return x with margins, the middle of the two curves and half their difference."""
    x = _places(button.curve.travel_m)
    press_N, release_N = (
        button.curve.force_ratio * _interp(button, force, x) for force in (button.press_N, button.release_N)
    )
    # curves that cross show the bench's play, not friction that helps
    return x, 0.5 * (press_N + release_N), np.maximum(0.5 * (press_N - release_N), 0.0)


def _sample_cam(button: ButtonPhysics, cam: BuiltCam) -> Cam:
    """Lay a built cam over the table's places."""
    x, leaf = _places(button.curve.travel_m), button.leaf
    elastic_N, height_m, rail_N, ratio = (_interp(button, getattr(cam, name), x) for name in BUILT)
    stiffness = np.where(height_m >= 0.0, 0.0, leaf.fixed_stiffness_N_m) + leaf.stiffness_N_m
    normal_N = np.maximum(cam.preload_N + stiffness * height_m, 0.0)
    return Cam(x, elastic_N, height_m, normal_N, rail_N, ratio, cam.preload_N)


def _interp(button: ButtonPhysics, column: FloatArray, x: FloatArray) -> FloatArray:
    """Interpolate a column that is given at the places of press_N; its ends are held level."""
    from scipy.interpolate import PchipInterpolator

    given_m = button.curve.step_m * np.arange(column.size)
    return np.asarray(PchipInterpolator(given_m, column)(np.clip(x, 0.0, given_m[-1])))


def _places(travel_m: float) -> FloatArray:
    low, high = -math.ceil(MARGIN_m / CELL_m), math.ceil((travel_m + MARGIN_m) / CELL_m)
    return np.asarray(CELL_m * np.arange(low, high + 1))


def _arm(button: ButtonPhysics, middle_N: FloatArray, half_N: FloatArray) -> FloatArray:
    """Return the arm's force so that arm and law of velocity together make the loop at the curves' speed."""
    dome, speed = button.dome, button.curve.speed_m_s
    if dome.law == "log":
        growth = dome.log_ratio * math.log1p(speed / dome.log_speed_m_s)
    else:
        growth = dome.linear_s_m * speed
    part = 1.0 / (1.0 + dome.arm_m / (dome.arm_s * speed))
    return np.asarray(np.maximum(half_N - growth * np.maximum(middle_N, 0.0), 0.0) / part)


def _leaf_cam(button: ButtonPhysics, x: FloatArray, middle_N: FloatArray, half_N: FloatArray) -> Cam:
    curve = button.curve
    spring_N, free = _spring(curve.travel_m, x, middle_N)
    seat = int(np.searchsorted(x, curve.seat_m))
    taken_N = middle_N - spring_N
    taken_N[:seat] = taken_N[seat]
    taken_N[free:] = 0.0
    energy_J = _energy(taken_N)
    close = round((curve.close_m - float(x[0])) / CELL_m)
    zero = int(np.searchsorted(x, 0.0))
    _check_closing(button, float(energy_J[close]), float(energy_J[zero : close + 1].min()))
    normal_N, height_m, preload_N = _deflection(button.leaf, energy_J, float(energy_J[close]))
    height_m = _recede(x, height_m, free)
    rail_N, ratio = _friction(half_N, normal_N, free)
    return Cam(x, middle_N - taken_N, height_m, normal_N, rail_N, ratio, preload_N)


def _check_closing(button: ButtonPhysics, close_J: float, least_J: float) -> None:
    """Refuse a circuit that would close where the leaf is already off, or that would close earlier."""
    at = f"{button.name}: the curves do not let a leaf close its circuit at {button.curve.close_m:g} m"
    if close_J <= 0:
        raise ModelError(f"{at}: it has left the cam by then; choose a smaller close_m")
    if least_J < close_J:
        raise ModelError(f"{at}: it holds less energy somewhere before; choose a larger close_m")


def _spring(travel_m: float, x: FloatArray, middle_N: FloatArray) -> tuple[FloatArray, int]:
    """Fit the spring where the leaf is off the cam; give it and the row from where it is off."""
    tail = (x >= TAIL[0] * travel_m) & (x <= TAIL[1] * travel_m)
    line = np.polynomial.Polynomial.fit(x[tail], middle_N[tail], 1)
    spring_N: FloatArray = np.asarray(line(x), dtype=np.float64)
    taken_N = middle_N - spring_N
    touching = np.flatnonzero((np.abs(taken_N) > TOUCHES_N) & (x < x[tail][0]))
    if not touching.size:
        raise ModelError("press and release are one spring: no leaf leaves its cam before the tail")
    last = int(touching[-1])
    ended = np.flatnonzero(taken_N[last:] * np.sign(taken_N[last]) < GONE_N)
    return spring_N, last + int(ended[0]) if ended.size else int(np.flatnonzero(tail)[0])


def _energy(taken_N: FloatArray) -> FloatArray:
    steps = 0.5 * CELL_m * (taken_N[1:] + taken_N[:-1])
    left = -np.cumsum(steps[::-1])[::-1]
    return np.asarray(np.maximum(np.append(left, 0.0), 0.0))


def _deflection(leaf: Leaf, energy_J: FloatArray, close_J: float) -> tuple[FloatArray, FloatArray, float]:
    """Return force and height at which the springs in series hold that energy, and the leaf's preload.

    Closed, leaf and fixed contact act side by side, behind the cam's contact; open, the leaf alone does.
    """

    def series(behind: float) -> float:
        return leaf.cam_stiffness_N_m * behind / (leaf.cam_stiffness_N_m + behind)

    shut, alone = series(leaf.stiffness_N_m + leaf.fixed_stiffness_N_m), series(leaf.stiffness_N_m)
    preload_N = math.sqrt(2 * shut * close_J)
    beyond_J = np.maximum(energy_J - close_J, 0.0)
    normal_N = np.where(
        energy_J <= close_J, np.sqrt(2 * shut * energy_J), np.sqrt(preload_N**2 + 2 * alone * beyond_J)
    )
    at_close_m = preload_N / leaf.cam_stiffness_N_m
    stiffness = np.where(energy_J <= close_J, shut, alone)
    return normal_N, at_close_m + (normal_N - preload_N) / stiffness, preload_N


def _recede(x: FloatArray, height_m: FloatArray, free: int) -> FloatArray:
    slope = (height_m[free] - height_m[free - 3]) / (x[free] - x[free - 3])
    past = np.maximum(x - x[free], 0.0)
    gap = min(slope, -0.05) * RECEDE_m * (1 - np.exp(-past / RECEDE_m))
    return np.asarray(np.where(x > x[free], height_m[free] + gap, height_m))


def _friction(half_N: FloatArray, normal_N: FloatArray, free: int) -> tuple[FloatArray, FloatArray]:
    """Part friction into that of the rails, which stays once the leaf is off, and that of the cam."""
    rail_N = half_N.copy()
    rail_N[:free] = np.minimum(half_N[:free], half_N[free])
    ratio = np.minimum((half_N - rail_N) / np.maximum(normal_N, 1e-6), MOST_FRICTION)
    return half_N - ratio * normal_N, ratio
