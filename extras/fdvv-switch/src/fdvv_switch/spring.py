"""A coil that returns a slider, and nothing else: what a linear key with a contactless sensor is."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fdvv.units import FloatArray
from fdvv_switch.coil import Coil, choose_coil
from fdvv_switch.guide import Guide
from fdvv_switch.making import Making
from fdvv_switch.solve import solve
from fdvv_switch.target import Target


@dataclass(frozen=True)
class SpringMechanism:
    """A coil and the guide of its slider."""

    coil: Coil
    guide: Guide

    kind = "spring"

    def strokes_cN(self, x: FloatArray) -> tuple[FloatArray, FloatArray]:
        """Return the slow press and release at displacements (mm), each as long as x."""
        spring = self.coil.preload_cN + self.coil.rate_cN_mm * x
        return self.guide.strokes_cN(x, spring, spring)


TAIL = (0.65, 0.9)
"""Part of the travel where a leaf has left its cam and the coil is alone."""

SOFTEST_cN_mm, STIFFEST_cN_mm = 1.0, 100.0

GUIDE_LOW, GUIDE_START, GUIDE_HIGH = (0.0, 0.0, 0.005), (1.0, 0.01, 0.03), (8.0, 0.15, 0.3)


def tail_line(target: Target) -> tuple[float, float]:
    """Fit preload (cN) and rate (cN/mm) of a line to the elastic part near the end of the travel."""
    x = target.displacement_mm
    tail = (x >= TAIL[0] * target.travel_mm) & (x <= TAIL[1] * target.travel_mm)
    line = np.polynomial.Polynomial.fit(x[tail], target.middle_cN[tail], 1).convert().coef
    return float(line[0]), float(line[1])


def coil_bounds(making: Making) -> tuple[tuple[float, float], tuple[float, float]]:
    """Return the least and the most of how far a coil is pressed in at rest (mm) and of its rate (cN/mm)."""
    space = making.envelope
    return (0.0, SOFTEST_cN_mm), (space.longest_mm - space.built_mm - 0.1, STIFFEST_cN_mm)


def design_spring(target: Target, making: Making) -> SpringMechanism:
    """Design the coil whose strokes miss the target least. Raises ModelError if none can be made."""
    x = target.displacement_mm

    def miss(p: FloatArray) -> FloatArray:
        return _miss(target, Guide(*p[2:]), p[1] * (p[0] + x))

    line = np.polynomial.Polynomial.fit(x, target.middle_cN, 1).convert().coef
    low, high = coil_bounds(making)
    rate = max(float(line[1]), low[1])
    start = np.array([max(float(line[0]), 0.0) / rate, rate, *GUIDE_START])
    p, _ = solve(miss, start, np.array([*low, *GUIDE_LOW]), np.array([*high, *GUIDE_HIGH]))
    coil = choose_coil(p[0] * p[1], p[1], target.travel_mm, making.envelope, making.wire)
    # the coil now has round sizes: the guide is found anew around it
    spring = coil.preload_cN + coil.rate_cN_mm * x
    bounds = np.array(GUIDE_LOW), np.array(GUIDE_HIGH)
    friction, _ = solve(lambda p: _miss(target, Guide(*p), spring), p[2:], *bounds)
    return SpringMechanism(coil, Guide(*map(float, friction)).rounded())


def _miss(target: Target, guide: Guide, spring_cN: FloatArray) -> FloatArray:
    press, release = guide.strokes_cN(target.displacement_mm, spring_cN, spring_cN)
    return np.concatenate([press - target.press_cN, release - target.release_cN])
