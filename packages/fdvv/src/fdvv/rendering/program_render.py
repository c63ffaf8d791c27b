"""Render a program on an identified rig: its image and tuning for this rig, and how well it is felt."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from fdvv.compensation.force_loop.gains import force_loop_gains
from fdvv.compensation.force_loop.method import BANDWIDTH_Hz, RUB_mm_s
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.method import UNTUNED, Tuning
from fdvv.compensation.rig_learning import tuning_of
from fdvv.device.contract import Device, ForceLoopDevice
from fdvv.device.twin import TwinDevice
from fdvv.errors import InputError
from fdvv.force_text import force_number, force_text
from fdvv.model.model import FDVVModel
from fdvv.model.noticeable import LITERATURE, Jnds
from fdvv.program.check import require_accepted
from fdvv.program.compensate import commands, loop_targets, with_learned
from fdvv.program.compile import compile_program
from fdvv.program.program import Program
from fdvv.program.surface import Limits
from fdvv.protocol.tables import CellSpec, ForceLoopGains
from fdvv.rendering.compensate import CompensationResult, check_speeds
from fdvv.rendering.evaluation.program_probe import StateError, all_errors_cN, judge_states
from fdvv.rendering.tuning import tune

JUDGED_mm_s = 100.0
"""Speed whose figures the verdict names, or the nearest one pressed."""


@dataclass(frozen=True)
class ProgramRendering:
    """A program made for one rig.

    Attributes
    ----------
    image : to upload, without a weight of its own. tuning : of the controller, with the loop's gains on a rig
        with a cell. plain : image of the start state alone, on which a simulated person learns the pace.
    """

    image: bytes
    tuning: Tuning
    plain: bytes

    def put_on(self, device: Any) -> None:
        """Tune a device and make the program active. DeviceError."""
        tune(device, self.tuning)
        _upload(device, self.image, self.plain)


def rendering_of(
    program: Program,
    device: Device,
    known: LearnedRig,
    learned: CompensationResult | None = None,
    button: FDVVModel | None = None,
) -> ProgramRendering:
    """Return what renders a program on an identified rig.

    With a load cell the loop is closed and the program's surfaces are its targets; without one they become
    the commands of this rig. learned, button : tables learned on this rig for a button, and its model: they
    serve wherever the program has that button's surfaces.

    Raises InputError for a program that is refused or does not fit once it is compensated.
    """
    settings, cell = device.settings(), _cell(device)
    still = np.zeros(1)
    weight_cN = -float(known.rig.opposing_cN(still, still, np.array([0.5 * program.travel_mm]))[0])
    require_accepted(program, Limits(settings=settings, weight_cN=weight_cN))
    if learned:
        tuning = learned.outcome.tuning
        if (tuning.loop is None) != (cell is None):
            reason = "was learned with a force loop" if tuning.loop else "was learned without a force loop"
            raise InputError(learned.model_name, "actuation", reason, "learn it on this rig")
    else:
        gains = force_loop_gains(known.rig, cell, device.info().tick_s) if cell else None
        tuning = tuning_with(known, program.travel_mm, gains)
    made = loop_targets(program) if cell else commands(program, known, device.info().force_limit_cN)
    if learned and button:
        made = with_learned(made, program, learned.surface, button)
    bare = Limits(settings=settings, weight_cN=0.0)
    return ProgramRendering(
        compile_program(made, bare).image,
        replace(tuning, paced=False),
        compile_program(start_alone(made), bare).image,
    )


def tuning_with(known: LearnedRig, travel_mm: float, gains: ForceLoopGains | None = None) -> Tuning:
    """Return the tuning of an identified rig: look-ahead, feed-forward, and the loop where there is one."""
    return replace(tuning_of(known.rig, travel_mm, BANDWIDTH_Hz, RUB_mm_s), paced=False, loop=gains)


def start_alone(program: Program) -> Program:
    """Return the start state of a program as a program of its own: what a hand presses at its own pace."""
    state = replace(
        program.state(program.start), transitions=(), enter_signal=None, repeat_signal=None, repeat_ms=0
    )
    used = tuple(s for s in program.surfaces if s.name in (state.press, state.release))
    return replace(program, states=(state,), surfaces=used, signals=(), vibrations=())


def _cell(device: Device) -> CellSpec | None:
    return device.load_cell if isinstance(device, ForceLoopDevice) else None


def _upload(device: Any, image: bytes, plain: bytes) -> None:
    if isinstance(device, TwinDevice):
        device.upload_program(image, paced_on=plain)
    elif hasattr(device, "upload_program"):
        device.upload_program(image)
    else:
        name = device.info().name
        raise InputError("--device", name, "it runs tables of force only", "use twin, host or serial:PORT")


@dataclass(frozen=True)
class ProgramReport:
    """How a program is felt on a rig, as it is and rendered; simulated.

    Attributes
    ----------
    closed : the force loop was closed.
    as_is, rendered : per state, stroke and speed; the same presses' number each.
    jnds : what a finger notices.
    """

    program: str
    device: str
    closed: bool
    presses: int
    as_is: tuple[StateError, ...]
    rendered: tuple[StateError, ...]
    jnds: Jnds = LITERATURE

    def at(self, velocity_mm_s: float, rendered: bool = True) -> list[StateError]:
        """Return the errors at one speed."""
        rows = self.rendered if rendered else self.as_is
        return [row for row in rows if row.velocity_mm_s == velocity_mm_s]

    @property
    def verdict_mm_s(self) -> float:
        """Return the speed that the verdict names."""
        return min((row.velocity_mm_s for row in self.rendered), key=lambda v: abs(v - JUDGED_mm_s))

    @property
    def median_cN(self) -> float:
        """Return the median error over all bins at the judged speed."""
        return float(np.median(all_errors_cN(self.at(self.verdict_mm_s))))

    @property
    def as_written(self) -> bool:
        """Return whether half of the bins at the judged speed are off by less than a finger would notice."""
        steps = np.concatenate([row.errors_JND for row in self.at(self.verdict_mm_s)])
        return bool(np.median(steps) <= 1)

    @property
    def worse(self) -> list[StateError]:
        """Return the states that are rendered worse than as they are, at the judged speed.

        Both in mean and in the sum over the way: after a step of force fewer bins are off, each by as much.
        """
        before = {(r.state, r.stroke): r.errors_cN for r in self.at(self.verdict_mm_s, False) if r.bins}
        worse = []
        for row in self.at(self.verdict_mm_s):
            was = before.get((row.state, row.stroke))
            if row.bins and was is not None and row.mean_cN > was.mean() and row.errors_cN.sum() > was.sum():
                worse.append(row)
        return worse

    @property
    def impact_cN(self) -> float:
        """Return the largest force with which a cap that was free met the finger; 0 if none did."""
        return max((row.impact_cN for row in self.rendered), default=0.0)

    @property
    def verdict(self) -> str:
        """Say in one sentence whether the program is felt as it is written."""
        speed = self.verdict_mm_s
        after, before = self.at(speed), self.at(speed, False)
        errors, median = all_errors_cN(after), self.median_cN
        worst = max(after, key=lambda row: row.mean_cN)
        felt = "felt as written" if self.as_written else "not yet felt as written"
        return (
            f"{self.program} is {felt}, by {self.jnds.origin}: median {force_text(median, '.1f')} off, mean "
            f"{force_number(errors.mean(), '.1f')} instead of "
            f"{force_number(all_errors_cN(before).mean(), '.1f')} at {speed:g} mm/s; most in {worst.state!r} "
            "on the "
            f"{worst.stroke}, mean {force_number(worst.mean_cN, '.1f')}"
        )

    @property
    def next_step(self) -> str:
        """Say what to do next."""
        if self.as_written:
            return "upload it to the rig with --device serial:PORT, or press it in fdvv studio"
        if self.closed:
            return "make the program's steps wider, or press slower"
        return "use a rig with a load cell (--rig recommended), or make the program's steps wider"

    def to_dict(self) -> dict[str, Any]:
        return {
            **{name: getattr(self, name) for name in ("program", "device", "closed", "presses")},
            "as_is": [row.to_dict() for row in self.as_is],
            "rendered": [row.to_dict() for row in self.rendered],
            "impact_cN": self.impact_cN,
            "verdict": self.verdict,
            "next": self.next_step,
            "simulated": True,
        }


def render_program(
    device: TwinDevice,
    program: Program,
    known: LearnedRig,
    velocities_mm_s: Sequence[float],
    presses: int = 3,
) -> ProgramReport:
    """Render a program on an identified rig and judge it; the rendering stays active.

    presses : per speed, as it is and rendered. Raises InputError, DeviceError.
    """
    return judge_rendering(device, program, rendering_of(program, device, known), velocities_mm_s, presses)


def judge_rendering(
    device: TwinDevice,
    program: Program,
    rendering: ProgramRendering,
    velocities_mm_s: Sequence[float],
    presses: int = 3,
    jnds: Jnds = LITERATURE,
) -> ProgramReport:
    """Press a program as it is and as it is rendered; see `render_program`. jnds : what a finger notices."""
    speeds = check_speeds(velocities_mm_s)
    tune(device, UNTUNED)
    as_it_is = compile_program(start_alone(program)).image
    device.upload_program(compile_program(program).image, paced_on=as_it_is)
    as_is = press_and_judge(device, program, speeds, presses, jnds)
    rendering.put_on(device)
    rendered = press_and_judge(device, program, speeds, presses, jnds)
    closed = rendering.tuning.loop is not None
    return ProgramReport(program.name, device.info().name, closed, presses, as_is, rendered, jnds)


def press_and_judge(
    device: TwinDevice, program: Program, velocities_mm_s: Sequence[float], presses: int, jnds: Jnds
) -> tuple[StateError, ...]:
    """Press what is active and judge it by what a program intends."""
    errors: list[StateError] = []
    for speed in velocities_mm_s:
        traces = [device.press_trace(speed) for _ in range(presses)]
        errors += judge_states(program, traces, speed, jnds)
    return tuple(errors)
