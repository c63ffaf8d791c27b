"""The work of a job that records a real button and makes a model of it."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import replace
from functools import cache
from typing import Literal

from fdvv.bench.capture import CaptureGuide, TakeDone, TakeRequest, VelocityProgress, capture_session
from fdvv.bench.model import process_recording
from fdvv.bench.plan import cue_events, cue_length_s
from fdvv.device.bench import open_bench, show_nothing
from fdvv.model.file import save_model
from fdvv.recording.types import Stage
from fdvv_studio.studio.contract import message_of
from fdvv_studio.studio.jobs import events
from fdvv_studio.studio.jobs.orders import CaptureOrder
from fdvv_studio.studio.jobs.work import Work
from fdvv_studio.studio.rounding import DIGITS, finite_or_none

StepName = Literal["rest", "probe", "press"]
STEPS: dict[Stage, StepName] = {Stage.REST: "rest", Stage.PROBE: "probe", Stage.PRESS: "press"}


def capture(work: Work, order: CaptureOrder) -> None:
    """Record what the plan asks for, and process it into a model."""
    bench = open_bench(order.device, order.switch, order.participant, order.settings.seed, order.watch)
    with closing(bench):
        info = bench.facts()
        work.begin(info)
        work.tell(events.StageEvent("capture", "recording the button"))
        paced = order.watch or not info.simulated
        guide = CaptureGuide(_cue(work, paced), lambda done: work.tell(_take(done)), work.notice)
        capture_session(bench, work.folder.recording, order.name, order.settings, guide)
    _process(work, order)


def _process(work: Work, order: CaptureOrder) -> None:
    work.tell(events.StageEvent("process", "making a model of the recording"))
    recorded = process_recording(work.folder.recording)
    model = replace(recorded.model, name=order.name)
    save_model(model, work.folder.result("button"))
    used = sum(not judged.reason for judged in recorded.processed.judged)
    sentence = (
        f"a model of {len(model.curves)} curves and {_count(len(model.vibrations), 'vibration')}, "
        f"travel {model.travel_mm:.2f} mm, from {used} presses"
    )
    presses, simulated = len(recorded.processed.judged), model.provenance.simulated
    counts = presses, presses - used
    work.tell(events.JobOutcome("capture", sentence, *counts, simulated, warnings=recorded.warnings))


def _cue(work: Work, paced: bool) -> Callable[[TakeRequest], Callable[[float], None]]:
    """Return the callback that reports a cue as it begins; only a paced cue is reported."""

    def cue(ask: TakeRequest) -> Callable[[float], None]:
        if not paced:
            return show_nothing
        work.tell(_take_asked(ask))
        started = cache(lambda: work.tell(events.CueStarted()))  # at its first moment only
        return lambda _t_s: started()

    return cue


def _take_asked(ask: TakeRequest) -> events.TakeAsked:
    velocity, stage = ask.step.velocity_mm_s, ask.step.stage
    moments = dict(cue_events(velocity, ask.travel_mm))
    return message_of(
        events.TakeAsked,
        ask,
        step=STEPS[stage],
        velocity_mm_s=velocity,
        contact_s=moments.get("cue contact"),
        bottom_s=moments.get("cue bottom"),
        length_s=cue_length_s(velocity, ask.travel_mm),
    )


def _take(done: TakeDone) -> events.TakeEvent:
    take, check = done.take, done.check
    return message_of(
        events.TakeEvent,
        done,
        number=take.number,
        step=STEPS[take.stage],
        velocity_mm_s=take.velocity_mm_s,
        ok=check.ok,
        reason=check.reason,
        achieved_mm_s=finite_or_none(check.achieved_mm_s),
        travel_mm=finite_or_none(check.travel_mm),
        paces=tuple(_pace(pace) for pace in done.progress),
    )


def _pace(progress: VelocityProgress) -> events.PaceProgress:
    speeds = tuple(round(v, DIGITS) for v in progress.achieved_mm_s)
    return message_of(events.PaceProgress, progress, achieved_mm_s=speeds)


def _count(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"
