"""What a capture tells of its takes, in order."""

from __future__ import annotations

from typing import Literal

import msgspec


class TakeAsked(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="take_asked"):
    """One take is asked for.

    Attributes
    ----------
    step : what is recorded. velocity_mm_s : None at rest. number, total : of the steps.
    again : why once more; empty the first time.
    contact_s, bottom_s : when contact and bottom are told, from the begin of the cue; None at rest.
    length_s : of the cue.
    """

    step: Literal["rest", "probe", "press"]
    velocity_mm_s: float | None
    travel_mm: float
    number: int
    total: int
    again: str
    contact_s: float | None
    bottom_s: float | None
    length_s: float


class CueBegun(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="cue"):
    """The cue of the take asked for last begins now."""


class PaceTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How far one pace is; achieved_mm_s of the good presses."""

    velocity_mm_s: float
    good: int
    wanted: int
    made: int
    missed: int
    achieved_mm_s: tuple[float, ...]


class TakeTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="take"):
    """A take that is on file.

    Attributes
    ----------
    reason : why it cannot be used and what to do; empty if it can.
    achieved_mm_s, travel_mm : None where there is none.
    missed : it was asked for often enough, the session goes on without.
    """

    number: int
    step: Literal["rest", "probe", "press"]
    velocity_mm_s: float | None
    ok: bool
    reason: str
    achieved_mm_s: float | None
    travel_mm: float | None
    done: int
    total: int
    missed: bool
    paces: tuple[PaceTold, ...]
