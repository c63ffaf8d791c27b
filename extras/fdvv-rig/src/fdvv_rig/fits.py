"""Do parts of these dimensions fit each other? One question each, answered before anything is made."""

from __future__ import annotations

from collections.abc import Iterator

from fdvv.errors import InputError
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.layout import Layout
from fdvv_rig.limiter import HOLD_RATIO, Limiter
from fdvv_rig.screws import WASHER_mm
from fdvv_rig.tolerance import core_stack

MIN_AIR_mm = 0.4
"""Between plate and the body of the load cell."""

Miss = tuple[str, str, str]
"""The dimension, what is wrong, what to do."""


def check_fits(d: Dimensions) -> None:
    """Refuse dimensions whose parts would not fit each other, or not be printed.

    Raises InputError with the first thing that is wrong.
    """
    for place, reason, remedy in misses(d):
        raise InputError("dimensions", place, reason, remedy)


def misses(d: Dimensions) -> Iterator[Miss]:
    """Yield everything that does not fit, in the order in which it should be mended."""
    for question in (_bearings, _sensor, _walls, _screws, _cell, _limiter, _servo, _printer):
        yield from question(d)


def _bearings(d: Dimensions) -> Iterator[Miss]:
    for bore in ("bushing_bore_mm", "coil_bore_mm"):
        if getattr(d, bore) <= d.rod_diameter_mm:
            reason = f"{getattr(d, bore):g} mm does not let the rod of {d.rod_diameter_mm:g} mm through"
            yield bore, reason, "measure rod and bearing"
    if d.bushing_diameter_mm - d.bushing_bore_mm < 0.5:
        yield "bushing_diameter_mm", "leaves no wall about its bore", "measure the bushing"
    if d.coupling_diameter_mm > Layout(d).tower_bore_mm:
        remedy = f"stay under {Layout(d).tower_bore_mm:g} mm"
        yield "coupling_diameter_mm", "does not fit in the tower", remedy


def _sensor(d: Dimensions) -> Iterator[Miss]:
    if d.travel_mm > d.lvdt_range_mm:
        reason = f"{d.travel_mm:g} mm is more than the displacement sensor's {d.lvdt_range_mm:g} mm"
        yield "travel_mm", reason, "take a longer sensor or less travel"
    if d.lvdt_core_diameter_mm >= d.lvdt_bore_mm:
        yield "lvdt_core_diameter_mm", "the core does not enter the sensor's bore", "measure both"
    if d.lvdt_core_length_mm + d.travel_mm > d.lvdt_length_mm:
        yield "lvdt_core_length_mm", "the core leaves the sensor's body within the travel", "measure both"
    if d.core_rod_diameter_mm >= min(d.lvdt_bore_mm, d.coupling_diameter_mm):
        yield "core_rod_diameter_mm", "the rod is wider than what it goes into", "take a thinner rod"
    if not 0 < d.lvdt_sink_mm <= d.base_height_mm - 4.0:
        reason = f"{d.lvdt_sink_mm:g} mm leaves no room for the sensor's leads under the base"
        yield "lvdt_sink_mm", reason, f"stay under {d.base_height_mm - 4.0:g} mm, or make the base higher"
    if Layout(d).core_rod_length_mm < 2.0:
        yield "lvdt_length_mm", "leaves no rod between core and coupling", "measure sensor and core"
    beside_mm = Layout(d).lvdt_screw_mm - WASHER_mm[0] / 2 - d.lvdt_diameter_mm / 2
    if beside_mm < d.slide_gap_mm:
        reason = f"{d.coil_diameter_mm:g} mm makes a tower too narrow for the sensor's mount and its screws"
        yield "coil_diameter_mm", reason, "take a thinner displacement sensor, or a wider coil"
    worst_mm, room_mm = core_stack(d).worst_mm, (d.lvdt_bore_mm - d.lvdt_core_diameter_mm) / 2
    if d.float_mm < worst_mm - room_mm:
        reason = f"{d.float_mm:g} mm cannot take up {worst_mm - room_mm:.2f} mm of tolerances"
        yield "float_mm", reason, "let the sensor's mount be moved further"


def _walls(d: Dimensions) -> Iterator[Miss]:
    for name in ("wall_mm", "box_wall_mm", "switch_plate_mm"):
        if getattr(d, name) < d.thin_wall_mm:
            reason = f"{getattr(d, name):g} mm is thinner than prints well ({d.thin_wall_mm:g} mm)"
            yield name, reason, "make it thicker"
    side_mm = (d.tongue_width_mm - d.m3_clearance_mm) / 2
    if side_mm < d.thin_wall_mm:
        yield "tongue_width_mm", f"leaves {side_mm:.2f} mm beside the slot", "make the tongue wider"
    reach_mm = d.limiter_large_mm - d.horn_length_mm
    if reach_mm < d.thin_wall_mm:
        yield "horn_length_mm", f"leaves {reach_mm:.2f} mm of the limiter's arm", "cut the horn shorter"
    if d.limiter_small_mm < d.horn_hub_mm / 2 + d.thin_wall_mm:
        yield "limiter_small_mm", "leaves no wall about the horn's hub", "make the spiral larger"
    if d.limiter_thickness_mm < d.horn_thickness_mm + 2 * d.thin_wall_mm:
        yield "limiter_thickness_mm", "leaves no floor under the horn", "make the arm thicker"
    if d.cone_top_mm >= d.cone_bottom_mm:
        yield "cone_top_mm", "is not narrower than the cone's bottom", "swap them"


def _screws(d: Dimensions) -> Iterator[Miss]:
    for small, large in (
        ("m2_pilot_mm", "m2_clearance_mm"),
        ("m2_clearance_mm", "m2_head_mm"),
        ("m3_pilot_mm", "m3_clearance_mm"),
        ("m3_clearance_mm", "m3_head_mm"),
    ):
        if getattr(d, small) >= getattr(d, large):
            yield small, f"{getattr(d, small):g} mm is not less than {large}", "correct either"
    least_mm = d.m3_insert_mm + 2 * d.thin_wall_mm
    if d.yoke_thickness_mm < least_mm:
        yield "yoke_thickness_mm", "leaves no wall about its insert", f"take {least_mm:g} mm or more"


def _cell(d: Dimensions) -> Iterator[Miss]:
    layout = Layout(d)
    wall_mm = (layout.body_width_mm - layout.cell_bore_mm) / 2
    if wall_mm < d.thin_wall_mm:
        yield "plate_diameter_mm", f"leaves {wall_mm:.2f} mm of rim for the film", "take a smaller plate"
    room_mm = d.cell_ball_out_mm - d.plate_dimple_mm
    if room_mm < MIN_AIR_mm or d.plate_dimple_mm > d.cell_ball_mm / 2:
        yield "plate_dimple_mm", "sets the plate on the cell's body, or over its ball", "make it shallower"
    if d.cell_length_mm + 2 * d.fit_gap_mm + d.hole_excess_mm > layout.cell_bore_mm:
        yield "cell_length_mm", "does not fit in the holder", "take a smaller cell"
    screw_mm = layout.yoke_screw_mm - (d.m2_pilot_mm + d.hole_excess_mm) / 2
    if d.cell_width_mm / 2 > screw_mm - d.thin_wall_mm:
        yield "cell_width_mm", "meets the screws of the yoke", "turn the cell, or take a smaller one"


def _limiter(d: Dimensions) -> Iterator[Miss]:
    rise_mm = d.limiter_large_mm - d.limiter_small_mm
    if rise_mm <= 0 or d.servo_sweep_deg > 270.0:
        yield "limiter_large_mm", "makes no spiral that rises within the sweep", "enlarge it, or sweep less"
        return
    limiter = Limiter(d)
    low_mm, high_mm = limiter.range_mm
    if low_mm > 0 or high_mm < d.travel_mm:
        reach = f"the limiter stops from {low_mm:.2f} to {high_mm:.2f} mm"
        reason = f"{reach}, the travel is 0 to {d.travel_mm:g} mm"
        yield "limiter_large_mm", reason, "let the spiral rise more, or travel less"
    if d.foot_length_mm < rise_mm + d.overtravel_mm:
        reason = f"{d.foot_length_mm:g} mm lets the yoke hit a limiter that rises {rise_mm:g} mm"
        yield "foot_length_mm", reason, "make the foot longer"
    if limiter.torque_ratio > HOLD_RATIO:
        asked = f"{100 * limiter.torque_ratio:.0f} % of the stall torque"
        reason = f"a press of {d.finger_force_N:g} N asks {asked}"
        yield "servo_torque_kgf_cm", reason, "rise less per degree, or take a stronger servo"


def _servo(d: Dimensions) -> Iterator[Miss]:
    layout = Layout(d)
    if layout.bracket_plate_mm < 2 * d.thin_wall_mm:
        yield "servo_body_mm", "leaves no plate between its ears and its top", "measure the servo"
    low_mm = layout.servo_axis_mm + d.servo_axis_mm - d.servo_length_mm - d.servo_ear_mm
    if low_mm < 12.0:
        yield "servo_length_mm", "the servo would stand on the base", "take a longer displacement sensor body"


def _printer(d: Dimensions) -> Iterator[Miss]:
    width_mm, depth_mm, height_mm = Layout(d).box_mm
    if max(width_mm, depth_mm) + 2 * d.box_wall_mm > d.bed_width_mm:
        reason = f"the black box is {max(width_mm, depth_mm):.0f} mm wide"
        yield "bed_width_mm", reason, "use a larger printer"
    if height_mm + d.box_wall_mm > d.bed_height_mm:
        yield "bed_height_mm", f"the black box is {height_mm:.0f} mm high", "leave less room above the keycap"
