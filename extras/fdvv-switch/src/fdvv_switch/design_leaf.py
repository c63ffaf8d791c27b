"""From curves to a coil, a leaf and the cam that leads it.

First the energy tells where to begin: what press and release have in common beyond the coil is what the leaf
gives back, its integral the energy of the leaf, and that its force and height. Then coil, leaf, guide and cam
are found together by least squares, with slope and radii of the cam held within what can be made.
Last the round sizes of a coil and a strip are chosen, and the cam is found anew around them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_switch.coil import choose_coil
from fdvv_switch.guide import Guide
from fdvv_switch.leaf import DEGREE, Cam, LeafMechanism, choose_leaf, wedge
from fdvv_switch.making import Making
from fdvv_switch.solve import solve
from fdvv_switch.spring import GUIDE_HIGH, GUIDE_LOW, coil_bounds, tail_line
from fdvv_switch.target import SEATED_mm, STEP_mm, Target

REACH_ratio = 0.8
"""The cam ends at this part of the travel; the coil is alone beyond."""
CONTROLS, FREE = 42, 40
SEAT_mm = 0.25
SOFTEST_LEAF_cN_mm, STIFFEST_LEAF_cN_mm = 4.0, 200.0
SLOPE_cN, BEND_cN, WAVE_cN, FALL_cN = 30.0, 3.0, 0.01, 30.0
"""What a cam beyond its limits costs: per slope, per curvature (1/mm); per second derivative, so that it is
smooth where the curves say nothing; and per 10 cN that a cam is farther off the leaf than clears it."""
CLEAR_cN = 3.0
OPEN_cN_mm = 300.0
"""What a circuit costs that is closed too early or open too late, per height of the cam."""
CLOSING_mm = 0.3
"""It may close so far from where the model's does."""
SEAT_ratio = 20.0
"""So much smoother is a cam where the top stop hides what it does."""


@dataclass(frozen=True, eq=False)
class _Basis:
    """The cam's B-spline and its derivatives at the target's displacements: (n, FREE) each."""

    knots_mm: FloatArray
    height: FloatArray
    slope: FloatArray
    second: FloatArray


@dataclass(frozen=True)
class _Free:
    """What the solver moves beside the cam: coil, guide and leaf as plain numbers."""

    pressed_mm: float
    rate_cN_mm: float
    guide: Guide
    leaf_cN: float
    leaf_cN_mm: float


def _basis(target: Target) -> _Basis:
    from scipy.interpolate import BSpline

    end = REACH_ratio * target.travel_mm
    inner = np.linspace(0.0, end, CONTROLS - DEGREE + 1)[1:-1]
    knots = np.concatenate([np.zeros(DEGREE + 1), inner, np.full(DEGREE + 1, end)])
    x = np.minimum(target.displacement_mm, end)
    spline = BSpline(knots, np.eye(CONTROLS), DEGREE)
    past = (target.displacement_mm > end)[:, None]
    slope, second = (np.where(past, 0.0, spline(x, nu=n)) for n in (1, 2))
    tie = _level_end()
    return _Basis(knots, np.asarray(spline(x)) @ tie, slope @ tie, second @ tie)


def _level_end() -> FloatArray:
    return np.vstack([np.eye(FREE), np.tile(np.eye(FREE)[-1], (CONTROLS - FREE, 1))])


def design_leaf(target: Target, making: Making) -> LeafMechanism:
    """Design coil, leaf and cam whose press and release miss the target least.

    Raises ModelError if no coil or no leaf can be made.
    """
    basis = _basis(target)
    free, controls = _begin(target, making, basis)
    coil_low, coil_high = coil_bounds(making)
    low = np.array([*coil_low, *GUIDE_LOW, 1.0, SOFTEST_LEAF_cN_mm])
    high = np.array([*coil_high, *GUIDE_HIGH, 150.0, STIFFEST_LEAF_cN_mm])
    start = np.array([*_flat(free), *controls])
    wide = np.full(FREE, 5.0)
    p, _ = solve(
        lambda v: _miss(target, making, basis, _unflat(v[:7]), v[7:]),
        start,
        np.concatenate([low, -wide]),
        np.concatenate([high, wide]),
    )
    return _made(target, making, basis, _unflat(p[:7]), p[7:])


def _flat(free: _Free) -> tuple[float, ...]:
    guide = free.guide
    friction = (guide.drag_cN, guide.load_ratio, guide.seat_mm)
    return free.pressed_mm, free.rate_cN_mm, *friction, free.leaf_cN, free.leaf_cN_mm


def _unflat(p: FloatArray) -> _Free:
    return _Free(float(p[0]), float(p[1]), Guide(p[2], p[3], p[4]), float(p[5]), float(p[6]))


def _begin(target: Target, making: Making, basis: _Basis) -> tuple[_Free, FloatArray]:
    x, friction = target.displacement_mm, making.friction_ratio
    preload, rate = tail_line(target)
    given = target.middle_cN - preload - rate * x
    given[x < SEAT_mm] = given[np.searchsorted(x, SEAT_mm)]
    given[x > 0.7 * target.travel_mm] = 0.0
    energy = np.maximum(-np.cumsum(given[::-1])[::-1] * STEP_mm, 0.0)
    close = max(float(np.interp(target.close_mm, x, energy)), 0.5)
    drag = max(float(np.median(target.half_loop_cN[x > 0.7 * target.travel_mm])), 0.0)
    riding = (x > SEAT_mm) & (x < target.close_mm)
    force = np.maximum(target.half_loop_cN - drag, 0.0) / friction
    stiffness = float(np.median(force[riding] ** 2 / np.maximum(2.0 * energy[riding], 0.1)))
    stiffness = float(np.clip(stiffness, 5.0, 100.0))
    both = (1.0 + making.contact_ratio) * stiffness
    at_close = float(np.sqrt(2.0 * both * close))
    shut = (np.sqrt(2.0 * both * energy) - at_close) / both
    alone = (np.sqrt(at_close**2 + 2.0 * stiffness * np.maximum(energy - close, 0.0)) - at_close) / stiffness
    height = np.where(energy < close, shut, alone)
    controls = np.linalg.lstsq(basis.height, height, rcond=None)[0]
    guide = Guide(drag, 0.01, 0.05)
    rate = max(rate, 1.0)
    return _Free(max(preload, 0.0) / rate, rate, guide, at_close, stiffness), np.asarray(controls)


def _miss(target: Target, making: Making, basis: _Basis, free: _Free, controls: FloatArray) -> FloatArray:
    x, ratio = target.displacement_mm, making.contact_ratio
    height, slope, second = (part @ controls for part in (basis.height, basis.slope, basis.second))
    bent = free.leaf_cN + np.where(height >= 0.0, 1.0, 1.0 + ratio) * free.leaf_cN_mm * height
    down, up = wedge(np.maximum(bent, 0.0), slope, making.friction_ratio)
    spring = free.rate_cN_mm * (free.pressed_mm + x)
    press, release = free.guide.strokes_cN(x, spring + down, spring + up)
    curvature = second / (1.0 + slope**2) ** 1.5
    over = (
        SLOPE_cN * np.maximum(np.abs(slope) - making.slope_ratio, 0.0),
        BEND_cN * np.maximum(curvature - 1.0 / making.hollow_mm, 0.0),
        BEND_cN * np.maximum(-curvature - 1.0 / (making.nose_mm + making.edge_mm), 0.0),
        WAVE_cN * np.where(x < SEATED_mm, SEAT_ratio, 1.0) * second,
        FALL_cN * np.maximum(-bent - CLEAR_cN, 0.0) / 10.0,
        OPEN_cN_mm * np.maximum(making.gap_mm - height, 0.0) * (x < target.close_mm - CLOSING_mm),
        OPEN_cN_mm * np.maximum(height, 0.0) * (x > target.close_mm + CLOSING_mm),
    )
    return np.concatenate([press - target.press_cN, release - target.release_cN, *over])


def _made(target: Target, making: Making, basis: _Basis, free: _Free, controls: FloatArray) -> LeafMechanism:
    preload = free.pressed_mm * free.rate_cN_mm
    coil = choose_coil(preload, free.rate_cN_mm, target.travel_mm, making.envelope, making.wire)
    height = basis.height @ controls
    largest = free.leaf_cN + free.leaf_cN_mm * max(float(height.max()), 0.0)
    leaf = choose_leaf(free.leaf_cN, free.leaf_cN_mm, largest, making)
    sized = replace(
        free,
        pressed_mm=coil.free_mm - coil.built_mm,
        rate_cN_mm=coil.rate_cN_mm,
        leaf_cN=leaf.preload_cN,
        leaf_cN_mm=leaf.stiffness_cN_mm,
    )
    making = replace(making, contact_ratio=leaf.contact_cN_mm / leaf.stiffness_cN_mm)
    guide = free.guide
    start = np.array([guide.drag_cN, guide.load_ratio, guide.seat_mm, *controls])
    wide = np.full(FREE, 5.0)
    p, _ = solve(
        lambda v: _miss(target, making, basis, replace(sized, guide=Guide(*v[:3])), v[3:]),
        start,
        np.concatenate([GUIDE_LOW, -wide]),
        np.concatenate([GUIDE_HIGH, wide]),
    )
    cam = Cam(basis.knots_mm, _level_end() @ p[3:], making.nose_mm)
    if float(leaf.force_cN(cam.at(target.displacement_mm)).max()) <= 0.0:
        raise ModelError(f"{target.name}: no force is left for a leaf, a coil alone gives the curves")
    guide = Guide(*(float(v) for v in p[:3])).rounded()
    return LeafMechanism(coil, guide, leaf, cam, making.friction_ratio)
