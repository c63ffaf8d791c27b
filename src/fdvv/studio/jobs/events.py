"""What long work tells on its way, in order; the page draws nothing else."""

from __future__ import annotations

from typing import Literal

import msgspec

from fdvv.studio._messages_takes import CueBegun, TakeAsked, TakeTold

StrokeName = Literal["press", "release"]


class JobBegun(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="begun"):
    """The work begins, or goes on.

    Attributes
    ----------
    run : counts the starts from 1. simulated : the device is.
    """

    run: int
    device: str
    simulated: bool


class StageTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="stage"):
    """A part of the work begins."""

    stage: Literal["compensate", "probe", "capture", "process", "tune"]
    text: str


class JobNoticed(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="notice"):
    """What a person should know."""

    text: str


class CurveIntended(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="intended"):
    """What a button asks for at one speed, and how much of a difference is just noticeable.

    Attributes
    ----------
    displacement_mm, press_cN, release_cN : (n,).
    noticeable_press_cN, noticeable_release_cN : 7 % of each stroke's mean force (Pang, Tan, Durlach 1991).
    """

    velocity_mm_s: float
    displacement_mm: tuple[float, ...]
    press_cN: tuple[float, ...]
    release_cN: tuple[float, ...]
    noticeable_press_cN: float
    noticeable_release_cN: float


class CurveStanding(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How far one curve is.

    Attributes
    ----------
    error_cN : error_k of every press used, in order.
    mean_error_cN, max_error_cN : of what is kept; None if not known.
    """

    stroke: StrokeName
    velocity_mm_s: float
    error_cN: tuple[float, ...]
    mean_error_cN: float | None
    max_error_cN: float | None


class FeltCurve(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Force on the finger over true displacement, on the grid of CurveIntended; None in bins without any."""

    press_cN: tuple[float | None, ...]
    release_cN: tuple[float | None, ...]


class PressAsked(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="press_asked"):
    """A person is asked for one press."""

    velocity_mm_s: float
    travel_mm: float
    number: int
    total: int


class PressTold(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="press"):
    """A press that is on file.

    Attributes
    ----------
    done, total : presses used, and those it takes.
    skipped : why it was not used and what to do; empty if it was.
    achieved_mm_s : None if it has no speed. told : what the method says that it changed.
    made, wanted : presses used at this velocity; wanted None if the method does not say.
    curves : of this velocity, as far as known. felt : None if there is no record.
    """

    stage: Literal["compensate", "probe"]
    velocity_mm_s: float
    done: int
    total: int
    skipped: str
    achieved_mm_s: float | None
    told: str
    made: int
    wanted: int | None
    curves: tuple[CurveStanding, ...]
    felt: FeltCurve | None


class PlayedWave(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """Acceleration of the cap, to be played."""

    rate_Hz: float
    acceleration_m_s2: tuple[float, ...]


class QuestionAsked(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="asked"):
    """A question to whoever tunes; what is asked about bears no name.

    Attributes
    ----------
    waves : one to rate, or two to compare, in the order pressed. measured : what they should be like.
    """

    number: int
    total: int
    velocity_mm_s: float
    waves: tuple[PlayedWave, ...]
    measured: PlayedWave


class TuneCandidate(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """How one vibration stands: its strongest mode, score with standard error, and whether it may be best."""

    name: str
    frequency_Hz: float
    amplitude_m_s2: float
    score: float
    error: float | None
    alike: bool
    best: bool


class TuneRanking(msgspec.Struct, frozen=True, forbid_unknown_fields=True):
    """What the answers at one velocity say."""

    velocity_mm_s: float
    answers: int
    sentence: str
    candidates: tuple[TuneCandidate, ...]


class QuestionAnswered(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="answered"):
    """An answer that is on file: who was preferred, or a rating; and what all so far say."""

    number: int
    total: int
    velocity_mm_s: float
    answer: str
    rankings: tuple[TuneRanking, ...]


class JobOutcome(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="outcome"):
    """What came out of a part of the work.

    Attributes
    ----------
    sentence : in words. presses : made in all, or answers. skipped : of them not used.
    curves : error_k as the rig measured it while it learned, or in true displacement as the probe did.
    """

    stage: Literal["compensate", "probe", "capture", "tune"]
    sentence: str
    presses: int
    skipped: int
    simulated: bool
    curves: tuple[CurveStanding, ...] = ()
    rankings: tuple[TuneRanking, ...] = ()
    warnings: tuple[str, ...] = ()


class JobEnded(msgspec.Struct, frozen=True, forbid_unknown_fields=True, tag="ended"):
    """The work is over for now; line says why where it was not finished."""

    state: Literal["done", "cancelled", "failed"]
    line: str


JobEvent = (
    JobBegun
    | StageTold
    | JobNoticed
    | CurveIntended
    | PressAsked
    | PressTold
    | TakeAsked
    | CueBegun
    | TakeTold
    | QuestionAsked
    | QuestionAnswered
    | JobOutcome
    | JobEnded
)
