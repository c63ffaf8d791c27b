"""From curves to a rubber dome."""

from __future__ import annotations

import itertools
import math
from collections.abc import Callable, Iterator

import numpy as np

from fdvv.errors import ModelError
from fdvv.units import FloatArray
from fdvv_switch.coil import cN_PER_N
from fdvv_switch.dome import Dome, DomeMechanism, Pin, cone_force_N, hinge_force_N, through_pad_cN
from fdvv_switch.guide import Guide
from fdvv_switch.leaf import Leaf, choose_leaf
from fdvv_switch.making import Making
from fdvv_switch.material import HARDEST_shoreA, SOFTEST_shoreA, hardness_shoreA, rubber_MPa
from fdvv_switch.solve import solve
from fdvv_switch.target import Target

STRIDE, FINE_STRIDE = 6, 2
"""So many displacements are skipped while looking, and in the last pass."""
LOOK, PURSUED = 20, 2
"""Every start is tried for so many evaluations, and so many of the best are followed to the end."""
HARDNESS_STEP_shoreA = 5.0
"""Compounds are sold in such steps."""
FOOT_LENGTHS_mm = (1.0, 1.5, 2.0, 3.0)
LEAST_FOOT_mm = 0.6
SOFTEST_PAD_mm_cN, LEAST_PAD_mm_cN, LEAST_PAD_mm, PAD_shoreA = 0.02, 0.0005, 0.8, 30.0
"""Return of the softest pad and of one that is not worth making, its smallest diameter and its rubber."""
STEEPEST_ratio, STEEP_cN = 1.2, 100.0
"""Height over width of the steepest wall, 50 degrees, and what a steeper one costs: its edges would widen
and shrink more than sheet and plug let them."""
JUMP_cN_mm = 1e4
"""What a pad costs that lets the dome run ahead of the key, so that the key would jump."""
LEAST_FOOT_cN_mm = 1.0
"""A foot softer than this is left out."""
NARROWEST_mm = 6.0
"""Smallest base of a dome."""


def design_dome(target: Target, making: Making) -> DomeMechanism:
    """Design the dome whose press and release miss the target least.

    The solver starts from low and high, thin and thick domes; the rubber is then rounded to a hardness that
    is sold and the rest found anew. Raises ModelError if the travel is too short for a moulded dome.
    """
    if target.travel_mm < 1.0:
        raise ModelError(f"a rubber dome cannot be moulded for {target.travel_mm:g} mm of travel")
    low, high = _bounds(target, making)
    soft, hard = rubber_MPa(SOFTEST_shoreA), rubber_MPa(HARDEST_shoreA)
    miss = _misser(target, STRIDE)
    least, most = np.array([soft, *low]), np.array([hard, *high])
    begun = [solve(miss, start, least, most, evaluations=LOOK) for start in _starts(target)]
    begun.sort(key=lambda f: f[1])
    found = [solve(miss, p, least, most) for p, _ in begun[:PURSUED]]
    best = min(found, key=lambda f: f[1])[0]
    step = HARDNESS_STEP_shoreA
    hardness = float(np.clip(step * round(hardness_shoreA(best[0]) / step), SOFTEST_shoreA, HARDEST_shoreA))
    young = rubber_MPa(hardness)
    fine = _misser(target, FINE_STRIDE)
    rest, _ = solve(lambda p: fine(np.array([young, *p])), best[1:], low, high)
    return _made(rest, hardness, target, making)


def _bounds(target: Target, making: Making) -> tuple[FloatArray, FloatArray]:
    t = target.travel_mm
    low = np.array([0.3 * t, 0.15, 0.2, 0.0, 0.3 * t, 0.0, 0.0, 0.0, 0.005, NARROWEST_mm, 0.25, 0.0])
    high = np.array(
        [1.5 * t, 1.2, 1.0, 0.4 * t, t, 1000.0, 8.0, 0.25, 0.4, making.widest_mm, 0.8, SOFTEST_PAD_mm_cN]
    )
    return low, high


def _starts(target: Target) -> Iterator[FloatArray]:
    t = target.travel_mm
    for height, gap, wall in itertools.product((0.6 * t, 0.9 * t), (0.7 * t, 0.95 * t), (0.3, 0.8)):
        yield np.array([2.0, height, wall, 0.5, 0.1, gap, 20.0, 2.0, 0.03, 0.05, 7.0, 0.4, 0.005])


def _misser(target: Target, stride: int) -> Callable[[FloatArray], FloatArray]:
    x = target.displacement_mm[::stride]
    top = np.linspace(0.0, float(x[-1]), 2 * x.size)
    press, release = target.press_cN[::stride], target.release_cN[::stride]

    def miss(p: FloatArray) -> FloatArray:
        young, height, wall, hinge, press_in, gap, foot, drag, load, seat, base, slim, give = p
        radii = (0.5 * base, 0.5 * base * slim)
        s = press_in + top
        force = cone_force_N(s, *radii, height, wall, young) + hinge_force_N(
            s, *radii, height, hinge * wall, young
        )
        both = cN_PER_N * force + foot * np.maximum(top - gap, 0.0)
        jump = JUMP_cN_mm * np.minimum(np.diff(top + give * both), 0.0)
        steep = STEEP_cN * np.maximum(height / (radii[0] - radii[1]) - STEEPEST_ratio, 0.0)
        held = through_pad_cN(x, top, both, give)
        down, up = Guide(drag, load, seat).strokes_cN(x, held, held)
        return np.concatenate([down - press, up - release, jump, [steep]])

    return miss


def _made(p: FloatArray, hardness: float, target: Target, making: Making) -> DomeMechanism:
    height, wall, hinge, press_in, gap, foot, drag, load, seat, base, slim, give = (float(v) for v in p)
    outer, inner, high, thick, thin = (round(v, 2) for v in (base, slim * base, height, wall, hinge * wall))
    dome = Dome(outer, inner, high, thick, thin, hardness, round(press_in, 2))
    under = _foot(foot, hardness, target.travel_mm - gap, making)
    return DomeMechanism(dome, Guide(drag, load, seat).rounded(), under, round(gap, 2), _pad(give))


def _pad(give_mm_cN: float) -> Pin | None:
    """Find the shortest soft pin of that give that can be moulded; None where the key may sit on the dome."""
    if give_mm_cN < LEAST_PAD_mm_cN:
        return None
    young = cN_PER_N * rubber_MPa(PAD_shoreA)
    for length in FOOT_LENGTHS_mm:
        diameter = math.sqrt(4.0 * length / (math.pi * young * give_mm_cN))
        if diameter >= LEAST_PAD_mm:
            break
    return Pin(round(diameter, 2), length, PAD_shoreA)


def _foot(stiffness_cN_mm: float, hardness: float, way_mm: float, making: Making) -> Pin | Leaf:
    young = cN_PER_N * rubber_MPa(hardness)
    for length in FOOT_LENGTHS_mm:
        diameter = math.sqrt(4.0 * stiffness_cN_mm * length / (math.pi * young))
        if diameter >= LEAST_FOOT_mm:
            return Pin(round(diameter, 2), length, hardness)
    if stiffness_cN_mm < LEAST_FOOT_cN_mm:
        return Pin(0.0, FOOT_LENGTHS_mm[0], hardness)
    return choose_leaf(0.0, stiffness_cN_mm, stiffness_cN_mm * way_mm, making)
