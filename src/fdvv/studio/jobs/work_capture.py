"""The work of a job that records a real button and makes a model of it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Literal

from fdvv.device import open_bench
from fdvv.model import save_model
from fdvv.recording import Stage
from fdvv.studio._drawn import DIGITS, known
from fdvv.studio._messages_events import JobBegun, JobOutcome, StageTold
from fdvv.studio._messages_orders import CaptureOrder
from fdvv.studio._messages_takes import CueBegun, PaceTold, TakeAsked, TakeTold
from fdvv.studio._work import Work
from fdvv.workflow import (
    CaptureGuide,
    CapturePlan,
    PaceStanding,
    TakeAsk,
    TakeDone,
    capture_session,
    cue_events,
    cue_length_s,
    process_recording,
)

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
        work.tell(JobBegun(work.run, info.name, info.simulated))
        work.tell(StageTold("capture", "recording the button"))
        paced = order.watch or not info.simulated
        guide = CaptureGuide(_cue(work, paced), lambda done: work.tell(_take(done)), work.notice)
        capture_session(bench, work.folder.recording, order.name, plan, guide)
    finally:
        bench.close()
    _process(work, order)


def _process(work: Work, order: CaptureOrder) -> None:
    work.tell(StageTold("process", "making a model of the recording"))
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


def _cue(work: Work, paced: bool) -> Callable[[TakeAsk], Callable[[float], None]]:
    """Give what tells of a cue as it begins; nobody follows one that is not paced."""

    def cue(ask: TakeAsk) -> Callable[[float], None]:
        begun = not paced
        if paced:
            work.tell(_asked(ask))

        def show(_t_s: float) -> None:
            nonlocal begun
            if not begun:
                begun = True
                work.tell(CueBegun())

        return show

    return cue


def _asked(ask: TakeAsk) -> TakeAsked:
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


def _take(done: TakeDone) -> TakeTold:
    take, verdict = done.take, done.verdict
    return TakeTold(
        take.number,
        STEPS[take.stage],
        take.velocity_mm_s,
        verdict.ok,
        verdict.reason,
        known(verdict.achieved_mm_s),
        known(verdict.travel_mm),
        done.done,
        done.total,
        done.missed,
        tuple(_pace(pace) for pace in done.standing),
    )


def _pace(pace: PaceStanding) -> PaceTold:
    speeds = tuple(round(v, DIGITS) for v in pace.achieved_mm_s)
    return PaceTold(pace.velocity_mm_s, pace.good, pace.wanted, pace.made, pace.missed, speeds)


def _counted(count: int, what: str) -> str:
    return f"{count} {what}{'' if count == 1 else 's'}"
