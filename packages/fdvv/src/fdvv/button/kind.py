"""What the force of a button suggests it is: linear, tactile, clicky or a rubber dome, and how surely."""

from __future__ import annotations

from collections.abc import Callable
from enum import StrEnum
from typing import NamedTuple

import numpy as np

from fdvv.force_text import force_text
from fdvv.model.bump import Bump, find_bump
from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.units import FloatArray


class ButtonType(StrEnum):
    """What the force of a button does; a question mark belongs to what force alone can only suggest."""

    LINEAR = "linear"
    TACTILE = "tactile"
    CLICKY = "clicky?"
    DOME = "dome?"
    UNCLEAR = "unclear"


STOP_SHARE_mm = 0.15
"""A fall this near to the end of the travel is the stage turning or the stop giving way, not a bump."""

CONTACT_STEP_mm = 0.15
"""A peak within this of contact that the release does not repeat is breakaway friction."""

SUDDEN_mm, SUDDEN_ratio, SUDDEN_drop_cN = 0.05, 0.5, 10.0
"""Click bars, leaves and buckling springs lose more than half of their fall within 50 um, tactile switches
less. Below 10 cN a jerk of the stage does the same."""

SHIFT_mm, SHIFT_sudden_mm, SHIFT_ratio = 0.35, 0.2, 0.35
"""What clicks snaps back elsewhere than it snapped: its bump lies 0.5 to 1.3 mm less deep on the release,
others at most 0.31 mm. A fall of which a third is sudden is clicky from 0.2 mm on."""

DOME_fall_ratio, DOME_end_ratio, DOME_bend_cN = 0.28, 0.5, 4.0
"""Domes collapse over 0.3 to 0.6 of the travel, past its half, and then stiffen: the force climbs by 4 to
29 cN more over the last 15 % of the travel than over the 15 % before. A coil spring climbs evenly."""

SURE = {
    ButtonType.LINEAR: 0.99,
    ButtonType.TACTILE: 0.98,
    ButtonType.CLICKY: 0.93,
    ButtonType.DOME: 0.98,
}
SURE_press_alone = {**SURE, ButtonType.TACTILE: 0.80, ButtonType.CLICKY: 0.87}
"""How often a kind is right among 620 switches of stated type in the collections of ThereminGoat and BuddyOG,
the half that set the thresholds; with another mixture of types it is another."""


class ButtonKind(NamedTuple):
    """What the force of a button suggests, by which fact, and how often that is right; None if unclear."""

    kind: ButtonType
    fact: str
    sure_ratio: float | None = None


def bump_of(model: FDVVModel, stroke: Stroke) -> Bump | None:
    """Find the bump of the slowest curve of a stroke; what falls at the stop is none."""
    found = _samples(model, stroke)
    if found is None:
        return None
    x, force = found
    inside = x < model.travel_mm - STOP_SHARE_mm
    return find_bump(x[inside], force[inside]) if np.count_nonzero(inside) > 2 else None


def _samples(model: FDVVModel, stroke: Stroke) -> tuple[FloatArray, FloatArray] | None:
    curve = model.nearest(stroke)
    if curve is None:
        return None
    end = max(model.travel_mm, curve.start_mm + 0.1)
    x = np.linspace(curve.start_mm, end, max(8, round((end - curve.start_mm) / 0.01) + 1))
    return x, curve.force_cN(x)


WriteForce = Callable[[float, str], str]
"""Writes a force by its specification, with the unit."""


def _in_cN(force_cN: float, spec: str) -> str:
    return f"{force_cN:{spec}} cN"


def kind_of(model: FDVVModel) -> ButtonKind:
    """Decide what the force does, from the slowest press and its release.

    The fact names forces in cN, for files keep it.
    """
    kind, fact = _kind_of(model, _in_cN)
    sure = SURE if model.of(Stroke.RELEASE) else SURE_press_alone
    return ButtonKind(kind, fact, sure.get(kind))


def kind_sentence(model: FDVVModel) -> str:
    """Say what kind of button the curve suggests, and by which fact."""
    kind, fact = _kind_of(model, force_text)
    return f"{str(kind).capitalize().rstrip('?')}: {fact}."


def _kind_of(model: FDVVModel, write: WriteForce) -> tuple[ButtonType, str]:
    found = _samples(model, Stroke.PRESS)
    if found is None:
        return ButtonType.UNCLEAR, "no press was measured"
    bump, back = bump_of(model, Stroke.PRESS), bump_of(model, Stroke.RELEASE)
    if bump is None:
        return ButtonType.LINEAR, f"the force of the press never falls by {write(4, 'g')}"
    fall = f"the press falls by {write(bump.drop_cN, '.1f')} at {bump.peak_mm:.2f} mm"
    sudden = _sudden_ratio(bump, *found)
    if back is None and model.of(Stroke.RELEASE):
        if bump.peak_mm - found[0][0] <= CONTACT_STEP_mm:
            return (
                ButtonType.LINEAR,
                f"{fall}, breakaway at contact; the release never falls by {write(4, 'g')}",
            )
        return ButtonType.UNCLEAR, f"{fall}, but the release never falls by {write(4, 'g')}"
    if sudden >= SUDDEN_ratio:
        share = f"{fall}, {100 * sudden:.0f} % of it within 50 um"
        if bump.drop_cN < SUDDEN_drop_cN:
            return ButtonType.UNCLEAR, f"{share}: so small a jump may be the bench"
        return ButtonType.CLICKY, f"{share}; force alone does not tell the sound"
    shift_mm = 0.0 if back is None else _middle_mm(bump) - _middle_mm(back)
    if shift_mm >= (SHIFT_sudden_mm if sudden >= SHIFT_ratio else SHIFT_mm):
        snaps = f"the release {shift_mm:.2f} mm less deep: what clicks snaps back elsewhere"
        return ButtonType.CLICKY, f"{fall}, {snaps}"
    return _dome_or_tactile(bump, fall, write, *found)


def _dome_or_tactile(
    bump: Bump, fall: str, write: WriteForce, x: FloatArray, force: FloatArray
) -> tuple[ButtonType, str]:
    start, travel = x[0], x[-1] - x[0]
    climbs = np.diff(np.interp(start + travel * np.array([0.7, 0.85, 1.0]), x, force))
    bend_cN = float(climbs[1] - climbs[0])
    fall_ratio = (bump.valley_mm - bump.peak_mm) / travel
    past_half = bump.valley_mm - start >= DOME_end_ratio * travel
    if fall_ratio >= DOME_fall_ratio and past_half and bend_cN >= DOME_bend_cN:
        bends = f"then stiffens by {write(bend_cN, '.1f')} within 15 % of it"
        return ButtonType.DOME, f"{fall} over {100 * fall_ratio:.0f} % of the travel and {bends}"
    return ButtonType.TACTILE, fall


def _middle_mm(bump: Bump) -> float:
    return 0.5 * (bump.peak_mm + bump.valley_mm)


def _sudden_ratio(bump: Bump, x: FloatArray, force: FloatArray) -> float:
    """Return the largest share of the fall that happens within 50 um."""
    near = (x >= bump.peak_mm - 0.1) & (x <= bump.valley_mm + 0.05)
    later = np.interp(x[near] + SUDDEN_mm, x, force)
    return min(1.0, float(np.max(force[near] - later)) / bump.drop_cN)
