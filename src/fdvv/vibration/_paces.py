"""The vibrations of a button from the presses of all its paces: what one tells serves the others."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from fdvv.model import Stroke
from fdvv.vibration._energy import SnapEnergy
from fdvv.vibration._pool import MeasuredVibration, measure_vibration
from fdvv.vibration._ring import Ring
from fdvv.vibration._shared import SharedMode, shared_mode, shared_rings, with_shared
from fdvv.vibration._snap import HeardPress, NotFound

Known = tuple[tuple[float, float], ...]


@dataclass(frozen=True, eq=False)
class PacePresses:
    """The presses of one stroke at one pace, and the fall of force that drives their snap.

    energy : None where force does not fall.
    """

    stroke: Stroke
    velocity_mm_s: float
    presses: tuple[HeardPress, ...]
    energy: SnapEnergy | None


def measure_paces(
    paces: Sequence[PacePresses], acceleration: bool
) -> tuple[list[MeasuredVibration | NotFound], SharedMode | None]:
    """Measure the vibration of every stroke and pace of one button, and the mode that they share.

    acceleration : the signal is an acceleration, not a velocity.

    Presses are measured by themselves first, then again where others of them tell of modes that they did not;
    releases with the modes of the presses. Rings are told again with the principal mode that they share.
    """
    first = [_measured(pace, acceleration, ()) for pace in paces if pace.stroke is Stroke.PRESS]
    known, told = shared_rings(_rings(first)), iter(first)
    again = [
        _sharper(next(told), pace, acceleration, known)
        if pace.stroke is Stroke.PRESS
        else _measured(pace, acceleration, known)
        for pace in paces
    ]
    mode = shared_mode(_rings(again))
    if mode is not None:
        again = [one if isinstance(one, NotFound) else with_shared(one, mode) for one in again]
    return again, mode


def _measured(pace: PacePresses, acceleration: bool, known: Known) -> MeasuredVibration | NotFound:
    if not pace.presses:
        return NotFound("no press of it was heard")
    return measure_vibration(pace.presses, pace.velocity_mm_s, pace.energy, acceleration, known)


def _sharper(
    was: MeasuredVibration | NotFound, pace: PacePresses, acceleration: bool, known: Known
) -> MeasuredVibration | NotFound:
    """Measure again where it did not tell of all that is known; kept if as many presses show it."""
    if not known or (isinstance(was, MeasuredVibration) and all(was.rings_in(f) for f, _ in known)):
        return was
    again = _measured(pace, acceleration, known)
    if isinstance(was, MeasuredVibration) and (isinstance(again, NotFound) or again.shown < was.shown):
        return was
    return again


def _rings(found: Sequence[MeasuredVibration | NotFound]) -> list[Ring]:
    return [one.ring for one in found if isinstance(one, MeasuredVibration) and isinstance(one.ring, Ring)]
