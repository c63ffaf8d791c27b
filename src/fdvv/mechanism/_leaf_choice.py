"""From a stiffness and a preload to a leaf that can be punched: strip sizes, length, stress."""

from __future__ import annotations

from collections.abc import Iterator

from fdvv.errors import ModelError
from fdvv.mechanism._coil import cN_PER_N
from fdvv.mechanism._leaf import Leaf
from fdvv.mechanism._making import Making
from fdvv.mechanism._material import STRIPS, STRIP_SIZES_mm, STRIP_WIDTHS_mm

LENGTH_STEP_mm, OFFSET_STEP_mm = 0.05, 0.01


def choose_leaf(preload_cN: float, stiffness_cN_mm: float, largest_cN: float, making: Making) -> Leaf:
    """Choose the least stressed leaf of a stiffness.

    preload_cN : its force where it just reaches the fixed contact. stiffness_cN_mm : of its tip.
    largest_cN : the most that the cam asks of it.
    Raises ModelError if none is short enough, long enough and strong enough.
    """
    leaves = list(_candidates(preload_cN, stiffness_cN_mm, making))
    limit = STRIPS[making.strip].bending_MPa
    if not leaves:
        low, high = making.leaf_mm
        raise ModelError(
            f"no strip of {making.strip} between {low:g} and {high:g} mm long has {stiffness_cN_mm:.0f} cN/mm"
        )
    best = min(leaves, key=lambda leaf: leaf.stress_MPa(largest_cN))
    if best.stress_MPa(largest_cN) > limit:
        raise ModelError(
            f"the least stressed leaf of {making.strip} bears {best.stress_MPa(largest_cN):.0f} MPa, "
            f"{limit:.0f} are permissible"
        )
    return best


def _candidates(preload_cN: float, stiffness_cN_mm: float, making: Making) -> Iterator[Leaf]:
    young = cN_PER_N * STRIPS[making.strip].young_MPa
    for thickness in STRIP_SIZES_mm:
        for width in STRIP_WIDTHS_mm:
            length = (young * width * thickness**3 / (4.0 * stiffness_cN_mm)) ** (1.0 / 3.0)
            length = round(round(length / LENGTH_STEP_mm) * LENGTH_STEP_mm, 4)
            if making.leaf_mm[0] <= length <= making.leaf_mm[1]:
                stiffness = young * width * thickness**3 / (4.0 * length**3)
                offset = round(round(preload_cN / stiffness / OFFSET_STEP_mm) * OFFSET_STEP_mm, 4)
                contact = round(length / making.contact_ratio ** (1.0 / 3.0), 2)
                yield Leaf(thickness, width, length, contact, offset, making.strip)
