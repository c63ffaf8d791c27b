"""Is the closed loop silent under any finger? Presses drawn at random, held on the way, then let go.

Simulated. Run as ``python -m benchmarks.force_loop_silence [presses]``. Rigs, buttons and cells are those of
`benchmarks.force_loop`; every rig is identified, and its loop closed with gains chosen for it. Fingers are
drawn from 100 to 5000 N/m, most people's and beyond; each presses at up to 200 mm/s to a place on the way,
holds the cap there, and leaves it. A press that swings is repeated on an ideal button, which tells the
target's doing from the rig's. Ten thousand presses take half an hour on two cores.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from benchmarks.drawn_rigs import BUTTONS, FIRST_SEED, Case, run_all
from benchmarks.force_loop import DESIGNS, RECOMMENDED, parts
from benchmarks.ideal_button import IdealPress, Reversal, press_ideal
from fdvv.compensation.force_loop.method import lift_target_cN
from fdvv.compensation.rig_aware import RigAware
from fdvv.device.twin import TwinDevice
from fdvv.model.model import FDVVModel
from fdvv.model.surface import ForceSurface
from fdvv.protocol.tables import Mode
from fdvv.rendering.compensate import compensate
from fdvv.twin.draw import draw_finger
from fdvv.twin.finger import Finger, bare
from fdvv.twin.gesture import Gesture, depth_m, plan
from fdvv.twin.image import image_of
from fdvv.twin.noise import Noise, draw_noise
from fdvv.twin.rig import Rig
from fdvv.twin.rig_kernel import LoopConstants
from fdvv.twin.simulate import simulate_program
from fdvv.units import FloatArray

PRESSES, RIGS = 10_000, 10
HOLD_s, LEAVE_s, FREE_s = 0.25, 0.05, 0.2
SETTLE_s = 0.1
HIGHPASS_s = 0.012
STOP_mm = 0.06
"""So near a stop the loop is not closed."""
CYCLE_cN, CYCLE_mm_s = 3.0, 5.0
"""A held cap with more ripple than this, or a free one that moves faster (rms), swings by itself."""
LOW_N_m, HIGH_N_m, HAND_N_m = 100.0, 5000.0, 1255.0
PLACE_ratios = (0.1, 0.9)
SPEEDS_mm_s = (50.0, 100.0, 200.0)


@dataclass(frozen=True, eq=False)
class ClosedRig:
    """A rig with its loop closed, and the table on it."""

    rig: Rig
    surface: ForceSurface
    travel_mm: float
    constants: LoopConstants


@dataclass(frozen=True, eq=False)
class HeldPress:
    """A finger that presses to a place on the way, holds the cap there, and leaves."""

    finger: Finger
    gesture: Gesture
    speed_mm_s: float
    noise: Noise


def closed(case: Case) -> ClosedRig:
    (rig, finger), model = parts(case, True), case.model
    learned = compensate(TwinDevice(rig, finger, case.seed), model, SPEEDS_mm_s, RigAware(rounds=1))
    loop = learned.outcome.tuning.loop
    assert loop is not None
    return ClosedRig(rig, learned.surface, model.travel_mm, loop.pack())


def any_finger(random: np.random.Generator) -> Finger:
    """Draw a person, with a joint from much softer to much stiffer than people's; stiff ones carry a hand."""
    drawn = bare(draw_finger(random))
    stiffness = float(np.exp(random.uniform(np.log(LOW_N_m), np.log(HIGH_N_m))))
    hand = stiffness > HAND_N_m
    mass_kg = random.uniform(0.0087, 0.05) if hand else drawn.impedance.mass_kg
    damping = random.uniform(4.0, 30.0) if hand else drawn.impedance.damping_N_s_m
    return replace(
        drawn,
        impedance=replace(drawn.impedance, stiffness_N_m=stiffness, mass_kg=mass_kg, damping_N_s_m=damping),
    )


def drawn(on: ClosedRig, random: np.random.Generator) -> HeldPress:
    """Draw a finger, a speed, and a place on the way at which it holds the cap."""
    finger, speed = any_finger(random), float(random.choice(SPEEDS_mm_s))
    place_mm = on.travel_mm * random.uniform(*PLACE_ratios)
    row = on.surface.press_cN[int(np.argmin(np.abs(on.surface.velocity_mm_s - speed)))]
    force_N = 0.01 * max(0.0, float(np.interp(place_mm, on.surface.displacement_mm, row)))
    joint = finger.impedance
    start_m = plan(finger, 1e-3 * on.travel_mm, 0.1).start_m
    end_m = max(start_m + 1e-4, 1e-3 * place_mm + depth_m(finger, force_N, joint.stiffness_N_m))
    press_s = place_mm / speed
    gesture = Gesture(
        start_m, end_m, 0.01, press_s, HOLD_s, LEAVE_s, joint.stiffness_N_m, joint.damping_N_s_m, FREE_s
    )
    return HeldPress(finger, gesture, speed, draw_noise(on.rig, finger, gesture, random))


def hold(on: ClosedRig, press: HeldPress) -> tuple[float, float, bool, bool]:
    """Return the ripple of a held cap, cN rms, the speed of the one left, mm/s rms, if it faulted, and if it
    lay on a stop, where no loop is closed and a trembling hand is felt as it is."""
    image = image_of(on.surface, on.travel_mm, paced=True).image
    trace = simulate_program(
        on.rig, press.finger, press.gesture, image, press.noise, press.speed_mm_s, loop=on.constants
    )
    felt = _felt(press.gesture, trace.t_s, trace.force_cN, trace.cap_velocity_mm_s)
    held_mm = float(np.median(trace.displacement_mm[_held(press.gesture, trace.t_s)]))
    on_stop = not STOP_mm < held_mm < on.travel_mm - STOP_mm
    return *felt, bool((trace.mode == Mode.FAULT).any()), on_stop


def _felt(
    gesture: Gesture, t: FloatArray, force_cN: FloatArray, velocity_mm_s: FloatArray
) -> tuple[float, float]:
    held = _held(gesture, t)
    free = (t > gesture.duration_s - SETTLE_s) & (t < gesture.duration_s)
    ripple = float(np.std(_high_passed(t, force_cN)[held]))
    return ripple, float(np.std(velocity_mm_s[free]))


def _held(gesture: Gesture, t: FloatArray) -> npt.NDArray[np.bool_]:
    until = gesture.onset_s + gesture.press_s + HOLD_s
    return np.asarray((t > until - HOLD_s + SETTLE_s) & (t < until - HIGHPASS_s))


def swings(ripple_cN: FloatArray, speed_mm_s: FloatArray) -> npt.NDArray[np.bool_]:
    return np.asarray((ripple_cN > CYCLE_cN) | (speed_mm_s > CYCLE_mm_s))


def hold_ideal(model: FDVVModel, presses: Sequence[HeldPress], reversal: Reversal) -> npt.NDArray[np.bool_]:
    """Return which of these presses swing where the target is rendered exactly, without any delay."""
    target = ForceSurface.of_model(model, SPEEDS_mm_s)
    rows = (lift_target_cN(target.displacement_mm, row) for row in (target.press_cN, target.release_cN))
    exact = ForceSurface(target.displacement_mm, target.velocity_mm_s, *rows)
    asked = [
        IdealPress(p.finger, p.gesture, SPEEDS_mm_s.index(p.speed_mm_s), p.noise.effort_ratio)
        for p in presses
    ]
    t, force, speed = press_ideal(exact, model.travel_mm, asked, reversal)
    felt = [_felt(p.gesture, t, force[:, i], speed[:, i]) for i, p in enumerate(presses)]
    return swings(*np.array(felt).T)


def _high_passed(t_s: FloatArray, force_cN: FloatArray) -> FloatArray:
    width = round(HIGHPASS_s / (t_s[1] - t_s[0]))
    return np.asarray(force_cN - np.convolve(force_cN, np.ones(width) / width, mode="same"))


@dataclass(frozen=True)
class _Held:
    presses: int

    def __call__(self, case: Case) -> FloatArray:
        on, random = closed(case), np.random.default_rng(20_000 + case.seed)
        presses = [drawn(on, random) for _ in range(self.presses)]
        # the last column: on an ideal button too
        found = np.array([(*hold(on, press), False) for press in presses], dtype=float)
        swinging = np.flatnonzero(swings(found[:, 0], found[:, 1]))
        if swinging.size:
            found[swinging, 4] = hold_ideal(case.model, [presses[i] for i in swinging], Reversal())
        return found


def main() -> None:
    presses = int(sys.argv[1]) if len(sys.argv) > 1 else PRESSES
    cases = [Case(FIRST_SEED + i, button, DESIGNS[RECOMMENDED]) for i in range(RIGS) for button in BUTTONS]
    found = list(run_all(_Held(-(-presses // len(cases))), cases))
    rows = np.vstack([rows for _, rows in found if not isinstance(rows, str)])
    ripple, speed, faults, on_stop, ideal = rows.T
    print(f"{len(rows)} presses on {len(cases)} rigs; simulated")
    for name, values, unit in (("held: ripple", ripple, "cN"), ("left: cap's speed", speed, "mm/s")):
        middle, high, most = np.quantile(values, [0.5, 0.99, 1.0])
        print(f"{name}, rms: median {middle:.2f}, 99 % {high:.2f}, largest {most:.2f} {unit}")
    for name, held in (("on the way", ripple[on_stop == 0]), ("on a stop", ripple[on_stop == 1])):
        above, most = int((held > 1.0).sum()), held.max(initial=0.0)
        print(f"held {name}: {held.size}, {above} above 1 cN, largest {most:.2f} cN")
    swinging = int(swings(ripple, speed).sum())
    print(f"swinging by themselves: {swinging}, of them on an ideal button too: {int(ideal.sum())}")
    print(f"faults: {int(faults.sum())}")
    for reason in sorted({rows for _, rows in found if isinstance(rows, str)}):
        print(f"not finished: {reason[:100]}")


if __name__ == "__main__":
    main()
