"""Random units of a button."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from fdvv.twin.button import ButtonPhysics
from fdvv.twin.draw import draw_section


def draw_button(button: ButtonPhysics, random: np.random.Generator) -> ButtonPhysics:
    """Draw another unit of a button: every assumed quantity uniform over its plausible range.

    What the curves say (stops, contact, spacing) stays; their force as a whole is scaled. Words stay.
    """
    scaled = draw_section(button.curve, random).force_ratio
    return replace(
        button,
        curve=replace(button.curve, force_ratio=scaled),
        slider=draw_section(button.slider, random),
        leaf=draw_section(button.leaf, random),
        dome=draw_section(button.dome, random),
        housing=draw_section(button.housing, random),
    )
