"""What the name of a column or a channel says: quantity and unit."""

from __future__ import annotations

import re
from dataclasses import dataclass

from fdvv.recording._types import Quantity
from fdvv.units import GRAM_FORCE_cN

UNITS = {
    "cN": (Quantity.FORCE, 1.0),
    "mN": (Quantity.FORCE, 0.1),
    "N": (Quantity.FORCE, 100.0),
    "gf": (Quantity.FORCE, GRAM_FORCE_cN),
    "mm": (Quantity.DISPLACEMENT, 1.0),
    "um": (Quantity.DISPLACEMENT, 1e-3),
    "cm": (Quantity.DISPLACEMENT, 10.0),
    "m": (Quantity.DISPLACEMENT, 1000.0),
    "V": (Quantity.SOUND, 1.0),
    "mV": (Quantity.SOUND, 1e-3),
    "m_s2": (Quantity.ACCELERATION, 1.0),
    "count": (Quantity.COUNTS, 1.0),
    "counts": (Quantity.COUNTS, 1.0),
}
"""Units as they end a name, each with the factor to the unit of its quantity."""

TIME_s = {"s": 1.0, "ms": 1e-3, "us": 1e-6}
PLAIN = {
    "light": Quantity.LIGHT,
    "led": Quantity.LIGHT,
    "contact": Quantity.CONTACT,
    "closed": Quantity.CONTACT,
    "force": Quantity.COUNTS,
    "displacement": Quantity.COUNTS,
    "position": Quantity.COUNTS,
    "sound": Quantity.COUNTS,
    "adc": Quantity.COUNTS,
}
"""Names that are read without a unit; what they measure is then known only where it has none."""

_TIME = re.compile(r"(?:time|t|timestamp)_(s|ms|us)\Z", re.IGNORECASE)
_AXIS = re.compile(r"(.+)_([xyz])\Z", re.IGNORECASE)


@dataclass(frozen=True)
class Title:
    """What a name says; axis is x, y or z of a marker, empty for all else."""

    name: str
    quantity: Quantity
    scale: float
    axis: str = ""
    unit_is_known: bool = True


def time_scale_s(title: str) -> float | None:
    """Give the factor to seconds if this names a time."""
    match = _TIME.match(_plain(title))
    return TIME_s[match[1].lower()] if match else None


def read_title(title: str) -> Title | None:
    """Read a name such as force_cN, left_x_mm, "force (gf)" or contact; None if it says no quantity."""
    text = _plain(title)
    for unit in sorted(UNITS, key=len, reverse=True):
        name = text.removesuffix(f"_{unit}")
        if name != text and name:
            quantity, scale = UNITS[unit]
            axis = _AXIS.match(name)
            if axis and quantity is Quantity.DISPLACEMENT:
                return Title(axis[1], Quantity.MARKER, scale, axis[2].lower())
            return Title(name, quantity, scale)
    quantity_of_word = PLAIN.get(text.lower())
    if quantity_of_word is None:
        return None
    return Title(text, quantity_of_word, 1.0, "", quantity_of_word is not Quantity.COUNTS)


def _plain(title: str) -> str:
    """Write "force (gf)", "force [gf]" and "force gf" as force_gf."""
    text = title.strip().strip('"').replace("\N{MICRO SIGN}", "u").replace("\N{GREEK SMALL LETTER MU}", "u")
    return re.sub(r"[\s_]+", "_", re.sub(r"[()\[\]]", " ", text).strip()).replace("m/s2", "m_s2")
