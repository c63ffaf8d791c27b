"""Iterative learning on an identified rig: error of a press, correction of the tables, commands."""

from __future__ import annotations

from dataclasses import dataclass, field, replace

import numpy as np
import numpy.typing as npt

from fdvv.compensation.identification.balance import DRAG_cN, cN_PER_g_m_s2
from fdvv.compensation.identification.rig_file import LearnedRig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.compensation.method import CompensationJob, CurveOutcome, Tuning, error_cN
from fdvv.compensation.paper import PaperLaw
from fdvv.compensation.presses import FROM_mm, HOME_mm, STOP_GUARD_mm
from fdvv.compensation.stroke_samples import StrokeSample
from fdvv.compensation.tables import SharedTable, bin_force
from fdvv.errors import ModelError
from fdvv.force_text import force_number, force_text
from fdvv.model.curve import Stroke
from fdvv.model.surface import ForceSurface
from fdvv.units import FloatArray

LONGEST_STEP_s = 2.5e-4  # of 4 kHz: finger on 1.3 N/mm advances 0.12 rad; in 1 ms 0.5, too coarse for Euler


@dataclass(frozen=True)
class FingerJoint:
    """A nominal finger about its joint: mass with its sensor, damper and spring.

    The middle of the ranges of Hajian and Howe (1997, as recalled). Half or twice the mass makes learning
    slower, not wrong.
    """

    mass_g: float = 8.0
    damping_N_s_m: float = 5.5
    stiffness_N_m: float = 600.0

    def __post_init__(self) -> None:
        if not (self.mass_g > 0 and self.damping_N_s_m >= 0 and self.stiffness_N_m >= 0):
            raise ModelError(f"a finger needs a mass above 0, and no numbers below 0, got {self}")


def predict_change(
    stroke: StrokeSample, target_cN: FloatArray, grid_mm: FloatArray, finger: FingerJoint
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Predict the change of displacement (mm), speed (mm/s), acceleration (m/s2) by the target force, (n,).

    A finger that feels less force moves faster, and the cap with it, so a command that cancels inertia
    causes more of it. The change q obeys

        m q'' + b q' + k q = rendered - target(x + q)

    target_cN, grid_mm : (g,) intended force.
    """
    # unit forces: cN over mm, so 1 N s/m is 0.1 cN s/mm and 1 g is 1e-4 cN s2/mm
    mass, damping = 1e-4 * finger.mass_g, 0.1 * finger.damping_N_s_m
    stiffness = 0.1 * finger.stiffness_N_m
    parts = max(1, round(stroke.tick_s / LONGEST_STEP_s))
    step = stroke.tick_s / parts
    slope = np.gradient(target_cN, grid_mm)
    excess = (stroke.rendered_cN - np.interp(stroke.displacement_mm, grid_mm, target_cN)).tolist()
    softer = (stiffness + np.interp(stroke.displacement_mm, grid_mm, slope)).tolist()
    rows, q, w = [], 0.0, 0.0
    for push, spring in zip(excess, softer, strict=True):
        for _ in range(parts):
            w = (w + step * (push - spring * q) / mass) / (1.0 + step * damping / mass)
            q += step * w
        rows.append((q, w, (push - spring * q - damping * w) / mass))
    change = np.array(rows).reshape(-1, 3)
    return change[:, 0], change[:, 1], change[:, 2] / 1000.0


LIFT_cN = 50.0
"""Least force in the first 0.1 mm: a table of displacement does not see whether the cap rests or moves."""
TYPICAL_m_s2, TYPICAL_mm_s = 14.0, 200.0
"""Mean size of the acceleration of a stroke, which grows with the square of speed; on the twin, simulated."""
SPREAD_mm_s = (0.0, 50.0, 100.0, 150.0, 200.0, 300.0)
SPREAD_m_s2 = (0.3, 1.0, 1.3, 3.0, 3.5, 7.0)
"""Spread of acceleration between presses at one displacement and requested speed; on the twin, simulated."""
PACE_ratio = 0.03
"""Spread of speed that remains where the controller compensates drag."""


def tuning_of(rig: RigModel, travel_mm: float, bandwidth_Hz: float, friction_mm_s: float) -> Tuning:
    """Return the feed-forward of a rig: look-ahead, drag and friction, at the gain of mid travel."""
    middle = np.array([0.5 * travel_mm])
    gain = float(rig.gain_at(middle)[0])
    brake_lead_s = rig.position_lag_s + rig.delay_s - rig.electric_lag_s
    drag_N_s_m = max(0.0, float(rig.drag_at(middle)[0])) / gain
    friction_cN = max(0.0, rig.friction_cN) / gain
    leads_s = brake_lead_s + rig.electric_lag_s, brake_lead_s
    return Tuning(bandwidth_Hz, *leads_s, drag_N_s_m, friction_cN, friction_mm_s, paced=True)


def feedforward_cN(tuning: Tuning, velocity_mm_s: FloatArray) -> FloatArray:
    """Return the force that the controller subtracts from its table at a speed, positive downward."""
    rub = tuning.friction_cN * np.clip(velocity_mm_s / tuning.friction_mm_s, -1.0, 1.0)
    return np.asarray(DRAG_cN * tuning.drag_N_s_m * velocity_mm_s + rub)


def command_cN(
    rig: RigModel, grid_mm: FloatArray, target_cN: FloatArray, direction: float = 0.0
) -> FloatArray:
    """Return the table that renders the target on a rig at rest, the shape of target_cN.

    direction : 1 for the press, -1 for the release: the side load of the target rubs against it.
    """
    borne = target_cN * (1.0 - rig.side_ratio * direction)
    return np.asarray((borne - rig.own_at(grid_mm)) / rig.gain_at(grid_mm))


def table_change(
    rig: RigModel,
    tuning: Tuning,
    stroke: StrokeSample,
    change: tuple[FloatArray, FloatArray, FloatArray],
    target: tuple[FloatArray, FloatArray],
) -> tuple[FloatArray, FloatArray]:
    """Return displacement (mm) and the change (cN) of command_cN() needed there, (n,) each.

    change : of displacement, speed and acceleration under the target force (predict_change).
    target : grid and force.

    The rig's own force is taken as measured, plus what the change adds to it; the force left to the coil is
    divided by its gain, without the feed-forward. The coil's lag delays its braking and the feed-forward
    against it alike.
    """
    q, dv, da = change
    x = stroke.displacement_mm + q
    direction = float(np.sign(np.mean(stroke.velocity_mm_s)))
    late_v = stroke.velocity_mm_s + dv - 1000.0 * rig.electric_lag_s * (stroke.acceleration_m_s2 + da)
    gain = rig.gain_at(x)
    viscous = DRAG_cN * (rig.drag_N_s_m - rig.back_emf_N_s_m)
    moved = rig.own_at(x) - rig.own_at(stroke.displacement_mm)
    own = stroke.own_cN + moved + viscous * dv + cN_PER_g_m_s2 * rig.mass_g * da
    braking = DRAG_cN * rig.back_emf_N_s_m * gain**2 * late_v
    wanted = np.interp(x, *target)
    table = (wanted - own - braking) / gain + feedforward_cN(tuning, late_v)
    return x, table - command_cN(rig, x, wanted, direction)


def unrepeatable_cN(rig: RigModel, speed_mm_s: float) -> float:
    """Return the rms difference between the tables that two presses at one requested speed need."""
    inertia = cN_PER_g_m_s2 * rig.mass_g * float(np.interp(speed_mm_s, SPREAD_mm_s, SPREAD_m_s2))
    drag = DRAG_cN * rig.drag_N_s_m * PACE_ratio * speed_mm_s
    return float(np.sqrt(rig.residual_cN**2 + inertia**2 + drag**2 + 1.0))


def inertia_cN(rig: RigModel, speeds_mm_s: FloatArray) -> FloatArray:
    """Return the typical inertial force at these speeds, (s,)."""
    return np.asarray(cN_PER_g_m_s2 * rig.mass_g * TYPICAL_m_s2 * (speeds_mm_s / TYPICAL_mm_s) ** 2)


Pair = tuple[SharedTable, SharedTable]
"""Press and release."""


@dataclass(frozen=True)
class Learning:
    """Settings of learning.

    Attributes
    ----------
    common_cN : prior spread common to all speeds: calibration, weight, friction.
    alone_ratio : prior spread of one speed alone, as a part of the inertia expected there.
    fading : weight left to older presses, which were made on other tables.
    smoothing_mm, smoothing_s : sigma of a correction's smoothing, a length and, times speed, a time: what is
        shorter than the sensors resolve is not learned.
    trust : part of the predicted change of motion that is used, since the finger is nominal.
    finger : nominal finger of that prediction.
    """

    common_cN: float = 4.0
    alone_ratio: float = 0.3
    fading: float = 0.7
    smoothing_mm: float = 0.06
    smoothing_s: float = 8e-4
    trust: float = 0.6
    finger: FingerJoint = field(default_factory=FingerJoint)

    def __post_init__(self) -> None:
        parts = (self.fading, self.trust, self.alone_ratio)
        if not (all(0 <= part <= 1 for part in parts) and self.fading > 0 and self.common_cN > 0):
            raise ModelError(f"ratios must be in 0..1, fading and common_cN above 0, got {self}")
        if not (self.smoothing_mm >= 0 and self.smoothing_s >= 0):
            raise ModelError(f"smoothing must be at least 0, got {self}")


@dataclass(frozen=True, eq=False)
class PressError:
    """Error of one stroke: error_k (eq. 3), mean and largest over the judged bins, and the row pressed."""

    error_cN: float
    mean_cN: float
    max_cN: float
    row_cN: FloatArray


def prior_table(job: CompensationJob, rig: RigModel, how: Learning) -> SharedTable:
    """Return the table of an identified rig before anything is learned."""
    speeds = job.target.velocity_mm_s
    inertia = inertia_cN(rig, speeds)
    alone = 1.0 + how.alone_ratio * inertia
    return SharedTable.prior(job.target.displacement_mm, speeds, how.common_cN, inertia, alone)


def press_error(
    stroke: StrokeSample, target_cN: FloatArray, table: SharedTable, at: int, travel_mm: float
) -> PressError:
    """Compare one stroke with its target. Raises ModelError if no bin was visited."""
    grid = table.grid_mm
    judged = (grid >= FROM_mm) & (grid <= travel_mm - STOP_GUARD_mm)
    rendered = bin_force(stroke.displacement_mm, stroke.rendered_cN, grid)[judged]
    whole = error_cN(target_cN[judged], rendered)
    off = np.abs(rendered - target_cN[judged])
    return PressError(whole, float(np.nanmean(off)), float(np.nanmax(off)), table.rows_cN[at])


def learn_stroke(
    table: SharedTable,
    stroke: StrokeSample,
    target_cN: FloatArray,
    at: int,
    rig_and_tuning: tuple[RigModel, Tuning],
    how: Learning,
) -> SharedTable:
    """Return a table after one stroke for its row ``at``. Raises ModelError if no bin was visited."""
    rig, tuning = rig_and_tuning
    grid, speed = table.grid_mm, float(table.speeds_mm_s[at])
    q, dv, da = (how.trust * part for part in predict_change(stroke, target_cN, grid, how.finger))
    places, more = table_change(rig, tuning, stroke, (q, dv, da), (grid, target_cN))
    sigma_mm = how.smoothing_mm + how.smoothing_s * speed
    seen = bin_force(places, more, grid)
    return table.update(seen, speed, unrepeatable_cN(rig, speed), sigma_mm, how.fading)


LIFTED_cN = 1.0
"""What the coil lifts a free cap with, at least, beyond its weight and friction at rest."""


def least_command_cN(rig: RigModel, grid_mm: FloatArray, limit_cN: float) -> FloatArray:
    """Return the least command that lifts a free cap off where it rests, (n,).

    gain command + own(x) > friction at rest. Raises ModelError where the rig cannot, within its limit.
    """
    rub = max(0.0, float(rig.rub_at(np.array(0.0))))
    least = (rub + LIFTED_cN - rig.own_at(grid_mm)) / rig.gain_at(grid_mm)
    if least.max() > limit_cN:
        at = int(least.argmax())
        raise ModelError(
            f"the cap would hang at {grid_mm[at]:.2f} mm: to lift it takes a command of "
            f"{force_text(least[at], '.0f')}, "
            f"the limit is {limit_cN:.0f}; take weight or friction off the rig, or support its spring"
        )
    return np.asarray(least)


OPEN_LOOP_s = 0.04
"""A person cannot stop a stroke that takes less: reaction to touch takes 30 to 50 ms."""


def stops_within(velocity_mm_s: FloatArray, travel_mm: float) -> npt.NDArray[np.bool_]:
    """Return at which speeds a finger can stop, and leave the cap, on the way down."""
    return np.asarray(travel_mm >= OPEN_LOOP_s * velocity_mm_s)


def hanging_mm(rig: RigModel, surface: ForceSurface, travel_mm: float) -> FloatArray:
    """Return the displacements, rising, at which a surface lets a free cap hang.

    It hangs where the coil cannot lift it back against weight, the rig's own force and friction at rest: by
    any curve of the release, or of a press slow enough to be left on the way. What a fast press takes off its
    table for inertia makes no cap hang: after the turn at the stop the release's curve lifts it.
    """
    grid = surface.displacement_mm
    lifting = least_command_cN(rig, grid, float("inf")) - LIFTED_cN / rig.gain_at(grid)
    slow = surface.press_cN[stops_within(surface.velocity_mm_s, travel_mm)]
    return np.asarray(grid[np.vstack([surface.release_cN, slow]).min(axis=0) <= lifting])


def command_surface(job: CompensationJob, rig: RigModel, tables: Pair, friction_mm_s: float) -> ForceSurface:
    """Return the commands: model of the rig plus learned correction, with a lift that holds the cap at rest.

    Where a learned command would let the cap hang, the least one that lifts it is used (hanging_mm()).
    Raises ModelError if that exceeds the force limit.

    friction_mm_s : speed above which the controller compensates friction in full; tables of slower strokes
        contain the rest.
    """
    target, limit = job.target, job.force_limit_cN
    grid = target.displacement_mm
    gain = rig.gain_at(grid)
    lift = (job.at_most_cN(LIFT_cN) - rig.own_at(grid)) / gain
    least = least_command_cN(rig, grid, limit)
    slow = np.clip(1.0 - target.velocity_mm_s / friction_mm_s, 0.0, 1.0)[:, np.newaxis]
    rub = slow * rig.friction_cN / gain

    def rows(force_cN: FloatArray, learned_cN: FloatArray, down: float) -> FloatArray:
        command = command_cN(rig, grid, force_cN, down) - down * rub + learned_cN
        command = np.where(grid <= HOME_mm, np.maximum(command, lift), command)
        brings_back = (down < 0) | stops_within(target.velocity_mm_s, job.travel_mm)
        command = np.where(brings_back[:, np.newaxis], np.maximum(command, least), command)
        return np.clip(command, -limit, limit)

    press = rows(target.press_cN, tables[0].rows_cN, 1.0)
    release = rows(target.release_cN, tables[1].rows_cN, -1.0)
    return ForceSurface(grid, target.velocity_mm_s, press, release)


WORSE_ratio = 1.5
"""A last press this much worse than the best one of its speed means that learning diverged there; the spread
between a person's presses alone seldom does that."""
PressErrors = tuple[tuple[tuple[PressError, PressError], ...], ...]
"""Per speed, for each press on an identified rig: press and release."""


def minimum_lift_surface(job: CompensationJob) -> ForceSurface:
    """Return the target with a minimum command that holds up a cap of unknown weight, as PaperLaw starts."""
    target, limit = job.target, job.force_limit_cN
    press, release = (
        np.clip(np.maximum(rows, job.at_most_cN(PaperLaw.hold_cN)), -limit, limit)
        for rows in (target.press_cN, target.release_cN)
    )
    return ForceSurface(target.displacement_mm, target.velocity_mm_s, press, release)


def best_rows(tables: Pair, errors: PressErrors) -> Pair:
    """Return the tables, with the row of the best press where the last press was far worse."""
    made = []
    for j, table in enumerate(tables):
        rows = table.rows_cN.copy()
        for at, presses in enumerate(errors):
            if better := better_press([pair[j] for pair in presses]):
                rows[at] = better.row_cN
        made.append(replace(table, rows_cN=rows))
    press, release = made
    return press, release


def better_press(errors: list[PressError]) -> PressError | None:
    """Return the best press of a speed if the last one was far worse; else None."""
    best = min(errors, key=lambda e: e.error_cN, default=None)
    return best if best is not None and errors[-1].error_cN > WORSE_ratio * best.error_cN else None


def curves_of(
    job: CompensationJob, errors: PressErrors, learned: LearnedRig | None
) -> tuple[CurveOutcome, ...]:
    """Return the outcome of every curve, presses first; the expected errors where nothing was pressed."""
    speeds = job.target.velocity_mm_s
    expected = np.full((2, speeds.size), np.nan) if learned is None else learned.error_at_cN(speeds)
    return tuple(
        _curve(stroke, float(speed), [pair[j] for pair in errors[i]], float(expected[j, i]))
        for j, stroke in enumerate(Stroke)
        for i, speed in enumerate(speeds)
    )


def _curve(stroke: Stroke, speed_mm_s: float, errors: list[PressError], expected_cN: float) -> CurveOutcome:
    if not errors:
        left = (
            f"{force_text(expected_cN, '.1f')} expected: the error left on the button that the rig was "
            "identified on"
        )
        sentence = left if np.isfinite(expected_cN) else "not pressed"
        return CurveOutcome(stroke, speed_mm_s, (), expected_cN, float("nan"), sentence)
    better = better_press(errors)
    used = better or errors[-1]
    first_cN, last_cN = errors[0].error_cN, errors[-1].error_cN
    sentence = (
        f"error_k {force_text(first_cN, '.1f')} at press 1, {force_number(last_cN, '.1f')} at press "
        f"{len(errors)}"
    )
    sentence += "; the best table is kept, since the last press was worse" if better else ""
    history = tuple(e.error_cN for e in errors)
    return CurveOutcome(stroke, speed_mm_s, history, used.mean_cN, used.max_cN, sentence)


def press_summary(
    rig: RigModel, tables: tuple[Pair, Pair], errors: tuple[PressError, PressError], at: int
) -> str:
    """Describe a press of speed number ``at``: its errors, and its change of the tables (before, after)."""
    (down, up), speed = errors, float(tables[0][0].speeds_mm_s[at])
    moved = [float(np.abs(new.rows_cN[at] - old.rows_cN[at]).max()) for old, new in zip(*tables, strict=True)]
    return (
        f"mean error {force_text(down.mean_cN, '.1f')} on the press, {force_number(up.mean_cN, '.1f')} on "
        "the release; tables moved by up "
        f"to {force_number(moved[0], '.1f')} and {force_text(moved[1], '.1f')}; two such presses differ by "
        "about "
        f"{force_text(unrepeatable_cN(rig, speed), '.1f')}"
    )
