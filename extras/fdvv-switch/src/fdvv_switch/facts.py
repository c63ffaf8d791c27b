"""A mechanism as numbers with units in their names, and what its maker should know."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import asdict

from fdvv.units import FloatArray
from fdvv_switch.coil import Coil
from fdvv_switch.dome import DomeMechanism, Pin
from fdvv_switch.leaf import Leaf, LeafMechanism
from fdvv_switch.mechanism import Mechanism
from fdvv_switch.target import Target

MOST_STRAIN_ratio = 0.5
"""Rubber of keys is not strained farther for millions of presses; assumed."""


def facts_of(mechanism: Mechanism, target: Target) -> dict[str, dict[str, float | str]]:
    """Return every part's sizes and what follows from them, by the part's name."""
    x = target.displacement_mm
    found: dict[str, dict[str, float | str]] = {}
    if isinstance(mechanism, DomeMechanism):
        dome = mechanism.dome
        more = {"angle_deg": dome.angle_deg, "largest_strain_ratio": dome.strain_ratio(x)}
        found["dome"] = asdict(dome) | more
        if mechanism.pad:
            found["pad"] = _foot(mechanism.pad)
        found["foot"] = {"gap_mm": mechanism.gap_mm, "rim_mm": mechanism.rim_mm, **_foot(mechanism.foot)}
    else:
        found["spring"] = _coil(mechanism.coil, target.travel_mm)
    if isinstance(mechanism, LeafMechanism):
        found["leaf"] = _leaf(mechanism.leaf, largest_leaf_cN(mechanism, x))
        found["cam"] = _cam(mechanism, x)
    found["guide"] = asdict(mechanism.guide)
    return found


def largest_leaf_cN(mechanism: LeafMechanism, x: FloatArray) -> float:
    """Return the largest force between leaf and cam."""
    return float(mechanism.leaf.force_cN(mechanism.cam.at(x)).max())


def _sizes(part: object, names: str) -> dict[str, float | str]:
    """Return sizes of a part, named in one text."""
    return {name: getattr(part, name) for name in names.split()}


def _coil(coil: Coil, travel_mm: float) -> dict[str, float | str]:
    buckles = coil.buckles_mm()
    return {
        "material": coil.wire.name,
        **_sizes(coil, "wire_mm mean_mm"),
        "outer_mm": coil.mean_mm + coil.wire_mm,
        "active_coils": coil.active,
        **_sizes(coil, "free_mm built_mm solid_mm rate_cN_mm preload_cN"),
        "stress_MPa": coil.stress_MPa(travel_mm),
        "stress_ratio": coil.stress_ratio(travel_mm),
        **({} if buckles is None else {"buckles_unguided_mm": buckles}),
    }


def _leaf(leaf: Leaf, largest_cN: float) -> dict[str, float | str]:
    return {
        "material": leaf.strip.name,
        **_sizes(leaf, "thickness_mm width_mm length_mm offset_mm stiffness_cN_mm preload_cN"),
        **_sizes(leaf, "contact_length_mm contact_cN_mm"),
        "largest_cN": largest_cN,
        "stress_MPa": leaf.stress_MPa(largest_cN),
        "stress_ratio": leaf.stress_MPa(largest_cN) / leaf.strip.bending_MPa,
    }


def _cam(mechanism: LeafMechanism, x: FloatArray) -> dict[str, float | str]:
    cam = mechanism.cam
    curvature = cam.curvature_1_mm(x)
    height, slope = cam.at(x), cam.at(x, 1)
    return {
        "friction_ratio": mechanism.friction_ratio,
        "nose_mm": cam.nose_mm,
        "highest_mm": float(height.max()),
        "lowest_mm": float(height.min()),
        "steepest_rise_ratio": float(slope.max()),
        "steepest_fall_ratio": float(-slope.min()),
        "sharpest_edge_mm": 1.0 / max(float(-curvature.min()), 1e-3),
        "sharpest_hollow_mm": 1.0 / max(float(curvature.max()), 1e-3),
    }


def _foot(foot: Pin | Leaf) -> dict[str, float | str]:
    if isinstance(foot, Pin):
        return {"kind": "pin", **asdict(foot), "stiffness_cN_mm": foot.stiffness_cN_mm}
    sizes = _sizes(foot, "thickness_mm width_mm length_mm stiffness_cN_mm")
    return {"kind": "leaf", "material": foot.strip.name, **sizes}


def notes_of(mechanism: Mechanism, target: Target) -> Iterator[str]:
    """Say what a maker should know that no size tells."""
    if isinstance(mechanism, DomeMechanism):
        strain = mechanism.dome.strain_ratio(target.displacement_mm)
        if strain > MOST_STRAIN_ratio:
            limit = f"more than the {100 * MOST_STRAIN_ratio:.0f} % it bears for long"
            yield f"the rubber is strained by {100 * strain:.0f} %, {limit}"
        if mechanism.rim_mm > 0:
            yield (
                f"the cone goes on past flat: its base stands on a rim of {mechanism.rim_mm:.2f} mm, "
                "as drawn, so that its top finds room"
            )
        yield "the theory of the cone takes the wall for rigid: correct the first mould by its hardness"
        return
    pressed = mechanism.coil.free_mm - mechanism.coil.built_mm + target.travel_mm
    buckles = mechanism.coil.buckles_mm()
    if buckles is not None and buckles < pressed:
        yield f"unguided the spring would buckle at {buckles:.1f} mm of {pressed:.1f}: it needs its post"
