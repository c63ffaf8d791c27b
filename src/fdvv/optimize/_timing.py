"""When a simulated person moves: the click-timing model, and how it changes with practice and fatigue."""

from __future__ import annotations

import math

from fdvv.optimize._user import SimulatedUser


def timing_spread_s(user: SimulatedUser, cue_s: float, period_s: float) -> float:
    """Give the standard deviation of a click on a target that is seen for cue_s and comes every period_s.

    The clock of the rhythm alone has a spread in proportion to the period; what is seen has one that falls
    with the time it is seen; both are weighed by their precision (Lee et al. 2018, constants as published
    with Park and Lee 2020).
    """
    clock = math.expm1(min(700.0, user.cue_1_s * cue_s))
    seen_s = (1.0 / clock if clock > 0 else math.inf) + user.cue_delay_s
    return user.clock_ratio * period_s / math.sqrt(1.0 + (period_s / seen_s) ** 2)


def aim_s(user: SimulatedUser, zone_s: float) -> float:
    """Give where a person aims from the centre of a zone that lasts zone_s: at a share of it (ibid.)."""
    return (user.aim_ratio - 0.5) * zone_s


def spread_factor(user: SimulatedUser, presses_before: int) -> float:
    """Give by what timing scatters more after so many presses: unpractised at first, tired later."""
    unpractised = user.learning_ratio * math.exp(-presses_before / user.learning_presses)
    return 1.0 + unpractised + tiredness(user, presses_before)


def tiredness(user: SimulatedUser, presses_before: int) -> float:
    """Give the share that fatigue has added to spread, and taken from force and pace, growing evenly."""
    return user.fatigue_ratio * presses_before / 1000.0
