"""How far a mechanism is from its target, where, and what of it no mechanism of the kind can give."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict, dataclass

import numpy as np

from fdvv.force_text import force_number, force_text
from fdvv.units import FloatArray
from fdvv_switch.dome import DomeMechanism
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.making import Making
from fdvv_switch.mechanism import Mechanism
from fdvv_switch.solve import rms
from fdvv_switch.target import SEATED_mm, Target
from fdvv_switch.tolerance import bump_of

WANTED_cN = 3.0
"""A design whose two strokes miss by no more than this, rms, gives the curve."""
NEAR = 0.97
"""A cam counts as at its limit from this part of it on."""
TELLING_cN = 0.5


@dataclass(frozen=True)
class Miss:
    """One stroke's difference of mechanism and target.

    Attributes
    ----------
    rms_cN : over the travel from 0; seated_rms_cN : from 0.1 mm, where the cap has left its top stop.
    largest_cN : signed, mechanism less target; largest_mm : where.
    """

    rms_cN: float
    seated_rms_cN: float
    largest_cN: float
    largest_mm: float


@dataclass(frozen=True)
class Residual:
    """What a mechanism misses.

    Attributes
    ----------
    press, release : see Miss.
    elastic_cN, loop_cN : rms of the mean of both strokes' differences, and of half of their difference: what
        springs, cam or dome miss, and what friction misses.
    reasons : sentences.
    """

    press: Miss
    release: Miss
    elastic_cN: float
    loop_cN: float
    reasons: tuple[str, ...]

    @property
    def worst_cN(self) -> float:
        """Get the rms of the worse stroke."""
        return max(self.press.rms_cN, self.release.rms_cN)

    @property
    def met(self) -> bool:
        """Return whether both strokes are within WANTED_cN."""
        return self.worst_cN <= WANTED_cN

    def to_dict(self) -> dict[str, object]:
        """Return it for JSON, units in the names."""
        return {**asdict(self), "worst_cN": self.worst_cN, "wanted_cN": WANTED_cN, "met": self.met}


def miss_of(x: FloatArray, got_cN: FloatArray, wanted_cN: FloatArray) -> Miss:
    """Compare one stroke with what was wanted, at displacements x (mm)."""
    error = got_cN - wanted_cN
    worst = int(np.argmax(np.abs(error)))
    return Miss(rms(error), rms(error[x >= SEATED_mm]), float(error[worst]), float(x[worst]))


def residual_of(target: Target, mechanism: Mechanism, making: Making) -> Residual:
    """Compare a mechanism's slow curves with its target and say what stands between them."""
    x = target.displacement_mm
    press, release = mechanism.strokes_cN(x)
    down, up = press - target.press_cN, release - target.release_cN
    return Residual(
        miss_of(x, press, target.press_cN),
        miss_of(x, release, target.release_cN),
        rms(0.5 * (down + up)),
        rms(0.5 * (down - up)),
        tuple(_reasons(target, mechanism, making, press, release)),
    )


def _reasons(
    target: Target, mechanism: Mechanism, making: Making, press: FloatArray, release: FloatArray
) -> Iterator[str]:
    if isinstance(mechanism, LeafMechanism):
        yield from _cam_limits(target, mechanism, making)
    else:
        yield from _shape(target, mechanism, press)
    yield from _loop(target, 0.5 * (press - release))
    yield from _start(target, press, release)


def _cam_limits(target: Target, mechanism: LeafMechanism, making: Making) -> Iterator[str]:
    x, cam = target.displacement_mm, mechanism.cam
    slope, curvature = cam.at(x, 1), cam.curvature_1_mm(x)
    outward = 1.0 / (making.nose_mm + making.edge_mm)
    for what, value, limit in (
        ("be steeper than the limit of {:.2g}", np.abs(slope), making.slope_ratio),
        ("turn outward more sharply than {:.2g} per mm", -curvature, outward),
        ("hollow more sharply than {:.2g} per mm", curvature, 1.0 / making.hollow_mm),
    ):
        at = x[(value >= NEAR * limit) & (x >= SEATED_mm)]
        if at.size:
            yield (
                f"from {at[0]:.2f} to {at[-1]:.2f} mm the curve asks the cam to {what.format(limit)}; "
                "this is the nearest that can be made"
            )


def _shape(target: Target, mechanism: Mechanism, press: FloatArray) -> Iterator[str]:
    x = target.displacement_mm
    wanted, got = bump_of(x, target.press_cN), bump_of(x, press)
    if isinstance(mechanism, DomeMechanism):
        if wanted and got and abs(wanted[2] - got[2]) > 0.02:
            yield (
                f"a cone that tips over gives a snap ratio of {got[2]:.2f} here, the curve has "
                f"{wanted[2]:.2f}: its force is nearly a cubic of the travel, so its peak and its valley "
                "cannot be shaped apart"
            )
        elif not wanted:
            yield "the curve has no bump, a dome is made for one"
    elif wanted:
        yield (
            f"the curve falls from {force_number(wanted[0], '.1f')} to {force_text(wanted[1], '.1f')}; the "
            "force of a coil only rises, "
            "so none can give this bump"
        )
    else:
        middle = target.middle_cN
        line = np.polynomial.Polynomial.fit(x, middle, 1)(x)
        if rms(middle - line) > TELLING_cN:
            yield (
                f"the curve's elastic part leaves a straight line by {force_text(rms(middle - line), '.1f')} "
                "rms, "
                "a coil is a straight line"
            )


def _loop(target: Target, half_cN: FloatArray) -> Iterator[str]:
    inside = target.displacement_mm >= SEATED_mm
    wanted, got = target.half_loop_cN[inside], half_cN[inside]
    if rms(got - wanted) > TELLING_cN:
        yield (
            f"half of the curve's loop goes from {force_number(wanted.min(), '.1f')} to "
            f"{force_text(wanted.max(), '.1f')} over the "
            f"travel, that of the mechanism from {got.min():.1f} to {got.max():.1f}: one coefficient of "
            "friction cannot change along the way"
        )


def _start(target: Target, press: FloatArray, release: FloatArray) -> Iterator[str]:
    x = target.displacement_mm
    first = x < SEATED_mm
    error = max(
        np.abs(press - target.press_cN)[first].max(), np.abs(release - target.release_cN)[first].max()
    )
    if error > 3.0:
        yield (
            f"up to {force_text(error, '.0f')} are missed before {SEATED_mm:g} mm, where the curves hold the "
            "give of the "
            "bench that measured them"
        )
