"""The finger that presses: impedance, pad, variability from press to press; and a probing stage."""

from __future__ import annotations

from dataclasses import dataclass, field, fields, replace

from fdvv.errors import ModelError
from fdvv.twin.quantity import Section, quantity, setting

H_H = "Hajian & Howe 1997, recalled"
P_H = "Pawluk & Howe 1999, values assumed"
CLEARANCE_m = 2e-4
"""The stage begins this far above the cap, so that its gauge is seen to be free."""
DWELL_s = 0.05  # as PressVariability.dwell_s, assumed there


@dataclass(frozen=True)
class Impedance(Section):
    """The finger about its joint, as a mass on a spring and a damper pulled by a moving referent.

    Ranges after Hajian and Howe (1997) as recalled; one mass is known to be too little from 50 to 500 Hz.
    """

    mass_kg: float = quantity(0.007, "effective mass at the tip", "kg", (0.0035, 0.0087), (5e-4, 0.2), H_H)
    stiffness_N_m: float = quantity(450.0, "stiffness", "N/m", (255.0, 1255.0), (0.0, 5000.0), H_H)
    damping_N_s_m: float = quantity(4.5, "damping", "N s/m", (4.0, 7.4), (0.0, 100.0), H_H)


@dataclass(frozen=True)
class FingerPad(Section):
    """The pulp of the fingertip: F = scale (exp(exponent depth) - 1), part of it relaxing in two arms.

    Exponential with relaxation after Pawluk and Howe; the split between the arms is assumed.
    """

    scale_N: float = quantity(0.12, "force scale a", "N", (0.08, 0.15), (0.001, 5.0), P_H)
    exponent_1_m: float = quantity(3000.0, "exponent beta", "1/m", (2000.0, 4000.0), (10.0, 2e4), P_H)
    relaxed_ratio: float = quantity(0.3, "part that stays when relaxed", "", (0.2, 0.4), (0.01, 1.0))
    fast_share: float = quantity(0.5, "share of the fast arm in what relaxes", "", (0.3, 0.7), (0.0, 1.0))
    fast_s: float = quantity(0.004, "time constant of the fast arm", "s", (0.003, 0.005), (1e-4, 1.0))
    slow_s: float = quantity(0.1, "time constant of the slow arm", "s", (0.08, 0.15), (1e-3, 10.0))
    strap_N: float = quantity(
        0.2, "squeeze by the strap of the force sensor, nulled in its reading", "N", (0.1, 0.4), (0.0, 5.0)
    )


@dataclass(frozen=True)
class PressVariability(Section):
    """How a person presses, and how much each press differs; a spread is one standard deviation."""

    lift_m: float = setting(
        0.0, "height of the referent above the cap before a press, 0: resting", "m", (0.0, 0.008), (0.0, 0.03)
    )
    rest_N: float = quantity(
        0.1, "force of a finger that rests on the cap (lift 0)", "N", (0.05, 0.3), (0.0, 1.0)
    )
    push_N: float = quantity(
        1.5, "force at which the referent aims beyond the bottom", "N", (0.8, 2.0), (0.0, 20.0)
    )
    onset_s: float = quantity(0.01, "wait before the finger moves", "s", (0.0, 0.02), (0.0, 1.0))
    dwell_s: float = quantity(0.05, "rest at the bottom", "s", (0.03, 0.08), (0.0, 2.0))
    pace_spread_ratio: float = quantity(0.1, "spread of the pace", "", (0.08, 0.15), (0.0, 0.5))
    pace_undershoot_ratio: float = quantity(
        0.05, "how much too slow at 200 mm/s, in proportion to speed", "", (0.0, 0.15), (-0.5, 0.5)
    )
    push_spread_ratio: float = quantity(0.15, "spread of push_N", "", (0.1, 0.2), (0.0, 0.5))
    impedance_spread_ratio: float = quantity(
        0.15, "spread of stiffness and of damping", "", (0.1, 0.2), (0.0, 0.5)
    )
    lift_spread_ratio: float = quantity(0.2, "spread of lift_m, or of rest_N", "", (0.1, 0.3), (0.0, 0.5))
    onset_spread_s: float = quantity(0.003, "spread of onset_s", "s", (0.001, 0.02), (0.0, 0.5))
    effort_noise_ratio: float = quantity(
        0.03, "noise of the muscle in proportion to its force", "", (0.02, 0.05), (0.0, 0.5)
    )
    effort_noise_Hz: float = quantity(12.0, "bandwidth of that noise", "Hz", (8.0, 12.0), (0.1, 500.0))
    tremor_ratio: float = quantity(
        0.005, "amplitude of the tremor in proportion to force", "", (0.0, 0.02), (0.0, 0.5)
    )
    tremor_Hz: float = quantity(10.0, "frequency of the tremor", "Hz", (8.0, 12.0), (0.1, 100.0))

    def still(self) -> PressVariability:
        """Return the same person without any variation."""
        spreads = [f.name for f in fields(self) if "spread" in f.name or "undershoot" in f.name]
        noises = ["effort_noise_ratio", "tremor_ratio"]
        return replace(self, **dict.fromkeys([*spreads, *noises], 0.0))


@dataclass(frozen=True)
class Finger:
    """Everything about the person who presses."""

    impedance: Impedance = field(default_factory=Impedance)
    pulp: FingerPad = field(default_factory=FingerPad)
    habit: PressVariability = field(default_factory=PressVariability)

    def __post_init__(self) -> None:
        if self.habit.push_N > 0 and self.impedance.stiffness_N_m == 0:
            raise ModelError("Finger: a finger that pushes (push_N > 0) needs a stiffness above 0, got 0 N/m")


def bare(finger: Finger) -> Finger:
    """Return the same finger without the strap of the worn sensor."""
    return replace(finger, pulp=replace(finger.pulp, strap_N=0.0))


def stage_finger(push_N: float = 2.0) -> Finger:
    """Make the finger that is no finger: a motorised stage which pushes a steel tip down and pulls it back.

    push_N : force at which it turns, beyond the bottom stop; it must exceed the button's force there.

    For static figures, at 0.5 mm/s as the paper's probing machine: ``TwinDevice(rig, stage_finger())`` and
    ``workflow.probe(device, model, surface, [0.5])``. Drive and frame are as stiff as the equations bear
    (5 N/mm), the tip yields 10 um to 1 N and does not relax, nothing varies from press to press and no muscle
    trembles; noise of the rig's own sensors stays. Its referent moves as every gesture does, on minimum
    jerk, so at 0.5 mm/s on average the cap moves at up to 0.8 mm/s: still too slow for drag, inertia and lag
    to count.
    """
    return Finger(
        Impedance(mass_kg=0.2, stiffness_N_m=5000.0, damping_N_s_m=100.0),
        FingerPad(scale_N=5.0, exponent_1_m=2e4, relaxed_ratio=1.0, strap_N=0.0),
        replace(PressVariability().still(), lift_m=CLEARANCE_m, push_N=push_N, onset_s=0.0, dwell_s=DWELL_s),
    )
