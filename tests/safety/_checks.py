"""Settings that the firmware is to check and to tighten, and what a plain Python oracle says of each."""

from __future__ import annotations

import dataclasses
import random
import struct
from collections.abc import Iterator

from fdvv.firmware.limits import limits_like
from fdvv.protocol.tables import BoardLimits, Settings

NAMES = [field.name for field in dataclasses.fields(Settings)]
BEYOND = (
    ("window_end_um16", "window_start_um16"),
    ("supply_high_mV", "supply_low_mV"),
    ("reading_high", "reading_low"),
    ("heat_limit_K", "derate_start_K"),
)
"""A field, and the one that it must be beyond."""
AT_MOST = ("force_limit_cN64", "duty_limit_q15", "supply_high_mV", "heat_limit_K", "host_timeout_ms")
Values = dict[str, int]
STEEPEST = Settings.LIMITS["position_gain_q14"][1]


def wrong(values: Values, limits: BoardLimits) -> str:
    """Name the field that is refused first; empty if none is."""
    for name, (low, high) in Settings.LIMITS.items():
        if not low <= values[name] <= high:
            return name
    for name, start in BEYOND:
        if values[name] <= values[start]:
            return name
    if not 0 < abs(values["position_gain_q14"]) <= steepest_gain(values["reads"] * values["reading_high"]):
        return "position_gain_q14"
    if values["duty_gain_q16"] > largest_gain(values, limits):
        return "duty_gain_q16"
    looser = [name for name in ("tick_us", *AT_MOST, "full_duty_rise_K") if loosened(name, values, limits)]
    return min(looser, key=order, default="")


def steepest_gain(largest_sum: int) -> int:
    """Return the largest position gain, either sign: a way of 19 bits, by a division of 32."""
    return 2 * ((2**32 - 1 - 2**13) // largest_sum)


def order(name: str) -> int:
    """Return the place of a limit in the firmware's table, which names the first one."""
    return ("tick_us", *AT_MOST[:3], "full_duty_rise_K", *AT_MOST[3:]).index(name)


def loosened(name: str, values: Values, limits: BoardLimits) -> bool:
    """Return whether a value is looser than the board."""
    if name == "tick_us":
        return not limits.tick_low_us <= values[name] <= limits.tick_high_us
    if name == "full_duty_rise_K":
        return values[name] < limits.full_duty_rise_K
    return bool(values[name] > getattr(limits, name))


def largest_gain(values: Values, limits: BoardLimits) -> int:
    """Return the most duty per force."""
    return limits.duty_gain_q16 * limits.nominal_supply_mV // values["nominal_supply_mV"]


def tightened(values: Values, limits: BoardLimits) -> Values:
    """Return the nearest values that are no looser than the board."""
    now = dict(values)
    now["tick_us"] = max(min(now["tick_us"], limits.tick_high_us), limits.tick_low_us)
    for name in AT_MOST:
        now[name] = min(now[name], getattr(limits, name))
    now["full_duty_rise_K"] = max(now["full_duty_rise_K"], limits.full_duty_rise_K)
    now["duty_gain_q16"] = min(now["duty_gain_q16"], largest_gain(values, limits))
    now["derate_start_K"] = min(now["derate_start_K"], now["heat_limit_K"] - 1)
    now["supply_low_mV"] = min(now["supply_low_mV"], now["supply_high_mV"] - 1)
    return now


def packed(values: Values) -> bytes:
    """Pack settings, also those that are out of range; struct.error for what a field cannot hold."""
    return struct.pack(Settings.FORMAT, *(values[name] for name in NAMES))


def cases() -> Iterator[tuple[Values, BoardLimits]]:
    """Yield every bound of every field from both sides, alone and in pairs, and some by chance."""
    usual, loosest = dataclasses.asdict(Settings()), limits_like(Settings())
    tight = dataclasses.replace(loosest, duty_limit_q15=32_000, tick_high_us=900, tick_low_us=260)
    for limits in (loosest, tight):
        for name, (low, high) in Settings.LIMITS.items():
            for value in (low - 1, low, low + 1, high - 1, high, high + 1, usual[name]):
                yield usual | {name: value}, limits
        for name in BoardLimits.LIMITS:
            bound = getattr(limits, name)
            fields = {"tick_low_us": "tick_us", "tick_high_us": "tick_us"}.get(name, name)
            for value in (bound - 1, bound, bound + 1):
                if fields in usual:
                    yield usual | {"duty_limit_q15": 32_000, "tick_us": 500, fields: value}, limits
    for name, start in BEYOND:
        for way in (-1, 0, 1):
            yield usual | {name: usual[start] + way}, loosest
    yield from _by_chance(usual, random.Random(4))


def _by_chance(usual: Values, rng: random.Random) -> Iterator[tuple[Values, BoardLimits]]:
    for _ in range(600):
        limits = dataclasses.replace(
            limits_like(Settings()),
            **{n: rng.choice([low, high]) for n, (low, high) in BoardLimits.LIMITS.items() if n in AT_MOST},
            nominal_supply_mV=rng.choice([3000, 11_999, 12_000, 48_000]),
            duty_gain_q16=rng.choice([25_992, 70_001, 2**20]),
            full_duty_rise_K=rng.choice([1, 596, 16_383]),
        )
        reads, high = rng.randint(1, 64), rng.randint(100, 65_535)
        values = usual | {"reads": reads, "reading_high": high}
        values["position_offset_um16"] = rng.choice([-400_000, -101_600, 0, 400_000])
        edge = min(STEEPEST, steepest_gain(reads * high))
        gain = rng.choice([0, 1, -1, edge, -edge, min(STEEPEST, edge + 1), max(-STEEPEST, -edge - 1)])
        values["position_gain_q14"] = gain
        values["nominal_supply_mV"] = rng.choice([3000, 12_001, 48_000])
        values["supply_low_mV"] = rng.choice([2000, 9000, 48_000])
        most = min(2**20, largest_gain(values, limits))
        values["duty_gain_q16"] = max(64, min(2**20, most + rng.choice([-1, 0, 1])))
        yield values, limits


def checks_of_settings() -> dict[str, bytes]:
    """Return the file that _replay.c reads: settings, limits, expected refusal, settings when tightened."""
    rows = []
    for values, limits in cases():
        name = wrong(values, limits)
        number = NAMES.index(name) + 1 if name else 0
        try:
            given, wanted = packed(values), packed(tightened(values, limits))
        except struct.error:
            continue  # the field cannot hold it
        rows.append(given + limits.pack() + wanted + struct.pack("<I", number))
    return {"checks": b"".join(rows)}
