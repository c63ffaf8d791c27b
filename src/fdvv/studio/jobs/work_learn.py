"""The work of a job that learns an actuation, and of one that judges it."""

from __future__ import annotations

import json
from typing import Any

from fdvv.compensation.identification.rig_file import load_learned_rig, save_rig
from fdvv.compensation.method import Tuning
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.presses import AcceptanceLimits
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.contract import Device
from fdvv.io.files import write_atomic
from fdvv.model.file import load_model
from fdvv.model.model import FDVVModel
from fdvv.rendering.actuation_file import load_actuation, save_actuation
from fdvv.rendering.compensate import CompensationResult, compensate, uncompensated
from fdvv.rendering.probe import probe
from fdvv.rendering.session import Session
from fdvv.studio.jobs.events import JobOutcome, JobStarted, StageEvent
from fdvv.studio.jobs.orders import CompensateOrder, ProbeOrder
from fdvv.studio.jobs.work import Work, curve_progress, let_close

PROBE_SEED = 1
"""Added to the seed that was learned with: what judges is fresh."""


def learn(work: Work, order: CompensateOrder) -> None:
    """Learn, keep what was learned, and judge it on fresh presses if that is wanted."""
    model = load_model(work.folder.button)
    session = _session(work, order, order.seed, probing=False)
    device = session.open_device(order.device)
    try:
        _begin(work, device, model, order.velocities_mm_s)
        work.tell(StageEvent("compensate", "learning what makes the rig feel like the button"))
        result = compensate(
            device,
            model,
            order.velocities_mm_s,
            _law(work, order),
            work.pressed(model.travel_mm),
            session,
            work.guide(order.device),
        )
    finally:
        let_close(device)
    _keep(work, result)
    if order.probe_presses:
        _judge_learned(work, order, model, result)


def judge(work: Work, order: ProbeOrder) -> None:
    """Judge a learned table, or the model's own force, on fresh presses."""
    model = load_model(work.folder.button)
    learned = load_actuation(work.folder.actuation) if work.folder.actuation.exists() else None
    session = _session(work, order, order.seed, probing=True)
    device = session.open_device(order.device)
    try:
        _begin(work, device, model, order.velocities_mm_s)
        surface = learned.surface if learned else uncompensated(device, model, order.velocities_mm_s)
        about = (learned.method, learned.outcome.tuning) if learned else ("not compensated", Tuning())
        _probe(work, order, (device, session), model, (surface, *about), order.presses)
    finally:
        let_close(device)


def _judge_learned(work: Work, order: CompensateOrder, model: FDVVModel, result: CompensationResult) -> None:
    session = _session(work, order, order.seed + PROBE_SEED, probing=True)
    device = session.open_device(order.device)
    try:
        table = result.surface, result.method, result.outcome.tuning
        _probe(work, order, (device, session), model, table, order.probe_presses)
    finally:
        let_close(device)


def _probe(
    work: Work,
    order: CompensateOrder | ProbeOrder,
    pressed: tuple[Device, Session],
    model: FDVVModel,
    table: tuple[Any, str, Tuning],
    presses: int,
) -> None:
    device, session = pressed
    surface, method, tuning = table
    work.tell(StageEvent("probe", "judging on fresh presses, in true displacement"))
    report_press, guide = work.pressed(model.travel_mm), work.guide(order.device)
    speeds = order.velocities_mm_s
    result = probe(device, model, surface, speeds, presses, report_press, method, session, guide, tuning)
    report = {**result.to_dict(), "button": order.button}
    write_atomic(work.folder.result("measured"), json.dumps(report, allow_nan=False) + "\n")
    worst = max(result.curves, key=lambda c: c.outcome.mean_error_cN).outcome
    sentence = (
        f"mean error on fresh presses at most {worst.mean_error_cN:.2f} cN "
        f"({worst.stroke} at {worst.velocity_mm_s:g} mm/s)"
    )
    curves = tuple(curve_progress(curve.outcome) for curve in result.curves)
    counts = result.presses, len(result.skipped)
    work.tell(JobOutcome("probe", sentence, *counts, result.simulated, curves))


def _keep(work: Work, result: CompensationResult) -> None:
    """Keep what was learned in the job's folder, and tell of it."""
    save_actuation(result, work.folder.result("actuation"))
    if result.learned_rig:
        save_rig(result.learned_rig, work.folder.result("rig"))
    curves = tuple(curve_progress(curve) for curve in result.outcome.curves)
    counts = result.presses, len(result.skipped)
    work.tell(JobOutcome("compensate", result.outcome.sentence, *counts, result.simulated, curves))


def _law(work: Work, order: CompensateOrder) -> PaperLaw | RigAware:
    if order.method == "paper":
        return PaperLaw(rounds=order.rounds, presses_per_round=order.presses)
    known = work.folder.known_rig
    return RigAware(order.rounds, load_learned_rig(known) if known.exists() else None)


def _session(work: Work, order: CompensateOrder | ProbeOrder, seed: int, probing: bool) -> Session:
    folder = work.folder.probe if probing else work.folder.session
    rig = work.folder.rig if work.folder.rig.exists() else None
    return Session(folder, seed, rig, None, AcceptanceLimits(pace_ratio=order.pace_ratio))


def _begin(work: Work, device: Device, model: FDVVModel, velocities_mm_s: tuple[float, ...]) -> None:
    info = device.info()
    work.tell(JobStarted(work.run, info.name, info.simulated))
    work.intended(model, velocities_mm_s)
