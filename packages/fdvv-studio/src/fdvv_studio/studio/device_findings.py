"""What is found of a connected device: how a press came out, what its load cell reads."""

from __future__ import annotations

import math

import numpy as np

from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm
from fdvv.device.contract import FREE_CELL_cN
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import Jnds
from fdvv.model.press import Press
from fdvv.rendering.evaluation.verdict import FEW_ratio
from fdvv.rendering.press_check import RenderedPress, bin_press, target_press
from fdvv_studio.studio.contract import Message
from fdvv_studio.studio.rounding import finite_row, round_row


class CellCheck(Message):
    """What the load cell read under a cap that nothing touches.

    sound : it read no force. reads_cN : mean reading. sentence : what that means, in one line.
    """

    sound: bool
    reads_cN: float
    sentence: str


class PressSeen(Message, tag="press_seen"):
    """Force over displacement of a press that was made, and what its button asks for.

    sentence : how far off it was. noticed : a finger would notice more than a tenth of it.
    displacement_mm : (n,) the grid of all columns. felt_* : None where the stroke was not.
    """

    velocity_mm_s: float
    simulated: bool
    displacement_mm: tuple[float, ...]
    felt_press_cN: tuple[float | None, ...]
    felt_release_cN: tuple[float | None, ...]
    intended_press_cN: tuple[float, ...]
    intended_release_cN: tuple[float, ...]
    sentence: str = ""
    noticed: bool = False


def press_seen(press: Press, model: FDVVModel, velocity_mm_s: float, jnds: Jnds) -> PressSeen:
    """Return how a press came out; jnds : what a finger notices."""
    rendered, wanted = bin_press(press, model.travel_mm), target_press(model, velocity_mm_s)
    error_cN, noticed = _off(rendered, wanted, model.travel_mm, jnds)
    simulated = ", simulated" if press.simulated else ""
    return PressSeen(
        velocity_mm_s,
        press.simulated,
        round_row(rendered.displacement_mm),
        finite_row(rendered.press_cN),
        finite_row(rendered.release_cN),
        round_row(wanted.press_cN),
        round_row(wanted.release_cN),
        f"Mean error {error_cN:.1f} cN in one press at {velocity_mm_s:g} mm/s{simulated}; "
        f"a finger would {'' if noticed else 'not '}notice it, by {jnds.origin}",
        noticed,
    )


def _off(rendered: RenderedPress, wanted: RenderedPress, travel_mm: float, jnds: Jnds) -> tuple[float, bool]:
    """Return the mean error where presses are judged, and whether a finger would notice much of it."""
    judged = (wanted.displacement_mm >= FROM_mm) & (wanted.displacement_mm <= travel_mm - STOP_GUARD_mm)
    rendered_cN = np.concatenate([rendered.press_cN[judged], rendered.release_cN[judged]])
    asked_cN = np.concatenate([wanted.press_cN[judged], wanted.release_cN[judged]])
    known = np.isfinite(rendered_cN)
    if not known.any():
        return math.nan, True
    error_cN = np.abs(rendered_cN - asked_cN)[known]
    return float(error_cN.mean()), bool((error_cN > jnds.force_cN(asked_cN)[known]).mean() > FEW_ratio)


def cell_check(reads_cN: float, closed: bool) -> CellCheck:
    """Judge what the cell of a free cap reads; closed : the force loop was closed then."""
    reads = f"With nothing on the cap the load cell reads {round(reads_cN, 1) + 0:.1f} cN"
    if abs(reads_cN) > FREE_CELL_cN:
        line = f"{reads}: too much. Keep your hands off and check again, or mend or zero the cell."
        return CellCheck(False, reads_cN, line)
    after = "the force loop is closed again" if closed else "it is sound"
    return CellCheck(True, reads_cN, f"{reads}: {after}.")
