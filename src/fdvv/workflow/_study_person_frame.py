"""What a participant's screen is told of the button under their hand: how deep it is, what it sounds like.

No force, no name and no number that tells one rendering from another but by pressing it.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass

import numpy as np

from fdvv.program import Signal
from fdvv.units import FloatArray
from fdvv.workflow._live_event import LiveEventKind
from fdvv.workflow._live_run import LiveFrame
from fdvv.workflow._study_stage_subject import StagedStimulus

ROW_s = 0.001
"""A screen is shown a row so often."""


@dataclass(frozen=True)
class PersonClick:
    """A vibration that starts: when (as in its frame), which of the trial's sounds, how fast the cap was."""

    t_s: float
    sound: int
    velocity_mm_s: float


@dataclass(frozen=True, eq=False)
class PersonFrame:
    """What happened since the last frame. Simulated.

    Attributes
    ----------
    label : that is under the hand.
    t_s, displacement_mm : (n,) of the cap, every millisecond; seconds since the stage was opened.
    key : level that is down, 0: up. clicks : vibrations to be heard. pressed : presses that ended.
    sequence : number of the last lead that had taken effect. dropped_s : real time that was not simulated.
    """

    label: str
    t_s: FloatArray
    displacement_mm: FloatArray
    key: int
    clicks: tuple[PersonClick, ...]
    pressed: int
    sequence: int
    dropped_s: float


class TrialSounds:
    """The vibrations of all labels of a trial in one list, whose order tells nothing.

    Attributes
    ----------
    signals : each once, sorted by what they sound like; clicks name them by place.
    """

    def __init__(self, of: Iterable[StagedStimulus] = ()) -> None:
        shared = {_sound(signal): signal for one in of for signal in one.subject.signals}
        self.signals: tuple[Signal, ...] = tuple(shared[key] for key in sorted(shared, key=repr))
        self._places: Mapping[object, int] = {_sound(one): place for place, one in enumerate(self.signals)}

    def place(self, signal: Signal) -> int:
        """Give the place of a label's signal in the list."""
        return self._places[_sound(signal)]


def person_frame(
    label: str, seen: LiveFrame, of: StagedStimulus, sounds: TrialSounds, opened_s: float
) -> PersonFrame:
    """Take from a live frame what a participant may see and hear."""
    columns, later_s = seen.columns, seen.zero_s - opened_s
    rows = np.diff(np.floor(columns.t_s / ROW_s + 1e-6), prepend=-1.0) > 0
    rows[-1:] = True
    clicks = tuple(
        PersonClick(e.t_s + later_s, sounds.place(of.subject.signals[e.number]), e.velocity_mm_s)
        for e in seen.events
        if e.kind is LiveEventKind.VIBRATION and of.audible
    )
    return PersonFrame(
        label,
        columns.t_s[rows] + later_s,
        columns.displacement_mm[rows],
        int(columns.key[-1]) if columns.key.size else 0,
        clicks,
        sum(e.kind is LiveEventKind.PRESSED for e in seen.events),
        seen.sequence,
        seen.dropped_s,
    )


def _sound(signal: Signal) -> tuple[float, tuple[object, ...]]:
    return signal.duration_s, signal.modes
