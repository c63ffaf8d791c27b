"""A linear stage with a force gauge in place of a finger: the press that static figures are made with."""

from __future__ import annotations

from dataclasses import replace

from fdvv.twin._finger import Finger, Habit, Impedance, Pulp

CLEARANCE_m = 2e-4
"""The stage begins this far above the cap, so that its gauge is seen to be free."""
DWELL_s = 0.05


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
        Pulp(scale_N=5.0, exponent_1_m=2e4, relaxed_ratio=1.0, strap_N=0.0),
        replace(Habit().still(), lift_m=CLEARANCE_m, push_N=push_N, onset_s=0.0, dwell_s=DWELL_s),
    )
