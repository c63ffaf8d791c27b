"""What makers' tolerances do to the curves: a band, and which of them matters most."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fdvv.model.bump import find_bump
from fdvv.units import FloatArray
from fdvv_switch.dome import DomeMechanism, Pin
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.material import coil_tolerance_mm, wire_tolerance_mm
from fdvv_switch.mechanism import Mechanism, varied
from fdvv_switch.solve import rms

SIGMAS = 2.0
"""A tolerance is taken as this many standard deviations of a normal distribution."""
DRAWS = 300
LEFT_ratio = 0.9
LOW_percent, HIGH_percent = 5.0, 95.0
LEAST_FALL_cN = 1.0


@dataclass(frozen=True)
class Tolerance:
    """By how much a part may differ.

    Attributes
    ----------
    name : for a person.
    path : of the number in the mechanism ("coil.wire_mm").
    half : the deviation to either side, in the unit of the path's name.
    source : where it comes from.
    """

    name: str
    path: str
    half: float
    source: str


@dataclass(frozen=True)
class Share:
    """What one tolerance alone does.

    rms_cN : rms change of both strokes at its limit.
    """

    tolerance: Tolerance
    rms_cN: float


@dataclass(frozen=True, eq=False)
class Band:
    """Curves of many parts made within tolerance; (n,) each, 5 and 95 percent at every displacement.

    peak_cN, valley_cN : 5 and 95 percent of the press's largest and following least force; None where most
        parts have no bump. snap_ratio : of the fall between them over the peak.
    shares : every tolerance by itself, the one that matters most first.
    """

    press_low_cN: FloatArray
    press_high_cN: FloatArray
    release_low_cN: FloatArray
    release_high_cN: FloatArray
    peak_cN: tuple[float, float] | None
    valley_cN: tuple[float, float] | None
    snap_ratio: tuple[float, float] | None
    shares: tuple[Share, ...]

    @property
    def half_width_cN(self) -> float:
        """Get half of the press band's width, the mean over the travel."""
        return float(0.5 * np.mean(self.press_high_cN - self.press_low_cN))


def tolerances_of(mechanism: Mechanism) -> tuple[Tolerance, ...]:
    """List what can differ between parts of one design."""
    friction = Tolerance("friction of the guide", "guide.drag_cN", 0.3 * mechanism.guide.drag_cN, "assumed")
    if isinstance(mechanism, DomeMechanism):
        return (*_dome(mechanism), friction)
    more = _leaf(mechanism) if isinstance(mechanism, LeafMechanism) else ()
    return (*_coil(mechanism), *more, friction)


def _coil(mechanism: Mechanism) -> Iterator[Tolerance]:
    assert not isinstance(mechanism, DomeMechanism)
    coil = mechanism.coil
    mean = coil_tolerance_mm(coil.mean_mm, coil.index)
    yield Tolerance("wire diameter", "coil.wire_mm", wire_tolerance_mm(coil.wire_mm), "EN 10270-1")
    yield Tolerance("coil diameter", "coil.mean_mm", mean, "DIN 2095 grade 1")
    yield Tolerance("active coils", "coil.active", 0.125, "assumed, an eighth of a turn")
    yield Tolerance("free length", "coil.free_mm", 0.02 * coil.free_mm, "assumed, 2 %")
    yield Tolerance("built length", "coil.built_mm", 0.05, "assumed, moulded housing")
    yield Tolerance("shear modulus", "coil.shear_ratio", 0.015, "assumed, 1.5 %")


def _leaf(mechanism: LeafMechanism) -> Iterator[Tolerance]:
    strip = 0.005 if mechanism.leaf.thickness_mm <= 0.1 else 0.008
    yield Tolerance("strip thickness", "leaf.thickness_mm", strip, "assumed, close to EN 1654")
    yield Tolerance("leaf length", "leaf.length_mm", 0.05, "assumed, clamp and punch")
    yield Tolerance("leaf width", "leaf.width_mm", 0.03, "assumed, punch")
    yield Tolerance(
        "leaf's bend", "leaf.offset_mm", _at_most(0.05, mechanism.leaf.offset_mm), "assumed, forming"
    )
    yield Tolerance("strip's modulus", "leaf.young_ratio", 0.02, "assumed, 2 %")
    yield Tolerance("friction on the cam", "friction_ratio", 0.25 * mechanism.friction_ratio, "assumed, 25 %")
    yield Tolerance("cam along the travel", "shift_mm", 0.05, "assumed, moulded slider")
    yield Tolerance("cam across the travel", "lift_mm", 0.03, "assumed, moulded slider")


def _dome(mechanism: DomeMechanism) -> Iterator[Tolerance]:
    yield Tolerance("hardness", "dome.hardness_shoreA", 5.0, "usual for compounds, ISO 48-4")
    yield Tolerance("wall", "dome.wall_mm", 0.03, "assumed, compression mould")
    yield Tolerance(
        "hinges", "dome.hinge_mm", _at_most(0.03, mechanism.dome.hinge_mm), "assumed, compression mould"
    )
    yield Tolerance("height", "dome.height_mm", 0.05, "assumed, compression mould")
    yield Tolerance("base diameter", "dome.base_mm", 0.1, "ISO 3302-1 M2, rounded")
    yield Tolerance("top diameter", "dome.top_mm", 0.1, "ISO 3302-1 M2, rounded")
    yield Tolerance("pressed in at rest", "dome.press_in_mm", 0.05, "assumed, stack of the key")
    yield Tolerance("gap of the foot", "gap_mm", 0.05, "assumed, stack of the key")
    if mechanism.pad:
        yield Tolerance("pad's diameter", "pad.diameter_mm", 0.03, "assumed, compression mould")
        yield Tolerance("pad's hardness", "pad.hardness_shoreA", 5.0, "usual for compounds, ISO 48-4")
    if isinstance(mechanism.foot, Pin):
        half = _at_most(0.03, mechanism.foot.diameter_mm)
        yield Tolerance("foot's diameter", "foot.diameter_mm", half, "assumed, compression mould")
    else:
        yield Tolerance("foot's strip", "foot.thickness_mm", 0.005, "assumed, close to EN 1654")


def _at_most(half: float, size: float) -> float:
    return min(half, LEFT_ratio * size)


def band_of(mechanism: Mechanism, x: FloatArray, draws: int = DRAWS, seed: int = 0) -> Band:
    """Make many parts at random within tolerance and give the band of their curves at displacements x (mm).

    The deviations are independent and normal, a tolerance being two standard deviations, cut off there.
    """
    listed = tolerances_of(mechanism)
    random = np.random.default_rng(seed)
    deviations = np.clip(random.standard_normal((draws, len(listed))) / SIGMAS, -1.0, 1.0)
    curves = np.array([_curves(mechanism, x, listed, row) for row in deviations])
    low, high = np.percentile(curves, [LOW_percent, HIGH_percent], axis=0)
    bumps = np.array([bump for press in curves[:, 0] if (bump := bump_of(x, press))])
    intervals = [_interval(bumps[:, i]) for i in range(3)] if len(bumps) > draws / 2 else [None] * 3
    shares = sorted(_shares(mechanism, x, listed), key=lambda share: -share.rms_cN)
    return Band(low[0], high[0], low[1], high[1], intervals[0], intervals[1], intervals[2], tuple(shares))


def _curves(
    mechanism: Mechanism, x: FloatArray, listed: tuple[Tolerance, ...], row: FloatArray
) -> tuple[FloatArray, FloatArray]:
    changes = {t.path: float(t.half * part) for t, part in zip(listed, row, strict=True)}
    return varied(mechanism, changes).strokes_cN(x)


def _interval(values: FloatArray) -> tuple[float, float]:
    low, high = np.percentile(values, [LOW_percent, HIGH_percent])
    return float(low), float(high)


def _shares(mechanism: Mechanism, x: FloatArray, listed: tuple[Tolerance, ...]) -> Iterator[Share]:
    for i, tolerance in enumerate(listed):
        row = np.zeros(len(listed))
        row[i] = 1.0
        up, down = (np.array(_curves(mechanism, x, listed, side * row)) for side in (1.0, -1.0))
        yield Share(tolerance, 0.5 * rms(up - down))


def bump_of(x: FloatArray, press_cN: FloatArray) -> tuple[float, float, float] | None:
    """Return peak, following valley and snap ratio of a press; None if it never falls by 1 cN."""
    bump = find_bump(x, press_cN, LEAST_FALL_cN)
    if bump is None or bump.peak_cN <= 0.0:
        return None
    return bump.peak_cN, bump.valley_cN, bump.snap_ratio
