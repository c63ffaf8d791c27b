"""What a column's name says: quantity, unit, stroke, velocity."""

from __future__ import annotations

import re
from dataclasses import dataclass
from enum import StrEnum

from fdvv.model import Stroke
from fdvv.units import GRAM_FORCE_cN


class Quantity(StrEnum):
    """What a column measures."""

    DISPLACEMENT = "displacement"
    FORCE = "force"
    TIME = "time"
    CLOSED = "closed"
    OTHER = "other"


LENGTH_mm = {
    "mm": 1.0, "millimeter": 1.0, "millimeters": 1.0, "millimetre": 1.0, "millimetres": 1.0,
    "um": 1e-3, "micron": 1e-3, "microns": 1e-3, "micrometer": 1e-3, "micrometers": 1e-3,
    "micrometre": 1e-3, "micrometres": 1e-3,
    "cm": 10.0, "m": 1000.0, "meter": 1000.0, "meters": 1000.0, "metre": 1000.0, "metres": 1000.0,
    "in": 25.4, "inch": 25.4, "inches": 25.4,
}  # fmt: skip
OUNCE_FORCE_cN = 28.349523125 * GRAM_FORCE_cN
FORCE_cN = {
    "gf": GRAM_FORCE_cN, "g": GRAM_FORCE_cN, "gram": GRAM_FORCE_cN, "grams": GRAM_FORCE_cN,
    "gramforce": GRAM_FORCE_cN, "kgf": 1000 * GRAM_FORCE_cN, "kg": 1000 * GRAM_FORCE_cN,
    "n": 100.0, "newton": 100.0, "newtons": 100.0, "cn": 1.0, "mn": 0.1,
    "oz": OUNCE_FORCE_cN, "ozf": OUNCE_FORCE_cN, "lbf": 16 * OUNCE_FORCE_cN,
}  # fmt: skip
TIME_s = {
    "s": 1.0, "sec": 1.0, "seconds": 1.0, "ms": 1e-3, "millis": 1e-3, "milliseconds": 1e-3, "us": 1e-6,
}  # fmt: skip
WORDS = {
    Quantity.FORCE: {"force", "load", "f", "fz", "weight", "loadcell", "scale"},
    Quantity.DISPLACEMENT: {
        "displacement", "disp", "travel", "distance", "position", "pos", "x", "depth", "deflection",
        "stroke", "compression",
    },
    Quantity.TIME: {"time", "t", "timestamp", "millis"},
    Quantity.CLOSED: {"actuated", "closed", "contact"},
}  # fmt: skip
NOT_MEASURED = {"velocity", "speed", "acceleration", "temperature", "judge", "number", "index", "raw"}
"""Columns that carry a unit or a word of force or travel but are neither."""
UNITS = {Quantity.FORCE: FORCE_cN, Quantity.DISPLACEMENT: LENGTH_mm, Quantity.TIME: TIME_s}
STROKES = {
    Stroke.PRESS: {"press", "down", "downstroke", "loading", "pressing"},
    Stroke.RELEASE: {"release", "up", "upstroke", "unloading", "releasing"},
}
_VELOCITY = re.compile(r"(\d+(?:\.\d+)?)\s*_?mm(?:_|/|\s|\s?per\s)s(?![a-z])")


@dataclass(frozen=True)
class Column:
    """One column as its name describes it; ``scale`` takes it to mm, cN or s (None: no unit given)."""

    index: int
    title: str
    quantity: Quantity
    scale: float | None = None
    stroke: Stroke | None = None
    velocity_mm_s: float | None = None


def describe(index: int, title: str) -> Column:
    """Read one column's name; case, brackets, underscores and order of the words do not matter."""
    text = title.replace("\N{MICRO SIGN}", "u").replace("\N{GREEK SMALL LETTER MU}", "u").lower()
    speed = _VELOCITY.search(text)
    velocity = float(speed.group(1)) if speed else None
    tokens = re.findall(r"[a-z]+", _VELOCITY.sub(" ", text))
    stroke = next((stroke for stroke, names in STROKES.items() if names & set(tokens)), None)
    quantity = _quantity(tokens)
    scale = next((UNITS[quantity][t] for t in reversed(tokens) if t in UNITS.get(quantity, {})), None)
    if quantity is Quantity.CLOSED:
        scale = 1.0
    return Column(index, title.strip(), quantity, scale, stroke, velocity if velocity else None)


def _quantity(tokens: list[str]) -> Quantity:
    if NOT_MEASURED & set(tokens):
        return Quantity.OTHER
    if tokens == ["stroke"]:
        return Quantity.OTHER
    # the last quantity named is the one measured: "press force", "contact force"
    for token in reversed(tokens):
        for quantity, words in WORDS.items():
            if token in words:
                return quantity
    # a unit alone names a quantity, unless it is one letter that may stand for anything (n, m, s)
    for token in reversed(tokens):
        for quantity, units in UNITS.items():
            if token in units and len(token) > 1 and token != "in":
                return quantity
    return Quantity.OTHER


def guess_length_mm(span: float) -> float | None:
    """Tell mm from um and m by the span of a button's travel; None if no unit fits."""
    for scale in (1.0, 1e-3, 1000.0):
        if 0.3 <= span * scale <= 30.0:
            return scale
    return None
