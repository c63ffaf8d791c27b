"""What whoever does a job is given: its folder, someone to tell, someone to ask."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

from fdvv.compensate import CurveOutcome
from fdvv.device import Device, pressed_by_person
from fdvv.model import FDVVModel
from fdvv.studio._drawn import DIGITS, known, partly, rounded
from fdvv.studio._job_file import JobFolder
from fdvv.studio._messages_events import (
    CurveIntended,
    CurveStanding,
    FeltCurve,
    JobEvent,
    JobNoticed,
    PressAsked,
    PressTold,
)
from fdvv.workflow import Ask, Guide, PressDone, felt_press, intended_press, noticeable_cN


@dataclass(frozen=True, eq=False)
class Work:
    """One start of a job.

    Attributes
    ----------
    folder : of the job. run : counts the starts.
    tell : called with each event. ask : waits for the answer to the question of that number.
    """

    folder: JobFolder
    run: int
    tell: Callable[[JobEvent], None]
    ask: Callable[[int], str]

    def notice(self, text: str) -> None:
        """Tell what a person should know."""
        self.tell(JobNoticed(text))

    def guide(self, device: str) -> Guide:
        """Give what leads a session; only a person is asked for every press."""
        return Guide(self._asked if pressed_by_person(device) else lambda _ask: None, self.notice)

    def intended(self, model: FDVVModel, velocities_mm_s: tuple[float, ...]) -> None:
        """Tell what the model asks for at each speed."""
        for velocity in sorted(velocities_mm_s):
            wanted = intended_press(model, velocity)
            x_mm, down_cN, up_cN = map(rounded, (wanted.displacement_mm, wanted.press_cN, wanted.release_cN))
            self.tell(CurveIntended(velocity, x_mm, down_cN, up_cN, *noticeable_cN(model, velocity)))

    def pressed(self, travel_mm: float) -> Callable[[PressDone], None]:
        """Give what tells of presses."""
        return lambda done: self.tell(press_told(done, travel_mm))

    def _asked(self, ask: Ask) -> None:
        self.tell(PressAsked(ask.velocity_mm_s, ask.travel_mm, ask.number, ask.total))


def press_told(done: PressDone, travel_mm: float) -> PressTold:
    """Give the event of a press."""
    standing = next((s for s in done.standing() if s.velocity_mm_s == done.velocity_mm_s), None)
    felt = felt_press(done.press, travel_mm) if done.press else None
    return PressTold(
        "probe" if done.stage == "probe" else "compensate",
        done.velocity_mm_s,
        done.presses_done,
        done.presses_total,
        done.skipped,
        known(done.achieved_mm_s),
        done.told,
        standing.made if standing else 0,
        standing.wanted if standing else None,
        tuple(curve_standing(curve) for curve in standing.curves) if standing else (),
        FeltCurve(partly(felt.press_cN), partly(felt.release_cN)) if felt else None,
    )


def curve_standing(curve: CurveOutcome) -> CurveStanding:
    """Give how far a curve is."""
    return CurveStanding(
        "press" if str(curve.stroke) == "press" else "release",
        curve.velocity_mm_s,
        tuple(round(error, DIGITS) for error in curve.error_cN),
        known(curve.mean_error_cN),
        known(curve.max_error_cN),
    )


def let_close(device: Device) -> None:
    """Close a device that can be closed."""
    found: Any = device
    if hasattr(found, "close"):
        found.close()
