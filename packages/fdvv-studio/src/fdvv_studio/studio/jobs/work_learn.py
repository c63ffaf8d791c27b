"""The work of a job that learns an actuation, and of one that judges it."""

from __future__ import annotations

import json
from typing import Any, NamedTuple

from msgspec.structs import replace

from fdvv.compensation.identification.rig_file import load_learned_rig, save_rig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import Method, Tuning
from fdvv.compensation.paper import PaperLaw
from fdvv.device.contract import Device
from fdvv.io.files import write_atomic
from fdvv.model.file import load_model
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.rendering.actuation_file import save_actuation
from fdvv.rendering.compensate import CompensationResult, compensate, start_surface
from fdvv.rendering.evaluation.probe_curve import ProbeCurve
from fdvv.rendering.evaluation.verdict import headline
from fdvv.rendering.evaluation.vibration_presses import Playback
from fdvv.rendering.probe import probe
from fdvv.rendering.session import Session
from fdvv_studio.studio.jobs.events import JobOutcome, StageEvent
from fdvv_studio.studio.jobs.orders import CompensateOrder, ProbeOrder
from fdvv_studio.studio.jobs.work import Work, curve_noticed, curve_progress

PROBE_SEED = 1
"""Added to the seed that was learned with: what judges is fresh."""


def learn(work: Work, order: CompensateOrder) -> None:
    """Press without compensation, learn, keep what was learned, and judge it on fresh presses."""
    model, presses, seed = load_model(work.folder.button), order.probe_presses, order.settings.seed
    before = _baseline(work, order, model, seed + PROBE_SEED, presses)
    with work.session(order, work.folder.session, seed) as (device, session):
        work.tell(StageEvent("compensate", "learning what makes the rig feel like the button"))
        report_press, guide = work.reporter(model.travel_mm, "compensate"), work.guide(order.device)
        law, speeds = _law(work, order), order.settings.velocities_mm_s
        result = compensate(device, model, speeds, law, report_press, session, guide)
    _keep(work, result)
    with work.session(order, work.folder.probe, seed + PROBE_SEED) as pressed:
        _probe(work, order, pressed, model, _table(result), presses, before)


def judge(work: Work, order: ProbeOrder) -> None:
    """Judge a learned table, or the model's own force, on fresh presses."""
    model, learned, settings = load_model(work.folder.button), work.load_learned(), order.settings
    before = _baseline(work, order, model, settings.seed, settings.presses) if learned else ()
    with work.session(order, work.folder.probe, settings.seed) as (device, session):
        if not learned:
            _begin(work, device, model, order)
        table = _table(learned) if learned else _start_table(device, model, order)
        _probe(work, order, (device, session), model, table, settings.presses, before)


class _Table(NamedTuple):
    """What is judged, and the method and tuning it came with."""

    surface: ForceSurface
    method: str
    tuning: Tuning
    known_rig: RigModel | None = None


def _table(learned: CompensationResult) -> _Table:
    return _Table(learned.surface, learned.method, learned.outcome.tuning, learned.known_rig)


def _start_table(device: Device, model: FDVVModel, order: CompensateOrder | ProbeOrder) -> _Table:
    return _Table(start_surface(device, model, order.settings.velocities_mm_s), "not compensated", Tuning())


def _baseline(
    work: Work, order: CompensateOrder | ProbeOrder, model: FDVVModel, seed: int, presses: int
) -> tuple[ProbeCurve, ...]:
    """Press without compensation as often as what is judged, a simulated person in the same way."""
    with work.session(order, work.folder.baseline, seed) as (device, session):
        _begin(work, device, model, order)
        work.tell(StageEvent("baseline", "pressing without compensation, to compare"))
        surface, method, tuning, _ = _start_table(device, model, order)
        guide = work.guide(order.device)
        about = (work.reporter(model.travel_mm, "baseline"), method, session, guide, tuning)
        speeds, jnds = order.settings.velocities_mm_s, work.jnds
        return probe(device, model, surface, speeds, presses, *about, jnds=jnds).curves


def _probe(
    work: Work,
    order: CompensateOrder | ProbeOrder,
    pressed: tuple[Device, Session],
    model: FDVVModel,
    table: _Table,
    presses: int,
    before: tuple[ProbeCurve, ...],
) -> None:
    device, session = pressed
    surface, method, tuning, known = table
    work.tell(StageEvent("probe", "judging on fresh presses, in true displacement"))
    report_press, guide = work.reporter(model.travel_mm, "probe"), work.guide(order.device)
    speeds = order.settings.velocities_mm_s
    about = (method, session, guide, tuning, Playback(presses), known)
    result = probe(device, model, surface, speeds, presses, report_press, *about, jnds=work.jnds)
    report = {**result.to_dict(), "button": order.button}
    write_atomic(work.folder.result("measured"), json.dumps(report, allow_nan=False) + "\n")
    curves = tuple(curve_progress(curve.outcome) for curve in result.curves)
    counts = result.presses, len(result.skipped)
    record = result.to_dict()
    outcome = JobOutcome("probe", record["verdict"].removesuffix("."), *counts, result.simulated, curves)
    bare = {(curve.stroke, curve.velocity_mm_s): curve for curve in before}
    marks = tuple(curve_noticed(c, bare.get((c.stroke, c.velocity_mm_s))) for c in result.curves)
    judged = "simulated presses" if result.simulated else "held-out presses"
    line = headline(result.curves, before, judged if before else f"{judged}, uncompensated")
    work.tell(replace(outcome, next_step=record["next_step"], headline=line, noticed=marks))


def _keep(work: Work, result: CompensationResult) -> None:
    save_actuation(result, work.folder.result("actuation"))
    if result.learned_rig:
        save_rig(result.learned_rig, work.folder.result("rig"))
    curves = tuple(curve_progress(curve) for curve in result.outcome.curves)
    counts = result.presses, len(result.skipped)
    work.tell(JobOutcome("compensate", result.outcome.sentence, *counts, result.simulated, curves))


def _law(work: Work, order: CompensateOrder) -> PaperLaw | Method[Any]:
    known = work.folder.known_rig
    return order.settings.law(load_learned_rig(known) if known.exists() else None)


def _begin(work: Work, device: Device, model: FDVVModel, order: CompensateOrder | ProbeOrder) -> None:
    work.begin(device.info())
    work.tell_target(model, order.settings.velocities_mm_s)
