"""The events of a job, in order; the page draws nothing else."""

from __future__ import annotations

from typing import Literal

import msgspec

from fdvv_studio.studio.contract import Message


class TakeAsked(Message, tag="take_asked"):
    """One take is asked for.

    step : what is recorded. velocity_mm_s : None at rest. number, total : of the steps.
    again : why once more; empty the first time.
    contact_s, bottom_s : when the cue announces contact and bottom, from its start; None at rest.
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


class CueStarted(Message, tag="cue"):
    """The cue of the take asked for last begins now."""


class PaceProgress(Message):
    """How far one pace is; achieved_mm_s of the good presses."""

    velocity_mm_s: float
    good: int
    wanted: int
    made: int
    missed: int
    achieved_mm_s: tuple[float, ...]


class TakeEvent(Message, tag="take"):
    """A take that is on file.

    reason : why it cannot be used and what to do; empty if it can.
    achieved_mm_s, travel_mm : None where there is none.
    missed : it was asked for often enough, the session continues without.
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
    paces: tuple[PaceProgress, ...]


StrokeName = Literal["press", "release"]


class JobStarted(Message, tag="begun"):
    """The work begins, or continues.

    run : counts the starts from 1. simulated : the device is.
    """

    run: int
    device: str
    simulated: bool


class StageEvent(Message, tag="stage"):
    """A part of the work begins."""

    stage: Literal["compensate", "baseline", "probe", "capture", "process", "tune"]
    text: str


class JobNoticed(Message, tag="notice"):
    """What a person should know."""

    text: str


class CurveIntended(Message, tag="intended"):
    """What a button asks for at one speed, and how much of a difference is just noticeable.

    displacement_mm, press_cN, release_cN : (n,).
    noticeable_press_cN, noticeable_release_cN : just noticeable difference, mean over each stroke; see
        fdvv.model.noticeable.
    press_jnd_cN, release_jnd_cN : (n,) the same at every place; empty in older jobs.
    jnds : whose just noticeable differences, in words; empty in older jobs.
    """

    velocity_mm_s: float
    displacement_mm: tuple[float, ...]
    press_cN: tuple[float, ...]
    release_cN: tuple[float, ...]
    noticeable_press_cN: float
    noticeable_release_cN: float
    press_jnd_cN: tuple[float, ...] = ()
    release_jnd_cN: tuple[float, ...] = ()
    jnds: str = ""


class CurveProgress(Message):
    """How far one curve is.

    error_cN : error_k of every press used, in order.
    mean_error_cN, max_error_cN : of what is kept; None if not known.
    """

    stroke: StrokeName
    velocity_mm_s: float
    error_cN: tuple[float, ...]
    mean_error_cN: float | None
    max_error_cN: float | None


class FeltCurve(Message):
    """Force on the finger over true displacement, on the grid of CurveIntended; None in bins without any."""

    press_cN: tuple[float | None, ...]
    release_cN: tuple[float | None, ...]


class PressAsked(Message, tag="press_asked"):
    """A person is asked for one press."""

    velocity_mm_s: float
    travel_mm: float
    number: int
    total: int


class PressEvent(Message, tag="press"):
    """A press that is on file.

    stage : "baseline" is pressed without compensation, to compare.
    done, total : presses used, and those it takes.
    skipped : why it was not used and what to do; empty if it was.
    achieved_mm_s : None if it has no speed. summary : what the method says that it changed.
    made, wanted : presses used at this velocity; wanted None if the method does not say.
    curves : of this velocity, as far as known. felt : None if there is no record.
    """

    stage: Literal["compensate", "baseline", "probe"]
    velocity_mm_s: float
    done: int
    total: int
    skipped: str
    achieved_mm_s: float | None
    summary: str = msgspec.field(name="told")
    made: int
    wanted: int | None
    curves: tuple[CurveProgress, ...]
    felt: FeltCurve | None


class PlayedWave(Message):
    """Acceleration of the cap, to be played."""

    rate_Hz: float
    acceleration_m_s2: tuple[float, ...]


class QuestionAsked(Message, tag="asked"):
    """A question to the observer; the waves are anonymous.

    waves : one to rate, or two to compare, in the order pressed. measured : what they should be like.
    """

    number: int
    total: int
    velocity_mm_s: float
    waves: tuple[PlayedWave, ...]
    measured: PlayedWave


class TuneCandidate(Message):
    """How one vibration stands: its strongest mode, score with standard error, and whether it may be best."""

    name: str
    frequency_Hz: float
    amplitude_m_s2: float
    score: float
    error: float | None
    alike: bool
    best: bool


class TuneRanking(Message):
    """What the answers at one velocity say."""

    velocity_mm_s: float
    answers: int
    sentence: str
    candidates: tuple[TuneCandidate, ...]


class QuestionAnswered(Message, tag="answered"):
    """An answer that is on file: who was preferred, or a rating; and what all so far say."""

    number: int
    total: int
    velocity_mm_s: float
    answer: str
    rankings: tuple[TuneRanking, ...]


class CurveNoticed(Message):
    """What a finger could notice of one curve, judged on presses that nothing was learned from.

    displacement_mm, noticed_ratio : (n,) part of the presses that would be noticed at each place.
    force_ratio, total_ratio : part of the stroke above one JND, of force and with vibration.
    vibration : how it came out, in a few words.
    before_ratio, before_mean_cN, before_max_cN : force_ratio and errors without compensation; None where that
        was not measured, as in older jobs. mean_cN, max_cN : errors that are left.
    """

    stroke: StrokeName
    velocity_mm_s: float
    displacement_mm: tuple[float, ...]
    noticed_ratio: tuple[float, ...]
    force_ratio: float
    total_ratio: float
    vibration: str
    before_ratio: float | None = None
    before_mean_cN: float | None = None
    before_max_cN: float | None = None
    mean_cN: float | None = None
    max_cN: float | None = None


class JobOutcome(Message, tag="outcome"):
    """What came out of a part of the work.

    headline, next_step, noticed : of a probe; empty otherwise, and in older jobs.
    sentence : in words. presses : made in all, or answers. skipped : of them not used.
    curves : error_k as the rig measured it while it learned, or in true displacement as the probe did.
    """

    stage: Literal["compensate", "probe", "capture", "tune"]
    sentence: str
    presses: int
    skipped: int
    simulated: bool
    curves: tuple[CurveProgress, ...] = ()
    rankings: tuple[TuneRanking, ...] = ()
    warnings: tuple[str, ...] = ()
    next_step: str = ""
    headline: str = ""
    noticed: tuple[CurveNoticed, ...] = ()


class JobEnded(Message, tag="ended"):
    """The work is over for now; line says why where it was not finished."""

    state: Literal["done", "cancelled", "failed"]
    line: str


JobEvent = (
    JobStarted
    | StageEvent
    | JobNoticed
    | CurveIntended
    | PressAsked
    | PressEvent
    | TakeAsked
    | CueStarted
    | TakeEvent
    | QuestionAsked
    | QuestionAnswered
    | JobOutcome
    | JobEnded
)
