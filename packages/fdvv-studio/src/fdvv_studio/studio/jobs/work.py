"""The context of a running job: its folder, the events it reports, the questions it asks."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any, Literal

import msgspec

from fdvv.compensation.method import CurveOutcome
from fdvv.compensation.presses import AcceptanceLimits
from fdvv.device.bench import BenchInfo
from fdvv.device.contract import Device, DeviceInfo
from fdvv.device.open import is_manual
from fdvv.model.jnd_file import project_jnds
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import Jnds
from fdvv.rendering.actuation_file import load_actuation
from fdvv.rendering.compensate import CompensationResult
from fdvv.rendering.evaluation.noticed import summarize
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.evaluation.verdict import short_outcome
from fdvv.rendering.press_check import bin_press, noticeable_cN, target_press
from fdvv.rendering.session import Session
from fdvv.rendering.session_run import Guide, PressDone
from fdvv_studio.studio.contract import message_of
from fdvv_studio.studio.jobs import events
from fdvv_studio.studio.jobs.file import JobFolder
from fdvv_studio.studio.jobs.orders import CompensateOrder, ProbeOrder, TuneOrder
from fdvv_studio.studio.rounding import DIGITS, finite_or_none, finite_row, round_row

PressStage = Literal["compensate", "baseline", "probe"]


@dataclass(frozen=True, eq=False)
class Work:
    """One start of a job.

    folder : of the job. run : counts the starts.
    tell : called with each event. ask : waits for the answer to the question of that number.
    """

    folder: JobFolder
    run: int
    tell: Callable[[events.JobEvent], None]
    ask: Callable[[int], str]

    def notice(self, text: str) -> None:
        self.tell(events.JobNoticed(text))

    def guide(self, device: str) -> Guide:
        """Return the guide of a session; only a person is asked for every press."""
        if not is_manual(device):
            return Guide(notice=self.notice)
        return Guide(lambda ask: self.tell(message_of(events.PressAsked, ask)), self.notice)

    @property
    def jnds(self) -> Jnds:
        """What people notice, as the project had it when the work was ordered."""
        return project_jnds(self.folder.path)

    def tell_target(self, model: FDVVModel, velocities_mm_s: tuple[float, ...]) -> None:
        jnds = self.jnds
        for velocity in sorted(velocities_mm_s):
            press = target_press(model, velocity)
            x_mm, down_cN, up_cN = map(round_row, (press.displacement_mm, press.press_cN, press.release_cN))
            self.tell(
                events.CurveIntended(
                    velocity,
                    x_mm,
                    down_cN,
                    up_cN,
                    *noticeable_cN(model, velocity, jnds),
                    press_jnd_cN=round_row(jnds.force_cN(press.press_cN)),
                    release_jnd_cN=round_row(jnds.force_cN(press.release_cN)),
                    jnds=jnds.origin,
                )
            )

    def reporter(self, travel_mm: float, stage: PressStage) -> Callable[[PressDone], None]:
        return lambda done: self.tell(press_event(done, travel_mm, stage))

    def load_learned(self) -> CompensationResult | None:
        """Return the learned table that is worked on; None: the model's own force."""
        return load_actuation(self.folder.actuation) if self.folder.actuation.exists() else None

    @contextmanager
    def session(
        self, order: CompensateOrder | ProbeOrder | TuneOrder, folder: Path, seed: int
    ) -> Iterator[tuple[Device, Session]]:
        """Open the device of an order for a session in a folder; it is closed at the end."""
        rig = self.folder.rig if self.folder.rig.exists() else None
        others = (self.folder.baseline, self.folder.session, self.folder.probe)
        limits = AcceptanceLimits(pace_ratio=order.settings.pace_ratio)
        session = Session(folder, seed, rig, None, limits, others)
        device: Any = session.open_device(order.device)
        try:
            yield device, session
        finally:
            if hasattr(device, "close"):
                device.close()

    def begin(self, info: DeviceInfo | BenchInfo) -> None:
        self.tell(events.JobStarted(self.run, info.name, info.simulated))


def press_event(done: PressDone, travel_mm: float, stage: PressStage) -> events.PressEvent:
    standing = next((s for s in done.progress() if s.velocity_mm_s == done.velocity_mm_s), None)
    rendered = bin_press(done.press, travel_mm) if done.press else None
    return events.PressEvent(
        stage,
        done.velocity_mm_s,
        done.presses_done,
        done.presses_total,
        done.skipped,
        finite_or_none(done.achieved_mm_s),
        done.message,
        standing.made if standing else 0,
        standing.wanted if standing else None,
        tuple(curve_progress(curve) for curve in standing.curves) if standing else (),
        events.FeltCurve(finite_row(rendered.press_cN), finite_row(rendered.release_cN))
        if rendered
        else None,
    )


def curve_noticed(curve: ProbeCurve, before: ProbeCurve | None) -> events.CurveNoticed:
    """Return what a finger could notice of a judged curve; before : the same without compensation."""
    event = events.CurveNoticed(
        "press" if str(curve.stroke) == "press" else "release",
        curve.velocity_mm_s,
        round_row(curve.displacement_mm),
        round_row((curve.total_JND > 1).mean(axis=0)),
        round(summarize(curve.force_JND).above_ratio, DIGITS),
        round(curve.total.above_ratio, DIGITS),
        short_outcome(curve.vibration),
        mean_cN=finite_or_none(curve.outcome.mean_error_cN),
        max_cN=finite_or_none(curve.outcome.max_error_cN),
    )
    if before is None:
        return event
    return msgspec.structs.replace(
        event,
        before_ratio=round(summarize(before.force_JND).above_ratio, DIGITS),
        before_mean_cN=finite_or_none(before.outcome.mean_error_cN),
        before_max_cN=finite_or_none(before.outcome.max_error_cN),
    )


def curve_progress(curve: CurveOutcome) -> events.CurveProgress:
    return events.CurveProgress(
        "press" if str(curve.stroke) == "press" else "release",
        curve.velocity_mm_s,
        tuple(round(error, DIGITS) for error in curve.error_cN),
        finite_or_none(curve.mean_error_cN),
        finite_or_none(curve.max_error_cN),
    )
