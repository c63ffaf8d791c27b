"""What the press page gets while a button is pressed; every figure of it is simulated."""

from __future__ import annotations

from typing import Any

import numpy as np
from msgspec import field

from fdvv.model.vibration import Mode
from fdvv.units import FloatArray
from fdvv_studio.live.press import LiveEvent
from fdvv_studio.live.press_subject import PressMark, PressMode, PressSubject
from fdvv_studio.live.run import LiveFrame
from fdvv_studio.studio.contract import Message, message_of
from fdvv_studio.studio.rounding import round_row


class ShakeSignal(Message):
    """What the vibration board plays from one slot."""

    name: str
    duration_s: float
    modes: tuple[Mode, ...]


class PressMeant(Message, tag="meant"):
    """The force that is meant to be felt in a press at a speed."""

    velocity_mm_s: float
    displacement_mm: tuple[float, ...]
    press_cN: tuple[float, ...]
    release_cN: tuple[float, ...]


class PressReady(Message, tag="ready"):
    """Something is under the finger. about : what is between the two."""

    name: str
    about: str = field(name="told")
    mode: PressMode
    rig: str
    travel_mm: float
    actuation_mm: float | None
    reset_mm: float | None
    places: tuple[PressMark, ...]
    states: tuple[str, ...]
    signals: list[ShakeSignal]
    meant: PressMeant


class PressFrame(Message, tag="frame"):
    """What happened since the last frame.

    Columns have a row a millisecond; velocity_mm_s, state, key, mode, warm_K are those of the last tick.
    sequence : of the last lead that had taken effect. dropped_s : not simulated, since the start.
    """

    t_s: tuple[float, ...]
    displacement_mm: tuple[float, ...]
    force_cN: tuple[float, ...]
    finger_mm: tuple[float, ...]
    velocity_mm_s: float
    commanded_cN: float
    state: int
    key: int
    mode: int
    saturated: bool
    warm_K: float
    events: tuple[LiveEvent, ...]
    sequence: int
    dropped_s: float
    busy_ratio: float
    replaying: bool


ROW_s = 0.001
"""Between two rows of a frame."""
DIGITS, FORCE_DIGITS = 4, 2  # 0.1 um, 0.1 ms (a tenth of ROW_s) and 0.01 cN: below a pixel


def press_ready(subject: PressSubject) -> PressReady:
    return message_of(
        PressReady,
        subject,
        about=subject.description,
        rig=subject.rig_name,
        places=subject.marks,
        signals=[message_of(ShakeSignal, signal) for signal in subject.signals],
        meant=target_force(subject, 0.0),
    )


def target_force(subject: PressSubject, velocity_mm_s: float) -> PressMeant:
    press, release = subject.target_cN(velocity_mm_s)
    return PressMeant(
        velocity_mm_s,
        round_row(subject.displacement_mm, DIGITS),
        round_row(press, FORCE_DIGITS),
        round_row(release, FORCE_DIGITS),
    )


def press_frame(seen: LiveFrame, replaying: bool) -> PressFrame:
    c = seen.columns
    rows = _rows(c.t_s)
    return PressFrame(
        t_s=round_row(c.t_s[rows], DIGITS),
        displacement_mm=round_row(c.displacement_mm[rows], DIGITS),
        force_cN=round_row(c.force_cN[rows], FORCE_DIGITS),
        finger_mm=round_row(c.finger_mm[rows], DIGITS),
        velocity_mm_s=_last(c.velocity_mm_s),
        commanded_cN=_last(c.commanded_cN),
        state=int(_last(c.state)),
        key=int(_last(c.key)),
        mode=int(_last(c.mode)),
        saturated=bool(c.saturated.any()),
        warm_K=_last(c.warm_K),
        events=seen.events,
        sequence=seen.sequence,
        dropped_s=round(seen.dropped_s, DIGITS),
        busy_ratio=round(seen.busy_ratio, DIGITS),
        replaying=replaying,
    )


def _rows(t_s: FloatArray) -> Any:
    """Choose the first tick of every millisecond, and the last tick."""
    chosen = np.diff(np.floor(t_s / ROW_s + 1e-6), prepend=-1.0) > 0
    chosen[-1:] = True
    return chosen


def _last(values: Any) -> float:
    return round(float(values[-1]), DIGITS) if len(values) else 0.0
