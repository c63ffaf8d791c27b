"""Vibrations of paces at which none was found, by a power law through those at which one was."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.model import Stroke, Vibration
from fdvv.vibration import MeasuredVibration, Scaling, fit_scaling
from fdvv.workflow._capture_heard import HeardStroke

FEWEST_PACES = 2
"""With fewer the exponent would be taken from a book."""


@dataclass(frozen=True)
class StrokeScaling:
    """How the principal amplitude of one stroke grows with the cap's speed at the snap and the fall of force.

    Attributes
    ----------
    scaling : its velocities are those of the cap at the snap, its amplitudes m/s2.
    speed_ratio : the cap's speed at the snap over the mean speed of the stroke, the median over paces.
    """

    stroke: Stroke
    scaling: Scaling
    speed_ratio: float

    def report(self) -> dict[str, Any]:
        """Give its figures by name; the error of the exponent is null where two paces leave none."""
        law = self.scaling
        return {
            "stroke": str(self.stroke),
            "amplitude_at_100_m_s2": law.amplitude_at_100,
            "exponent": law.exponent,
            "exponent_error": law.exponent_sd if math.isfinite(law.exponent_sd) else None,
            "snap_velocities_mm_s": list(law.velocities_mm_s),
        }


def stroke_scaling(
    heard: Sequence[HeardStroke], vibrations: Sequence[Vibration], stroke: Stroke
) -> StrokeScaling | None:
    """Fit the law of one stroke; None where fewer than two paces have a vibration."""
    pairs = [
        (one, one.found, v)
        for v in vibrations
        for one in heard
        if isinstance(one.found, MeasuredVibration)
        and v.stroke is one.stroke is stroke
        and v.velocity_mm_s == one.velocity_mm_s
    ]
    if len(pairs) < FEWEST_PACES:
        return None
    speeds = [found.snap_velocity_mm_s.value for _, found, _ in pairs]
    amplitudes = [abs(v.modes[0].amplitude_m_s2) for _, _, v in pairs]
    if min(speeds) <= 0 or min(amplitudes) <= 0:
        return None
    ratio = float(
        np.median([speed / one.achieved_mm_s for speed, (one, _, _) in zip(speeds, pairs, strict=True)])
    )
    energies = [found.energy.energy_mJ for _, found, _ in pairs]
    law = fit_scaling(speeds, amplitudes, energies if min(energies) > 0 else None)
    return StrokeScaling(stroke, law, ratio)


def scaled_vibrations(
    scaling: StrokeScaling, heard: Sequence[HeardStroke], vibrations: Sequence[Vibration]
) -> list[Vibration]:
    """Give a stroke's missing paces the vibration of the nearest pace, its amplitudes by the law.

    Paces whose force does not fall get none. Where an onset was found it is kept.
    """
    own = [v for v in vibrations if v.stroke is scaling.stroke and v.velocity_mm_s is not None]
    known = {v.velocity_mm_s for v in own}
    return [
        _scaled(scaling, one, own)
        for one in heard
        if one.stroke is scaling.stroke
        and one.velocity_mm_s is not None
        and one.velocity_mm_s not in known
        and one.energy is not None
        and own
    ]


def _scaled(scaling: StrokeScaling, one: HeardStroke, own: Sequence[Vibration]) -> Vibration:
    assert one.energy is not None
    assert one.velocity_mm_s is not None
    pace = one.velocity_mm_s
    near = min(own, key=lambda v: abs(math.log((v.velocity_mm_s or pace) / pace)))
    found = one.found if isinstance(one.found, MeasuredVibration) else None
    speed = found.snap_velocity_mm_s.value if found else scaling.speed_ratio * one.achieved_mm_s
    wanted = scaling.scaling.amplitude(speed, one.energy.energy_mJ)
    grown = wanted / abs(near.modes[0].amplitude_m_s2)
    modes = tuple(replace(mode, amplitude_m_s2=grown * mode.amplitude_m_s2) for mode in near.modes)
    onset_mm = found.onset_mm.value if found else near.onset_mm
    return replace(near, velocity_mm_s=pace, onset_mm=onset_mm, modes=modes, spread=None)


def scaling_words(scaling: StrokeScaling, made: Sequence[Vibration]) -> str:
    """Say which vibrations the law gave, and how well its exponent is known."""
    law = scaling.scaling
    paces = ", ".join(f"{v.velocity_mm_s:g}" for v in made if v.stroke is scaling.stroke)
    known = f"± {law.exponent_sd:.2f}" if math.isfinite(law.exponent_sd) else "of unknown error"
    return (
        f"vibration on the {scaling.stroke} at {paces} mm/s was not found but scaled from other paces: "
        f"amplitude as the cap's speed at the snap to the power {law.exponent:.2f} ({known}) and the root of "
        "its energy"
    )
