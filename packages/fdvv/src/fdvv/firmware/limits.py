"""What a board is built for, and why it refuses settings."""

from __future__ import annotations

import math

from fdvv.protocol.tables import BoardLimits, Settings

CALIBRATION_RATIO = 1.25
"""Settings may ask so much more duty per force than the rig's own: coils and magnets differ, and age."""
SHORTEST_us, LONGEST_us = 250, 1000
"""Ticks that a board may be set to; a rig with a shorter or a longer one moves that limit."""


def limits_like(settings: Settings) -> BoardLimits:
    """Return the limits of a board that is built for these settings: none of them may become looser."""
    largest = BoardLimits.LIMITS["full_duty_rise_K"][1], BoardLimits.LIMITS["duty_gain_q16"][1]
    return BoardLimits(
        heat_time_ms=settings.heat_time_ms,
        duty_gain_q16=min(largest[1], math.ceil(CALIBRATION_RATIO * settings.duty_gain_q16)),
        nominal_supply_mV=settings.nominal_supply_mV,
        supply_high_mV=settings.supply_high_mV,
        force_limit_cN64=settings.force_limit_cN64,
        duty_limit_q15=settings.duty_limit_q15,
        full_duty_rise_K=min(largest[0], settings.full_duty_rise_K),
        heat_limit_K=settings.heat_limit_K,
        host_timeout_ms=settings.host_timeout_ms,
        tick_low_us=min(SHORTEST_us, settings.tick_us),
        tick_high_us=max(LONGEST_us, settings.tick_us),
    )


def refused_because(field: str, settings: Settings, limits: BoardLimits) -> str:
    """Say why firmware with these limits refuses the field of settings that it named."""
    asked = getattr(settings, field)
    at_most, at_least = _limits_of_field(field, settings, limits)
    for limit, is_looser, words in (
        (at_most, at_most is not None and asked > at_most, "at most"),
        (at_least, at_least is not None and asked < at_least, "at least"),
    ):
        if is_looser:
            return (
                f"{field} is {asked}, this board was built for {words} {limit}; "
                "settings can only be tighter, a looser limit needs firmware built for another rig"
            )
    return f"{field} is {asked}, out of its range or at odds with another field"


def _limits_of_field(field: str, settings: Settings, limits: BoardLimits) -> tuple[int | None, int | None]:
    """Return the most and the least that the board allows, None without such a limit."""
    if field == "tick_us":
        return limits.tick_high_us, limits.tick_low_us
    if field == "duty_gain_q16":
        return limits.duty_gain_q16 * limits.nominal_supply_mV // settings.nominal_supply_mV, None
    if field == "full_duty_rise_K":
        return None, limits.full_duty_rise_K
    if field in ("force_limit_cN64", "duty_limit_q15", "supply_high_mV", "heat_limit_K", "host_timeout_ms"):
        return getattr(limits, field), None
    return None, None
