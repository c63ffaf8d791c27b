"""Learn the actuation that makes a device feel like a model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, TypeGuard

from fdvv.compensation.feasibility.limits import full_duty_cN
from fdvv.compensation.method import CompensationJob, CurveOutcome, Method, Outcome, PressCount
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.per_curve import PerCurve
from fdvv.compensation.presses import judge_press
from fdvv.device.contract import Device, ForceLoopDevice
from fdvv.device.lacking import lacking
from fdvv.device.remote import Remote
from fdvv.errors import DeviceError, InputError
from fdvv.io.documents import finite, to_plain
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import CellSpec, ForceLoopGains
from fdvv.rendering.part_watch import watch_of
from fdvv.rendering.run_summary import RunSummary, write_run_summary
from fdvv.rendering.session import Session
from fdvv.rendering.session_log import PressLog
from fdvv.rendering.session_run import Guide, Progress, SessionPlan, VelocityProgress, run

if TYPE_CHECKING:
    from fdvv.compensation.identification.rig_file import LearnedRig
    from fdvv.compensation.identification.rig_model import RigModel
    from fdvv.compensation.rig_aware import RigAware

SLOWEST_LOOP_s = ForceLoopGains.REALS["tick_s"][1]
"""A slower loop renders by tables: the cap would move on between two readings of the cell."""


@dataclass(frozen=True, eq=False)
class CompensationResult:
    """Actuation learned for one device.

    Attributes
    ----------
    method : name of the law with its additions.
    model_name, device_name, travel_mm : what was rendered, on which device, with the bottom stop where.
    outcome : surface of actuation, error history per curve, presses.
    skipped : unusable presses, each with its reason.
    simulated : the presses came from the twin.
    receipt : summary of the session; None in files of version 1.
    learned_rig : the rig, for other buttons; None for methods that learn tables only, and in files.
    known_rig : what was taken for granted of the rig, from its file; None where it was identified.
    """

    method: str
    model_name: str
    device_name: str
    travel_mm: float
    outcome: Outcome
    skipped: tuple[str, ...]
    simulated: bool
    receipt: RunSummary | None = None
    learned_rig: LearnedRig | None = None
    known_rig: RigModel | None = None

    @property
    def surface(self) -> ForceSurface:
        return self.outcome.surface

    @property
    def presses(self) -> int:
        """Number of presses made, including unusable ones."""
        return self.outcome.presses + len(self.skipped)

    def to_dict(self) -> dict[str, Any]:
        """Return the report: per curve error_k of every press as the rig measured it while it learned."""
        return {
            "method": self.method,
            "model": self.model_name,
            "device": self.device_name,
            "presses": self.presses,
            "skipped": list(self.skipped),
            "explanation": self.outcome.sentence,
            "curves": finite(to_plain(self.outcome.curves)),
            "simulated": self.simulated,
        }


def compensate(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    law: PaperLaw | Method[Any] | None = None,
    progress: Progress | None = None,
    session: Session | None = None,
    guide: Guide | None = None,
) -> CompensationResult:
    """Press and learn until the method is done.

    velocities_mm_s : speeds to learn at, in any order; law : settings of a method, the paper's if None; on a
    rig with a load cell `RigAware` closes the force loop (`ForceLoop`).
    progress : called after every press; guide : called before it, and with notices.
    session : where presses are stored and which are accepted; in memory with the defaults if None.

    Raises DeviceError if the device fails or too many presses in a row cannot be used, InputError on speeds
    that cannot be used and on a folder that is no session of this job, KeyboardInterrupt on Ctrl-C.
    """
    if is_rig_aware(law):
        fit_cell(device, law.cell)
    method, session = _method(law, device), session or Session()
    job = _job(device, model, velocities_mm_s, method)
    start, known = method.init(job), method.learned_rig
    if method.trial(start) is not None:
        check_force_sensor(device)
    guide = guide or Guide()
    for line in (*lacking(device, vibrating=False), _too_slow(device) if is_rig_aware(law) else ""):
        if line:
            guide.notice(line)
    speeds = job.target.velocity_mm_s.tolist()
    manifest = session.manifest("compensate", device, model, speeds, method.name, method)
    with session.open_log(manifest, PressLog) as log:
        plan = SessionPlan(
            "compensate",
            method,
            job.travel_mm,
            lambda press, pace: judge_press(press, job.travel_mm, session.acceptance.with_pace(pace)),
            session.acceptance.patience,
            lambda state: velocity_progress(job, method.count(state), log, method.done(state).curves),
            progress or (lambda _done: None),
            guide,
            parts=watch_of(device, job.travel_mm, session.checked_in),
        )
        if known and not log.used:  # a resumed session has been checked already
            from fdvv.rendering.known_rig import with_rig_check

            loop_closed = not is_rig_aware(method)  # which learns tables
            about = known.rig, job.travel_mm, loop_closed
            plan = replace(plan, progress=with_rig_check(plan.progress, plan.guide.notice, *about))
        state = run(device, plan, start, log)
        outcome = method.done(state)
        if not outcome.complete:
            raise DeviceError(f"{device.info().name}: {outcome.sentence}")
        receipt = write_run_summary(session.folder, manifest, log.runs, log.entries, outcome.curves)
        skipped = tuple(str(entry) for entry in log.entries if not entry.used)
    info = device.info()
    names = method.name, model.name, info.name, model.travel_mm
    taken = known.rig if known else None
    return CompensationResult(
        *names, outcome, skipped, info.simulated, receipt, method.rig_after(state), taken
    )


def is_rig_aware(law: PaperLaw | Method[Any] | None) -> TypeGuard[RigAware]:
    """Return whether a law identifies the rig; the paper's does not, and leaves that code unread."""
    if law is None or isinstance(law, PaperLaw | PerCurve):
        return False
    from fdvv.compensation.rig_aware import RigAware

    return isinstance(law, RigAware)


def velocity_progress(
    job: CompensationJob, count: PressCount, log: PressLog, curves: Sequence[CurveOutcome]
) -> tuple[VelocityProgress, ...]:
    speeds = job.target.velocity_mm_s.tolist()
    made = [sum(e.used and e.velocity_mm_s == speed for e in log.entries) for speed in speeds]
    wanted = count.wanted or (None,) * len(speeds)
    return tuple(
        VelocityProgress(speed, m, w, tuple(c for c in curves if c.velocity_mm_s == speed))
        for speed, m, w in zip(speeds, made, wanted, strict=True)
    )


def start_surface(
    device: Device,
    model: FDVVModel,
    velocities_mm_s: Sequence[float],
    law: PaperLaw | Method[Any] | None = None,
) -> ForceSurface:
    """Return the surface that a method starts from, before any press: the baseline of compensation.

    With the default law that is the model's own force, with a minimum command that holds the cap up.
    """
    method = _method(law, device)
    return method.done(method.init(_job(device, model, velocities_mm_s, method))).surface


def _method(law: PaperLaw | Method[Any] | None, device: Device) -> Method[Any]:
    if is_rig_aware(law) and (cell := loop_cell(law, device)):
        from fdvv.compensation.force_loop.method import ForceLoop

        return ForceLoop(cell, device.info().tick_s, law.rounds, law.learned_rig, prior=law.prior)
    return PerCurve(law or PaperLaw()) if law is None or isinstance(law, PaperLaw) else law


def loop_cell(law: RigAware, device: Device) -> CellSpec | None:
    """Return the load cell by which the force loop of a device is closed; None where none is."""
    if not isinstance(device, ForceLoopDevice) or device.info().tick_s > SLOWEST_LOOP_s:
        return None
    return device.load_cell and (law.cell or device.load_cell)


def _too_slow(device: Device) -> str:
    """Say that a rig with a load cell renders by tables because its loop is slow; empty if it is not so."""
    tick_s = device.info().tick_s
    if not (isinstance(device, ForceLoopDevice) and device.load_cell) or tick_s <= SLOWEST_LOOP_s:
        return ""
    return (
        f"a loop of {1 / tick_s:.0f} Hz is too slow to hold the force by the load cell (it takes "
        f"{1 / SLOWEST_LOOP_s:.0f}): tables are learned instead"
    )


def fit_cell(device: Device, cell: CellSpec | None) -> None:
    """Write the load cell of a data sheet to a board that has a force loop; others have no place for it."""
    if cell and isinstance(device, Remote) and device.force_loop.exists and device.load_cell != cell:
        device.fit_cell(cell)


def _job(
    device: Device, model: FDVVModel, velocities_mm_s: Sequence[float], method: Method[Any]
) -> CompensationJob:
    target = ForceSurface.of_model(model, check_speeds(velocities_mm_s), method.bin_mm)
    full_duty_N = full_duty_cN(device.settings()) / 100
    return CompensationJob(target, model.travel_mm, device.info().force_limit_cN, full_duty_N)


def check_force_sensor(device: Device, truth_counts: bool = False) -> None:
    """Raise DeviceError for a board without a force sensor; truth_counts accepts a simulated one."""
    estimated = getattr(device, "force_is_estimated", False)
    if not estimated and (not isinstance(device, Remote) or device.settings().force_gain_q14):
        return
    info = device.info()
    if estimated or not (truth_counts and info.simulated):
        of_twin = info.simulated and not estimated
        remedy = 'name a --rig with [keycap_sensor] kind = "force"' if of_twin else "fit one"
        raise DeviceError(
            f"{info.name}: no force sensor in its settings (force_gain_q14 is 0), its presses hold no "
            f"force on the finger; {remedy}"
        )


def check_speeds(velocities_mm_s: Sequence[float]) -> list[float]:
    """Return sorted speeds. Raises InputError unless they are positive, finite and distinct, at least one."""
    speeds = sorted(float(v) for v in velocities_mm_s)
    remedy = "give one or more different speeds above 0 mm/s"
    if not speeds or not all(0 < v < float("inf") for v in speeds):
        raise InputError("velocities", "all", f"speeds cannot be {list(velocities_mm_s)} mm/s", remedy)
    if len(set(speeds)) != len(speeds):
        raise InputError("velocities", "all", f"a speed repeats in {speeds} mm/s", remedy)
    return speeds
