"""Evaluation of a rendering: fresh presses, errors in true displacement."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass, replace
from functools import partial
from typing import Any

from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import UNTUNED, PressCount, Trial, Tuning
from fdvv.compensation.presses import FROM_mm, STOP_GUARD_mm, judge_press
from fdvv.device.contract import Device
from fdvv.device.lacking import NO_FORCE_SENSOR, lacking
from fdvv.errors import ModelError
from fdvv.model.curve import Stroke, reading_order
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.model.press import Press
from fdvv.model.surface import ForceSurface
from fdvv.rendering.compensate import check_force_sensor, check_speeds
from fdvv.rendering.evaluation.noticed import overall
from fdvv.rendering.evaluation.probe_curve import ProbeCurve, judge_curves, with_vibrations
from fdvv.rendering.evaluation.verdict import RenderingMeans, next_step, verdict
from fdvv.rendering.evaluation.vibration_presses import (
    Playback,
    has_exciter,
    shows_vibration,
    upload_vibrating,
)
from fdvv.rendering.exciter import prepare_exciter
from fdvv.rendering.known_rig import with_rig_check
from fdvv.rendering.part_watch import watch_of
from fdvv.rendering.run_summary import RunSummary, write_run_summary
from fdvv.rendering.session import MANIFEST, Session, plain, read_manifest, table_digest
from fdvv.rendering.session_log import PressEntry, PressLog
from fdvv.rendering.session_run import Guide, Progress, SessionPlan, VelocityProgress, run

Groups = tuple[tuple[Press, ...], ...]
"""Presses of every velocity, in the order of the plan: silent ones, then those that play the vibrations."""


NOT_LEARNED = ("as uploaded", "not compensated", "uncompensated")
"""Methods of tables that no rig taught."""


@dataclass(frozen=True, eq=False)
class ProbePlan:
    """So many presses of one surface under one tuning at every velocity, one velocity after the other.

    vibrating : presses per velocity that also play the model's vibrations, after the silent ones; nobody is
        asked for them on a rig whose records do not show the cap's vibration.
    """

    surface: ForceSurface
    velocities_mm_s: tuple[float, ...]
    presses: int
    tuning: Tuning = UNTUNED
    vibrating: int = 0

    def init(self) -> Groups:
        return ((),) * (2 * len(self.velocities_mm_s))

    def trial(self, groups: Groups) -> Trial | None:
        """Return the first velocity that lacks presses; None when none does."""
        at = self._at(groups)
        if at is None:
            return None
        return Trial(self.surface, self.velocities_mm_s[at // 2], self.tuning, vibrating=at % 2 == 1)

    def of(self, groups: Groups) -> list[tuple[float, tuple[Press, ...], tuple[Press, ...]]]:
        """Return every velocity with its silent presses and its vibrating ones."""
        return list(zip(self.velocities_mm_s, groups[::2], groups[1::2], strict=True))

    def step(self, press: Press, groups: Groups) -> Groups:
        """Add a press to those of the velocity that was asked for. ModelError if none was."""
        at = self._at(groups)
        if at is None:
            raise ModelError("the probe is finished; no press was asked for")
        return (*groups[:at], (*groups[at], press), *groups[at + 1 :])

    def count(self, groups: Groups) -> PressCount:
        wanted = (self.presses + self.vibrating_after(groups),) * len(self.velocities_mm_s)
        return PressCount(sum(map(len, groups)), sum(wanted), wanted)

    def explain(self, groups: Groups) -> str:
        return ""

    def vibrating_after(self, groups: Groups) -> int:
        """Return how many presses play vibrations: none once a record has shown that it cannot hold them."""
        first = next((press for presses in groups for press in presses), None)
        return self.vibrating if first is None or shows_vibration(first) else 0

    def _at(self, groups: Groups) -> int | None:
        wanted = (self.presses, self.vibrating_after(groups))
        return next((i for i, presses in enumerate(groups) if len(presses) < wanted[i % 2]), None)


@dataclass(frozen=True, eq=False)
class ProbeResult:
    """How a surface renders a model, judged on presses that nothing was learned from.

    Attributes
    ----------
    method : what made the surface.
    range_mm : displacement judged.
    presses : made without vibrations, those that could not be used among them.
    skipped : the presses that could not be used, each with its reason.
    receipt : how it came about.
    means : what the rig has to render with.
    vibration_presses : used, with the model's vibrations.
    jnds : what a finger notices, by which the curves were judged.
    """

    method: str
    model_name: str
    device_name: str
    range_mm: tuple[float, float]
    curves: tuple[ProbeCurve, ...]
    presses: int
    skipped: tuple[str, ...]
    simulated: bool
    receipt: RunSummary
    means: RenderingMeans
    vibration_presses: int = 0
    jnds: Jnds = LITERATURE

    def to_dict(self) -> dict[str, Any]:
        """Return the report; errors in cN, true displacement, median over presses."""
        strokes = {
            str(stroke): overall([c.total for c in self.curves if c.stroke is stroke]).to_dict()
            for stroke in Stroke
            if any(c.stroke is stroke for c in self.curves)
        }
        return {
            "method": self.method,
            "model": self.model_name,
            "device": self.device_name,
            "range_mm": list(self.range_mm),
            "presses": self.presses,
            "vibration_presses": self.vibration_presses,
            "skipped": list(self.skipped),
            "curves": [c.to_dict() for c in self.curves],
            "noticeable": {
                "total": overall([c.total for c in self.curves]).to_dict(),
                **strokes,
                "jnds": self.jnds.to_dict(),
                "sources": [asdict(source) for source in self.jnds.sources],
            },
            "verdict": verdict(self.curves),
            "next_step": next_step(self.curves, self.means),
            "simulated": self.simulated,
        }


def fd_only(model: FDVVModel) -> FDVVModel:
    """Reduce a model to force and displacement: the slowest curve of each stroke, no vibration."""
    slowest = tuple(model.of(stroke)[0] for stroke in Stroke if model.of(stroke))
    return replace(model, name=f"{model.name} (FD only)", curves=slowest, vibrations=())


def probe(
    device: Device,
    model: FDVVModel,
    surface: ForceSurface,
    velocities_mm_s: Sequence[float],
    presses: int = 10,
    progress: Progress | None = None,
    method: str = "as uploaded",
    session: Session | None = None,
    guide: Guide | None = None,
    tuning: Tuning = UNTUNED,
    playback: Playback | None = None,
    known_rig: RigModel | None = None,
    jnds: Jnds = LITERATURE,
) -> ProbeResult:
    """Upload a surface once, press it afresh at every speed, and compare the rendered force with the model.

    presses : per velocity, usable ones. The force on the finger is binned on the true displacement of
    the cap and held against the model at the speed that was asked for. A press that cannot be used is not
    judged but counted, with its reason; being at its limit is the rig's own doing and is judged.
    progress, session, guide : as in ``compensate``. tuning : of the controller, as it was learned with the
    surface; the device keeps it afterwards.
    known_rig : what the surface was computed from, if not from presses on this device: the first presses are
        held against it.
    playback : also press with the model's vibrations, where it has some and the device an exciter; force is
    judged on the presses without. None, and in a session begun without: the cap's own motion is compared.
    jnds : what a finger notices; a project has its own where its people were measured (fdvv.model.jnd_file).

    Raises DeviceError if the device fails or too many presses in a row cannot be used, InputError on bad
    speeds and on a folder that is no session of this probe, KeyboardInterrupt on Ctrl-C.
    """
    session = session or Session()
    check_force_sensor(device, truth_counts=True)
    guide = guide or Guide()
    for line in lacking(device, vibrating=bool(playback and model.vibrations)):
        if line != NO_FORCE_SENSOR:  # a simulated rig's truth is judged without one
            guide.notice(line)
    if playback and not (model.vibrations and has_exciter(device) and not _lacks_vibrations(session)):
        playback = None
    if playback and playback.exciter:
        prepare_exciter(device, playback.exciter)
    count = playback.presses if playback else 0
    plan = ProbePlan(surface, tuple(check_speeds(velocities_mm_s)), presses, tuning, count)
    settings: dict[str, Any] = {"presses": presses, "surface_sha256": table_digest(surface)}
    if playback:
        settings["playback"] = plain(playback)
    if tuning != UNTUNED:
        settings["tuning"] = tuning.to_dict()
    manifest = session.manifest("probe", device, model, plan.velocities_mm_s, method, settings)
    # a rig at its limit is part of what is judged
    bounds = replace(session.acceptance, saturated_ratio=1.0)
    session_plan = SessionPlan(
        "probe",
        plan,
        model.travel_mm,
        lambda press, _pace_ratio: judge_press(press, model.travel_mm, bounds, true_position=True),
        bounds.patience,
        lambda groups: _standings(model, plan, groups),
        progress or (lambda _done: None),
        guide,
        partial(upload_vibrating, model=model, playback=playback) if playback else None,
        watch_of(device, model.travel_mm, session.checked_in),
    )
    with session.open_log(manifest, PressLog) as log:
        if not log.used:
            about = known_rig, model.travel_mm, tuning.loop is not None
            heard = with_rig_check(session_plan.progress, session_plan.guide.notice, *about)
            session_plan = replace(session_plan, progress=heard)
        groups = run(device, session_plan, plan.init(), log)
        curves = _with_vibrations(model, plan, groups, jnds)
        outcomes = [curve.outcome for curve in curves]
        receipt = write_run_summary(session.folder, manifest, log.runs, log.entries, outcomes)
        skipped = tuple(str(entry) for entry in log.entries if not entry.used)
    info, range_mm = device.info(), (FROM_mm, model.travel_mm - STOP_GUARD_mm)
    played = sum(len(vibrating) for *_, vibrating in plan.of(groups))
    presses, names = _silent(log.entries, plan), (method, model.name, info.name)
    means = RenderingMeans(
        learned=method not in NOT_LEARNED,
        force_loop=tuning.loop is not None,
        exciter=has_exciter(device),
        exciter_known=bool(playback and playback.exciter),
    )
    result = ProbeResult(*names, range_mm, tuple(curves), presses, skipped, info.simulated, receipt, means)
    return replace(result, vibration_presses=played, jnds=jnds)


def _lacks_vibrations(session: Session) -> bool:
    """Return whether a session in its folder was begun without vibrations, as older versions did."""
    path = session.folder / MANIFEST if session.folder else None
    return path is not None and path.is_file() and "playback" not in read_manifest(path).settings


def _silent(entries: Sequence[PressEntry], plan: ProbePlan) -> int:
    """Count the presses made without vibrations: those of each velocity until there were enough."""
    count, used = 0, dict.fromkeys(plan.velocities_mm_s, 0)
    for entry in entries:
        count += used[entry.velocity_mm_s] < plan.presses
        used[entry.velocity_mm_s] += entry.used
    return count


def _curves(model: FDVVModel, plan: ProbePlan, groups: Groups, jnds: Jnds = LITERATURE) -> list[ProbeCurve]:
    curves = [
        curve
        for speed, silent, _ in plan.of(groups)
        if silent
        for curve in judge_curves(model, speed, silent, jnds)
    ]
    return sorted(curves, key=reading_order)


def _with_vibrations(model: FDVVModel, plan: ProbePlan, groups: Groups, jnds: Jnds) -> list[ProbeCurve]:
    curves = _curves(model, plan, groups, jnds)
    judged = [
        curve
        for speed, silent, vibrating in plan.of(groups)
        for curve in with_vibrations(
            model, [c for c in curves if c.velocity_mm_s == speed], silent, vibrating
        )
    ]
    return sorted(judged, key=reading_order)


def _standings(model: FDVVModel, plan: ProbePlan, groups: Groups) -> tuple[VelocityProgress, ...]:
    curves = [curve.outcome for curve in _curves(model, plan, groups)]
    return tuple(
        VelocityProgress(
            speed,
            len(silent) + len(vibrating),
            plan.presses + plan.vibrating_after(groups),
            tuple(c for c in curves if c.velocity_mm_s == speed),
        )
        for speed, silent, vibrating in plan.of(groups)
    )
