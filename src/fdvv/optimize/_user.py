"""A simulated person as numbers; docs/explanation/simulated-users.md tells where they come from."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from fdvv.errors import ModelError

AT_LEAST_0 = ("motor_ms", "percept_ms", "lift_mm", "rest_spread_cN", "learning_ratio", "fatigue_ratio")
FREE = ("bias_ms", "anticipated_ms", "rest_cN")
RATIOS = ("aim_ratio", "adaptation_ratio", "pace_spread_ratio", "push_spread_ratio", "stiffness_spread_ratio")


@dataclass(frozen=True)
class SimulatedUser:
    """A person who plays tasks on the twin.

    Attributes
    ----------
    number : of the person in a draw.
    clock_ratio, cue_1_s, cue_delay_s, aim_ratio : of the click-timing model: c_sigma, nu, delta, c_mu.
    motor_ms : spread of a movement's onset about its plan.
    bias_ms : how late keys are told and targets seen, for all buttons alike, which the person cannot notice.
    anticipated_ms : time from the onset of movement to its felt event that is allowed for on a new button.
    adaptation_ratio : share of the felt error that the next press makes up for.
    percept_ms : spread of the felt time of an event of salience 1.
    snap_cN, impact_mm_s, vibration_m_s2 : a fall of force, a speed at the stop, a vibration of salience 1.
    stiffness_N_m, damping_N_s_m, mass_kg : of the finger.
    push_cN : force beyond the bottom that is aimed at.
    rest_cN, rest_spread_cN : force of the resting finger, and how it differs from press to press.
    pace_mm_s : mean speed of the finger's referent.
    lift_mm : height above the cap before a press; 0: resting.
    pace_spread_ratio, push_spread_ratio, stiffness_spread_ratio : from press to press.
    learning_ratio, learning_presses : extra spread of timing at first, and presses in which it falls to 1/e.
    fatigue_ratio : of spread added, and of force and pace lost, per thousand presses.

    ModelError on anything impossible.
    """

    number: int = 0
    clock_ratio: float = 0.09015
    cue_1_s: float = 19.931
    cue_delay_s: float = 0.399
    aim_ratio: float = 0.185
    motor_ms: float = 10.0
    bias_ms: float = 93.0
    anticipated_ms: float = 0.0
    adaptation_ratio: float = 0.05
    percept_ms: float = 20.0
    snap_cN: float = 10.0
    impact_mm_s: float = 200.0
    vibration_m_s2: float = 5.0
    stiffness_N_m: float = 450.0
    damping_N_s_m: float = 4.5
    mass_kg: float = 0.007
    push_cN: float = 150.0
    rest_cN: float = 10.0
    rest_spread_cN: float = 5.0
    pace_mm_s: float = 100.0
    lift_mm: float = 0.0
    pace_spread_ratio: float = 0.1
    push_spread_ratio: float = 0.15
    stiffness_spread_ratio: float = 0.15
    learning_ratio: float = 0.0
    learning_presses: float = 60.0
    fatigue_ratio: float = 0.0

    def __post_init__(self) -> None:
        for one in fields(self):
            if one.name != "number":
                self._check(one.name, getattr(self, one.name))

    def _check(self, name: str, value: float) -> None:
        fine = math.isfinite(value)
        if name in RATIOS:
            fine = fine and 0 <= value <= 1
        elif name in AT_LEAST_0:
            fine = fine and value >= 0
        elif name not in FREE:
            fine = fine and value > 0
        if not fine:
            raise ModelError(f"a simulated person cannot have {name} = {value}")
