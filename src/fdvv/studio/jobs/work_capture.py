"""The work of a job that records a real button and makes a model of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from fdvv.bench.capture import CaptureGuide, TakeDone, TakeRequest, VelocityProgress, capture_session
from fdvv.bench.model import process_recording
from fdvv.bench.plan import CapturePlan, cue_events, cue_length_s
from fdvv.device.bench import open_bench
from fdvv.model.file import save_model
from fdvv.recording.types import Stage
from fdvv.studio.jobs.events import (
    CueStarted,
    JobOutcome,
    JobStarted,
    PaceProgress,
    StageEvent,
    TakeAsked,
    TakeEvent,
)
from fdvv.studio.jobs.orders import CaptureOrder
from fdvv.studio.jobs.work import Work
from fdvv.studio.rounding import DIGITS, finite_or_none

StepName = Literal["rest", "probe", "press"]
STEPS: dict[Stage, StepName] = {Stage.REST: "rest", Stage.PROBE: "probe", Stage.PRESS: "press"}


def capture(work: Work, order: CaptureOrder) -> None:
    """Record what the plan asks for, and process it into a model."""
    plan = CapturePlan(
        order.paces_mm_s,
        order.presses,
        order.probe,
        order.shuffled,
        order.seed,
        order.repeats,
        order.pace_ratio,
    )
    bench = open_bench(order.device, order.switch, order.participant, order.seed, order.watch)
    try:
        info = bench.facts()
        work.tell(JobStarted(work.run, info.name, info.simulated))
        work.tell(StageEvent("capture", "recording the button"))
        paced = order.watch or not info.simulated
        guide = CaptureGuide(_cue(work, paced), lambda done: work.tell(_take(done)), work.notice)
        capture_session(bench, work.folder.recording, order.name, plan, guide)
    finally:
        bench.close()
    _process(work, order)


def _process(work: Work, order: CaptureOrder) -> None:
    work.tell(StageEvent("process", "making a model of the recording"))
    found = process_recording(work.folder.recording)
    model = replace(found.model, name=order.name)
    save_model(model, work.folder.result("button"))
    used = sum(not judged.reason for judged in found.processed.judged)
    sentence = (
        f"a model of {len(model.curves)} curves and {_counted(len(model.vibrations), 'vibration')}, "
        f"travel {model.travel_mm:.2f} mm, from {used} presses"
    )
    presses, simulated = len(found.processed.judged), model.provenance.simulated
    work.tell(JobOutcome("capture", sentence, presses, presses - used, simulated, warnings=found.warnings))


def _cue(work: Work, paced: bool) -> Callable[[TakeRequest], Callable[[float], None]]:
    """Return the callback that reports a cue as it begins; only a paced cue is reported."""

    def cue(ask: TakeRequest) -> Callable[[float], None]:
        started = not paced
        if paced:
            work.tell(_asked(ask))

        def show(_t_s: float) -> None:
            nonlocal started
            if not started:
                started = True
                work.tell(CueStarted())

        return show

    return cue


def _asked(ask: TakeRequest) -> TakeAsked:
    velocity = ask.step.velocity_mm_s
    moments = dict(cue_events(velocity, ask.travel_mm))
    return TakeAsked(
        STEPS[ask.step.stage],
        velocity,
        ask.travel_mm,
        ask.number,
        ask.total,
        ask.again,
        moments.get("cue contact"),
        moments.get("cue bottom"),
        cue_length_s(ask.step.stage, velocity, ask.travel_mm),
    )


def _take(done: TakeDone) -> TakeEvent:
    take, check = done.take, done.check
    return TakeEvent(
        take.number,
        STEPS[take.stage],
        take.velocity_mm_s,
        check.ok,
        check.reason,
        finite_or_none(check.achieved_mm_s),
        finite_or_none(check.travel_mm),
        done.done,
        done.total,
        done.missed,
        tuple(_pace(pace) for pace in done.progress),
    )


def _pace(progress: VelocityProgress) -> PaceProgress:
    speeds = tuple(round(v, DIGITS) for v in progress.achieved_mm_s)
    return PaceProgress(
        progress.velocity_mm_s, progress.good, progress.wanted, progress.made, progress.missed, speeds
    )


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"
