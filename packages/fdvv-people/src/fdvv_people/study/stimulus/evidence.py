"""What was physically rendered under one label: presses found in telemetry and judged one by one."""

from __future__ import annotations

import math

import numpy as np

from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm, mean_speed_mm_s, split_strokes
from fdvv.model.model import FDVVModel
from fdvv.model.press import Press
from fdvv.protocol.tables import Fault
from fdvv.rendering.press_check import bin_press, target_press
from fdvv.units import FloatArray
from fdvv_people.study.plan.trial import Rendered
from fdvv_studio.live.press import DEEP_mm, TOP_mm

REACHED_ratio = 0.5
"""Part of the judged places that a press must reach on its way down; a lesser one has no error."""
LEAD_s, SETTLE_s = 0.25, 0.1
"""Kept of what was before a press; a cap that stays above 0.3 mm for so long came back no further."""
STILL_mm, STILL_ROWS = 0.005, 20
"""A stretch in which the cap moved by less is kept in every 20th row: a held button adds no information."""
MOST_ROWS = 100_000
"""Of a longer press every second row is kept: its error gets coarser, or is missing."""


class RenderingEvidence:
    """Judges the presses of a label from telemetry, as it comes.

    Parameters
    ----------
    label, stimulus : names that `Rendered` keeps. model : what was intended.

    A press is what went deeper than 0.3 mm, as everywhere in live presses, and came back above it; one that
    had started before the label was shown does not count.
    """

    def __init__(self, label: str, stimulus: str, model: FDVVModel) -> None:
        self._label, self._stimulus, self._model = label, stimulus, model
        self._errors: list[float | None] = []
        self._speeds: list[float | None] = []
        self._vibrations = 0
        self._faults: dict[str, None] = {}  # in their order, each once
        self._kept: list[FloatArray] = []
        self._down = False

    @property
    def presses(self) -> int:
        return len(self._errors)

    def take(self, t_s: FloatArray, displacement_mm: FloatArray, force_cN: FloatArray) -> None:
        """Add telemetry, (n,) each: time, true displacement, force on the finger (nan: not known)."""
        if not t_s.size:
            return
        rows = np.stack([t_s, displacement_mm, force_cN])
        self._kept.append(rows[:, ::STILL_ROWS] if np.ptp(rows[1]) < STILL_mm else rows)
        if self._down and rows[1].min() > DEEP_mm:
            # a button that is held down for minutes must not fill the memory
            if sum(piece.shape[1] for piece in self._kept) > MOST_ROWS:
                self._kept = [np.hstack(self._kept)[:, ::2]]
            return
        kept = np.hstack(self._kept)
        while (found := _next_press(kept)) is not None:
            end, after, whole = found
            if whole:
                self._over(kept[:, :end])
            kept = kept[:, after:]
        self._down = bool((kept[1] > DEEP_mm).any())
        self._kept = [kept if self._down else kept[:, kept[0] >= kept[0, -1] - LEAD_s]]

    def played(self, vibrations: int) -> None:
        self._vibrations += vibrations

    def failed(self, fault: Fault | str) -> None:
        """Record a fault; with a vibration board that does not answer, no vibration counts as played."""
        if fault is Fault.VIBRATION_BOARD:
            self._vibrations = 0
        self._faults[fault_name(fault)] = None

    def cut(self) -> None:
        """End here, at a gap in telemetry or a change of labels: a press that is not back does not count."""
        kept = np.hstack([np.empty((3, 0)), *self._kept])
        found = _next_press(kept, 0.0)
        if found is not None and found[2]:
            self._over(kept)
        self._kept, self._down = [], False

    def rendered(self) -> Rendered:
        return Rendered(
            self._label,
            self._stimulus,
            self.presses,
            tuple(self._errors),
            tuple(self._speeds),
            self._vibrations,
            tuple(self._faults),
        )

    def _over(self, rows: FloatArray) -> None:
        error_cN, speed_mm_s = judged(self._model, rows)
        self._errors.append(error_cN)
        self._speeds.append(speed_mm_s)


def fault_name(fault: Fault | str) -> str:
    return fault.name.lower() if isinstance(fault, Fault) else fault


def _next_press(rows: FloatArray, settle_s: float = SETTLE_s) -> tuple[int, int, bool] | None:
    deep = rows[1] > DEEP_mm
    if not deep.any():
        return None
    start = int(deep.argmax())
    back = start + int((~deep[start:]).argmax())
    if deep[back]:
        return None
    t_s, x_mm = rows[0, back:], rows[1, back:]
    over = np.flatnonzero((x_mm <= TOP_mm) | deep[back:] | (t_s >= t_s[0] + settle_s))
    if not over.size:
        return None
    end = back + int(over[0]) + 1
    return end, back + int(rows[1, back:end].argmin()), start > 0


def judged(model: FDVVModel, rows: FloatArray) -> tuple[float | None, float | None]:
    """Return the rms error of the rendered force (cN) over both strokes, and the speed of the press (mm/s).

    rows : (3, n) time, true displacement and force of one press. Both strokes are binned as a probe bins
    them, and each is compared with the model at its own mean speed. None where it cannot be judged.
    """
    t_s, x_mm, force_cN = rows
    press = Press(t_s, x_mm, force_cN, 0.0)
    rendered = bin_press(press, model.travel_mm)
    down, up = (mean_speed_mm_s(t_s, x_mm, span) for span in split_strokes(x_mm, model.travel_mm))
    at_mm = rendered.displacement_mm
    counts = (at_mm >= FROM_mm) & (at_mm <= model.travel_mm - STOP_GUARD_mm)
    if not math.isfinite(down):
        return None, None
    speed_mm_s = round(down, 3)
    if np.isfinite(rendered.press_cN[counts]).mean() < REACHED_ratio:
        return None, speed_mm_s
    off = [rendered.press_cN - target_press(model, down).press_cN]
    if math.isfinite(up):
        off.append(rendered.release_cN - target_press(model, up).release_cN)
    error_cN = float(np.sqrt(np.nanmean(np.stack([one[counts] for one in off]) ** 2)))
    return round(error_cN, 4), speed_mm_s
