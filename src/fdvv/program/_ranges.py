"""Between what the parameters of the shipped programs may be, over a base."""

from __future__ import annotations

from fdvv.errors import InputError
from fdvv.model import FDVVModel
from fdvv.program._button import key_points_mm

NEAR_BOTTOM_mm = 0.3
HOLD_mm = 0.2
"""How far a cap must come back before a place counts as left."""

Ranges = dict[str, tuple[float, float]]


def ranges(program: str, base: FDVVModel, levels: int = 1, **_: float) -> Ranges:
    """Give the least and the most of each parameter of a shipped program over a base.

    levels : of the program multi-level, whose detents must fit between them.
    """
    half_mm = base.travel_mm / 2 - 0.1
    below_actuation_mm = base.travel_mm - key_points_mm(base)[0]
    found: dict[str, Ranges] = {
        "fast-tapping": {
            "trigger_mm": (0.4, base.travel_mm - 2 * NEAR_BOTTOM_mm),
            "pull_cN": (6, 200),
            "push_cN": (20, 300),
            "drop_ms": (5, 1000),
        },
        "non-newtonian": {
            "soft_ratio": (0.1, 1.5),
            "stiffening_per_m_s": (0, 20),
            "fastest_mm_s": (10, 1000),
        },
        "multi-level": {
            "levels": (1, 8),
            "detent_cN": (0, 100),
            "detent_mm": (0.1, base.travel_mm / (levels + 1)),
        },
        "dwell-ticks": {
            "period_ms": (20, 10_000),
            "bottom_mm": (0.05, below_actuation_mm - 2 * HOLD_mm),
        },
        "returning-later": {
            "cooldown_ms": (1, 60_000),
            "event": (0, 31),
            "sunk_cN": (6, 100),
            "fade_ms": (0, 2000),
        },
        "rapid-trigger": dict.fromkeys(
            ("press_mm", "release_mm", "top_dead_mm", "bottom_dead_mm"), (0.01, half_mm)
        ),
    }
    return found.get(program, {})


def check_ranges(program: str, base: FDVVModel, **given: float) -> None:
    """Raise InputError for the first parameter that is out of its range."""
    levels = int(given.get("levels", 1))
    for name, (low, high) in ranges(program, base, levels=max(1, levels)).items():
        if not low <= given[name] <= high:
            reason = f"must be {low:g} to {high:g}, got {given[name]:g}"
            raise InputError(name, "value", reason, "choose another")
