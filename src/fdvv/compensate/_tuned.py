"""The paper's law, tuned as hard as anything that is compared with it."""

from __future__ import annotations

from typing import Literal

from fdvv.compensate._gain import GainSchedule
from fdvv.compensate._observe import Delays
from fdvv.compensate._paper import RIG_DELAYS, PaperLaw

HOLDS_cN = (50.0, 65.0, 80.0)
"""To be tried one after the other: less renders better, more keeps heavier caps up, so that a job ends."""
FASTER_LOOP_s = 0.0005
"""Loops of a shorter period have the delays of the 4 kHz rig."""
FAST_DELAYS = Delays(position_s=0.0003, command_s=0.00125)


def tuned_paper_law(
    presses: Literal[20, 240] = 240,
    tick_s: float = 0.001,
    additions: bool = True,
    hold_cN: float = HOLDS_cN[0],
) -> PaperLaw:
    """Give the settings of the paper's law that did best on random rigs, for a budget of presses per button.

    presses : over four velocities together: 20 (one round of 5 each) or the paper's 240.
    tick_s : period of the loop.
    additions : with what ``PaperLaw`` adds to the law as printed; without: ``PaperLaw.literal``.
    hold_cN : with additions, the least command in the first 0.1 mm. Which of HOLDS_cN suits a rig depends
        on its mover's weight: the one whose curves end with the least error as the rig measures it.

    Tuned on the twin (simulated): rigs and fingers drawn with seeds 100 to 119, each with one of the six
    built-in buttons, at 50 to 200 mm/s, against fresh presses in true displacement, at 1 and 4 kHz.
    docs/explanation/paper-law.md tells what it gave. Many settings are alike within its noise.
    """
    if not additions:
        return _printed(presses)
    delays = RIG_DELAYS if tick_s > FASTER_LOOP_s else FAST_DELAYS
    if presses == 20:
        few = GainSchedule(most=0.8)
        return PaperLaw(
            gain=few, rounds=1, presses_per_round=5, smoothing_mm=0.0, delays=delays, hold_cN=hold_cN
        )
    return PaperLaw(rounds=4, presses_per_round=15, delays=delays, hold_cN=hold_cN)


def _printed(presses: int) -> PaperLaw:
    if presses == 20:
        return PaperLaw.literal(gain=GainSchedule(most=0.6), rounds=1, presses_per_round=5)
    return PaperLaw.literal(gain=GainSchedule(most=0.4), rounds=4, presses_per_round=15)
