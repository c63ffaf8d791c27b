"""Random dimensions that a person might measure, kept where the parts still fit."""

from __future__ import annotations

import dataclasses

from hypothesis import strategies as st

from fdvv_rig.dimensions import Dimensions
from fdvv_rig.fits import misses

RANGES = {
    "travel_mm": (2.0, 6.4),
    "coil_diameter_mm": (25.0, 30.0),
    "coil_length_mm": (18.0, 28.0),
    "rod_diameter_mm": (2.0, 3.0),
    "bushing_length_mm": (4.0, 8.0),
    "lvdt_diameter_mm": (8.5, 10.5),
    "lvdt_length_mm": (42.0, 56.0),
    "coupling_length_mm": (6.0, 10.0),
    "servo_length_mm": (20.0, 24.0),
    "servo_width_mm": (11.0, 13.0),
    "horn_length_mm": (11.0, 15.0),
    "exciter_diameter_mm": (11.0, 16.0),
    "exciter_height_mm": (4.0, 8.0),
    "keycap_width_mm": (17.0, 19.0),
    "slide_gap_mm": (0.15, 0.4),
    "fit_gap_mm": (0.05, 0.12),
    "limiter_large_mm": (16.8, 17.6),
    "wall_mm": (3.0, 5.0),
}


def _made(values: dict[str, float]) -> Dimensions:
    rod_mm = values["rod_diameter_mm"]
    bores = {"bushing_bore_mm": rod_mm + 0.04, "coil_bore_mm": rod_mm + 0.1}
    return dataclasses.replace(Dimensions(), **values, **bores)


legal_dimensions = (
    st.fixed_dictionaries(
        {name: st.floats(low, high).map(lambda v: round(v, 2)) for name, (low, high) in RANGES.items()}
    )
    .map(_made)
    .filter(lambda d: not list(misses(d)))
)
