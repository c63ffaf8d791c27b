"""A designed mechanism as a real button of the twin, and what pressing it gives. Simulated."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

import numpy as np

from fdvv.model.curve import Stroke
from fdvv.model.model import FDVVModel
from fdvv.twin.button import BuiltCam, ButtonPhysics, Curve, Dome, Leaf, Slider
from fdvv.twin.finger import Finger
from fdvv.twin.gesture import plan
from fdvv.twin.pace import solve_button_pace
from fdvv.twin.simulate_button import no_button_noise, probe_button, simulate_button
from fdvv.units import FloatArray, N_from_cN, m_from_mm
from fdvv_switch.dome import DomeMechanism
from fdvv_switch.leaf import LeafMechanism
from fdvv_switch.mechanism import Mechanism
from fdvv_switch.residual import Miss, miss_of
from fdvv_switch.target import STOP_mm, Target

STEP_mm = 0.02
SLOW_mm_s = 0.5
SPEEDS_mm_s = (50.0, 100.0, 200.0)
STIFFNESS_N_m = 10.0
"""Of one cN/mm."""
STRAIGHT = Dome(law="linear", linear_s_m=0.0, arm_m=1e-5, arm_s=1e4)
"""A coil in the twin: its dome without rubber, so no growth with speed and friction that stays."""
START_mm = 0.1


@dataclass(frozen=True, eq=False)
class PressedDesign:
    """One speed at which the twin pressed a design; simulated.

    Attributes
    ----------
    speed_mm_s : mean speed of the stroke down; 0.5 is a slow force tester, the others a finger.
    press, release : against the model's own curves at that speed where it knows speeds, else its slow ones.
    own_speed : whether it is the former.
    displacement_mm, press_cN, release_cN : what the twin gave, (n,) each.
    """

    speed_mm_s: float
    press: Miss
    release: Miss
    own_speed: bool
    displacement_mm: FloatArray
    press_cN: FloatArray
    release_cN: FloatArray

    def to_dict(self) -> dict[str, object]:
        """Return the figures for JSON."""
        head = {"speed_mm_s": self.speed_mm_s, "own_speed": self.own_speed, "simulated": True}
        return {**head, "press": asdict(self.press), "release": asdict(self.release)}


def mechanism_button(mechanism: Mechanism, target: Target, source: str, licence: str) -> ButtonPhysics:
    """Return a design to the twin: its slow curves, and its leaf or rubber.

    A leaf is given as it is built, coil, cam, strip and friction, so the twin's own equations (contact of
    leaf and cam, friction with its turning, moving masses) make the force; the design's curves only stand
    beside it. A coil or a dome is given by its curves. Raises ModelError if the twin cannot take it.
    """
    count = int(np.floor(target.travel_mm / STEP_mm + 1e-9)) + 1
    x: FloatArray = np.asarray(STEP_mm * np.arange(count), dtype=np.float64)
    press, release = mechanism.strokes_cN(x)
    kind = "leaf" if isinstance(mechanism, LeafMechanism) else "dome"
    close = _closing_mm(mechanism, target)
    curve = Curve(
        kind=kind,
        step_m=_metres(STEP_mm),
        travel_m=_metres(target.travel_mm),
        close_m=_metres(close),
        open_m=_metres(close),
        seat_m=_metres(min(max(3.0 * mechanism.guide.seat_mm, 0.05), 0.3)),
    )
    return ButtonPhysics(
        f"{target.name}-{mechanism.kind}",
        f"designed to give {target.name}: {source}",
        licence,
        N_from_cN(press),
        N_from_cN(np.maximum(release, 0.0)),
        curve,
        leaf=_leaf(mechanism),
        dome=Dome() if isinstance(mechanism, DomeMechanism) else STRAIGHT,
        slider=Slider(),
        cam=_built(mechanism, x),
    )


def _built(mechanism: Mechanism, x: FloatArray) -> BuiltCam | None:
    if not isinstance(mechanism, LeafMechanism):
        return None
    guide, coil = mechanism.guide, mechanism.coil
    spring = coil.preload_cN + coil.rate_cN_mm * x
    height = mechanism.cam.at(x)
    along = mechanism.leaf.force_cN(height) * mechanism.cam.at(x, 1)
    resting = np.exp(-x / guide.seat_mm)
    moving = 1.0 - resting
    return BuiltCam(
        N_from_cN(spring - (spring[0] + along[0]) * resting),
        m_from_mm(height),
        N_from_cN((guide.drag_cN + guide.load_ratio * spring) * moving),
        mechanism.friction_ratio * moving,
        float(N_from_cN(mechanism.leaf.preload_cN)),
    )


def _closing_mm(mechanism: Mechanism, target: Target) -> float:
    if not isinstance(mechanism, LeafMechanism):
        return target.close_mm
    x = target.displacement_mm
    height = mechanism.cam.at(x)
    falls = np.flatnonzero((height[:-1] > 0.0) & (height[1:] <= 0.0))
    return float(x[falls[-1] + 1]) if falls.size else target.close_mm


def _leaf(mechanism: Mechanism) -> Leaf:
    if not isinstance(mechanism, LeafMechanism):
        return Leaf()
    leaf = mechanism.leaf
    return Leaf(
        mass_kg=max(round(1e-3 * leaf.tip_mass_g, 8), 1e-5),
        stiffness_N_m=round(STIFFNESS_N_m * leaf.stiffness_cN_mm, 3),
        fixed_stiffness_N_m=round(STIFFNESS_N_m * leaf.contact_cN_mm, 3),
    )


def _metres(length_mm: float) -> float:
    return round(m_from_mm(length_mm), 9)


def press_design(
    button: ButtonPhysics, model: FDVVModel, speeds_mm_s: Sequence[float] = SPEEDS_mm_s
) -> tuple[PressedDesign, ...]:
    """Press a designed button slowly with a stiff tester, then with the default person at each speed.

    Nothing varies between presses. Force is the one between finger and cap, its inertia included.
    """
    slow = probe_button(button, SLOW_mm_s)
    stop = model.travel_mm - STOP_mm
    inside = slow.displacement_mm <= stop
    x, press, release = (v[inside] for v in (slow.displacement_mm, slow.press_cN, slow.release_cN))
    return (
        _compared(model, SLOW_mm_s, x, press, release, slow=True),
        *(_fast(button, model, speed, stop) for speed in speeds_mm_s),
    )


def _fast(button: ButtonPhysics, model: FDVVModel, speed_mm_s: float, stop_mm: float) -> PressedDesign:
    person = Finger()
    pace_s = solve_button_pace(button, person, speed_mm_s)
    gesture = plan(person, button.curve.travel_m, pace_s)
    trace = simulate_button(button, person, gesture, no_button_noise(gesture))
    at_mm, force = trace.displacement_mm, trace.force_cN
    bottom = int(at_mm.argmax())
    x = np.arange(START_mm, min(stop_mm, float(at_mm.max())), STEP_mm)
    press = _first_crossing(at_mm[: bottom + 1], force[: bottom + 1], x)
    release = _first_crossing(at_mm[bottom:][::-1], force[bottom:][::-1], x)
    return _compared(model, speed_mm_s, x, press, release, slow=False)


def _first_crossing(at_mm: FloatArray, force_cN: FloatArray, x: FloatArray) -> FloatArray:
    reached = np.maximum.accumulate(at_mm)
    fresh = np.append(True, np.diff(reached) > 0.0)
    return np.asarray(np.interp(x, reached[fresh], force_cN[fresh]))


def _compared(
    model: FDVVModel, speed_mm_s: float, x: FloatArray, press: FloatArray, release: FloatArray, slow: bool
) -> PressedDesign:
    own = bool(model.velocities_mm_s(Stroke.PRESS)) and len(model.of(Stroke.PRESS)) > 1 and not slow
    misses = []
    for stroke, got in ((Stroke.PRESS, press), (Stroke.RELEASE, release)):
        if own:
            wanted = model.force_cN(x, speed_mm_s, stroke)
        else:
            wanted = min(model.of(stroke), key=lambda c: c.velocity_mm_s or 0.0).force_cN(x)
        misses.append(miss_of(x, got, wanted))
    return PressedDesign(speed_mm_s, misses[0], misses[1], own, x, press, release)
