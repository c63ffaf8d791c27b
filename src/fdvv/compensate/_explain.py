"""What was found of a rig, in a sentence."""

from __future__ import annotations

from fdvv.compensate._known_rig import KnownRig

VAGUE_ratio = 0.5
"""A standard error above this share of its number is said to be weak."""
NAMES = {
    "gain": ("gain", ""),
    "drag_N_s_m": ("drag", "N s/m"),
    "friction_cN": ("friction", "cN"),
    "weight_cN": ("weight", "cN"),
    "mass_g": ("mass", "g"),
    "delay_s": ("command felt after", "ms"),
    "position_lag_s": ("place sensed after", "ms"),
    "play_cN": ("play of the sensor", "cN"),
}


def explain(known: KnownRig, middle_mm: float = 2.0) -> str:
    """Say what was found, with standard errors, and which of it is weak; the gain at middle_mm."""
    found, weak = [], []
    for name, (words, unit) in NAMES.items():
        value, error = value_of(known, name, middle_mm), known.error.get(name, 0.0)
        scale = 1000.0 if unit == "ms" else 1.0
        digits = 2 if unit in ("", "ms") else 1
        end = f" {unit}" if unit else ""
        found.append(f"{words} {scale * value:.{digits}f} +- {scale * error:.{digits}f}{end}")
        if error > VAGUE_ratio * abs(value):
            weak.append(words)
    told = f"{', '.join(found)}, from {known.presses} presses; {known.residual_cN:.1f} cN rms unexplained"
    return f"{told}; weak: {', '.join(weak)}" if weak else told


def value_of(known: KnownRig, name: str, middle_mm: float) -> float:
    """Give a number of a rig by its name; the gain at middle_mm."""
    if name != "gain":
        return float(getattr(known, name))
    c0, c1, c2 = known.gain
    return c0 + middle_mm * (c1 + middle_mm * c2)
