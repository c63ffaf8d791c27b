"""What moves with the slider, and what stops it: yoke, keycap adapter, limiter's arm and bracket."""

from __future__ import annotations

import numpy as np

from fdvv_rig.cad.shapes import Solid, ball, block, kernel, prism, rod
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.layout import Layout
from fdvv_rig.limiter import RETURN_DEG, Limiter

INSERT_DEPTH_mm = 5.8
POCKET_mm = 1.2
"""How deep the load cell is let in."""
LEADS_mm = 4.0
"""Width of the slots for its leads."""
HORN_SHARE = 0.9
"""Where in the sweep the horn points: towards the spiral's large end, a little before it."""


def slider_yoke(d: Dimensions) -> Solid:
    """Make the yoke: a plate on the rod's end with a foot at one arm and a tongue at the other."""
    layout = Layout(d)
    low, top, half = layout.yoke_low_mm, layout.yoke_top_mm, layout.body_width_mm / 2
    out = layout.tongue_out_mm + d.tongue_thickness_mm
    made = block((-half, -half, low), (half, half, top), 1.5)
    made += block((-out, -d.tongue_width_mm / 2, low), (0, d.tongue_width_mm / 2, top))
    made += block((0, -d.tongue_width_mm / 2, low), (layout.limiter_out_mm, d.tongue_width_mm / 2, top))
    made += _foot(d) + _tongue(d)
    made -= rod("z", (0, 0, low - 1), top - low + 2, d.rod_diameter_mm + d.fit_gap_mm + d.hole_excess_mm)
    for side in (-1, 1):
        at = (side * layout.yoke_screw_mm, 0.0, low - 1)
        made -= rod("z", at, top - low + 2, d.m2_clearance_mm + d.hole_excess_mm)
        made -= rod("z", at, layout.head_room_mm + 1, d.m2_head_mm)
    middle = (low + top) / 2
    made -= rod("y", (0, 0, middle), half + 1, d.m3_clearance_mm)
    return made - rod("y", (0, half - INSERT_DEPTH_mm, middle), INSERT_DEPTH_mm + 1, d.m3_insert_mm)


def _foot(d: Dimensions) -> Solid:
    layout, radius = Layout(d), d.foot_radius_mm
    begin, end, low = layout.limiter_in_mm, layout.limiter_out_mm, layout.foot_low_mm
    made = block((begin, -radius, low + radius), (end, radius, layout.yoke_low_mm + 1))
    return made + rod("x", (begin, 0, low + radius), end - begin, 2 * radius)


def _tongue(d: Dimensions) -> Solid:
    layout = Layout(d)
    near, half = layout.tongue_out_mm, d.tongue_width_mm / 2
    far = near + d.tongue_thickness_mm
    made = block((-far, -half, layout.tongue_low_mm), (-near, half, layout.yoke_low_mm + 1))
    (low, high), width = layout.slot_mm, d.m3_clearance_mm
    low, high = low + width / 2, high - width / 2
    made -= block((-far - 1, -width / 2, low), (-near + 1, width / 2, high))
    for z in (low, high):
        made -= rod("x", (-far - 1, 0, z), far - near + 2, width)
    return made


def keycap_adapter(d: Dimensions) -> Solid:
    """Make the adapter: the exciter's seat, open to the front, under the stem of a keycap."""
    layout = Layout(d)
    half, low, roof = layout.body_width_mm / 2, layout.yoke_top_mm, layout.roof_low_mm
    made = block((-half, -half, low), (half, half, layout.stem_low_mm), 1.5)
    seat = half - 2.0
    made -= block((-seat, -half - 1, low + layout.adapter_floor_mm), (seat, seat, roof))
    for side in (-1, 1):
        at = (side * layout.yoke_screw_mm, 0.0, low - 1)
        made -= rod("z", at, layout.adapter_floor_mm + 0.4, d.m2_pilot_mm + d.hole_excess_mm)
    foot, top = layout.stem_low_mm - 0.5, layout.stem_low_mm + d.stem_height_mm
    arm, along, across = d.stem_arm_mm / 2, d.stem_along_mm / 2, d.stem_across_mm / 2
    cross = block((-arm, -along, foot), (arm, along, top)) + block((-across, -arm, foot), (across, arm, top))
    return made + cross


def cell_holder(d: Dimensions) -> Solid:
    """Make the holder: the load cell's pocket on the axis, a rim for the film, slots for the leads."""
    layout = Layout(d)
    half, low, seat = layout.body_width_mm / 2, layout.yoke_top_mm, layout.cell_seat_mm
    rim = layout.plate_low_mm - d.film_preload_mm
    made = block((-half, -half, low), (half, half, rim), 1.5)
    made -= rod("z", (0, 0, seat + POCKET_mm), rim, layout.cell_bore_mm)
    gap = d.fit_gap_mm + d.hole_excess_mm / 2
    x, y = d.cell_width_mm / 2 + gap, d.cell_length_mm / 2 + gap
    made -= block((-x, -y, seat), (x, y, rim + 1))
    made -= block((-LEADS_mm / 2, -half - 1, seat), (LEADS_mm / 2, half + 1, rim - d.thin_wall_mm))
    for side in (-1, 1):
        at = (side * layout.yoke_screw_mm, 0.0, low - 1)
        made -= rod("z", at, layout.adapter_floor_mm + 0.4, d.m2_pilot_mm + d.hole_excess_mm)
    return made


def cell_plate(d: Dimensions) -> Solid:
    """Make the plate that the finger presses: a disc with a dimple for the cell's ball."""
    low, ball_mm = Layout(d).plate_low_mm, d.cell_ball_mm + d.hole_excess_mm
    made = rod("z", (0, 0, low), d.plate_thickness_mm, d.plate_diameter_mm)
    return made - ball((0, 0, low + d.plate_dimple_mm - ball_mm / 2), ball_mm)


def limiter_arm(d: Dimensions) -> Solid:
    """Make the limiter's arm: the spiral with a pocket for the horn on the servo's side."""
    layout = Layout(d)
    begin, end, z = layout.limiter_in_mm, layout.limiter_out_mm, layout.servo_axis_mm
    made = _spiral(d, begin, end)
    face = end - d.horn_thickness_mm
    hub = d.horn_hub_mm + 2 * d.fit_gap_mm + d.hole_excess_mm
    made -= rod("x", (face, 0, z), d.horn_thickness_mm + 1, hub)
    made -= rod("x", (begin - 1, 0, z), end - begin + 2, d.horn_hub_mm - 1.5)
    return made - _horn_pocket(d, face, end)


def _spiral(d: Dimensions, begin: float, end: float) -> Solid:
    k, limiter, z = kernel(), Limiter(d), Layout(d).servo_axis_mm
    sweep, back = d.servo_sweep_deg, d.servo_sweep_deg + RETURN_DEG

    def points(first: float, last: float, count: int) -> list[tuple[float, float, float]]:
        at = limiter.outline(np.linspace(first, last, count))
        return [(begin, float(y), float(up) + z) for y, up in at]

    edges = [k.Spline(*points(0.0, sweep, 16)), k.Spline(*points(sweep, back, 7))]
    edges.append(k.ThreePointArc(*points(back, 360.0, 3)))
    return k.extrude(k.make_face(edges), amount=end - begin, dir=(1, 0, 0))


def _horn_pocket(d: Dimensions, face: float, end: float) -> Solid:
    k, z = kernel(), Layout(d).servo_axis_mm
    half = d.horn_width_mm / 2 + d.fit_gap_mm + d.hole_excess_mm / 2
    made = block((face, 0, z - half), (end + 1, d.horn_length_mm + d.fit_gap_mm, z + half))
    for along in (0.55, 0.85):
        made += rod("x", (face - 20, along * d.horn_length_mm, z), 21, d.m2_pilot_mm)
    angle = 90.0 - HORN_SHARE * d.servo_sweep_deg
    turned = k.Rot(angle, 0, 0) * (k.Pos(0, 0, -z) * made)
    return k.Pos(0, 0, z) * turned


def limiter_bracket(d: Dimensions) -> Solid:
    """Make the bracket: a plate with the servo's window, two cheeks and a foot."""
    layout = Layout(d)
    begin, end, plate = layout.bracket_in_mm, layout.bracket_out_mm, layout.bracket_plate_mm
    half, (servo_low, servo_top) = d.servo_width_mm / 2 + 5.0, layout.servo_z_mm
    made = block((begin, -half, 0), (begin + plate, half, servo_top + d.servo_ear_mm + 3))
    made += block((begin, -half - 9, 0), (end, half + 9, layout.foot_plate_mm))
    cheek = [
        (begin, 1.0),
        (end, 1.0),
        (end, 9.0),
        (begin + plate, servo_low - d.servo_ear_mm - 2),
        (begin, 9.0),
    ]
    for y in (-half, half - 3.0):
        made += prism("y", cheek, y, y + 3.0)
    gap = d.fit_gap_mm + d.hole_excess_mm / 2
    side = d.servo_width_mm / 2 + gap
    made -= block((begin - 1, -side, servo_low - gap), (begin + plate + 1, side, servo_top + gap))
    for z in (servo_low - d.servo_screw_mm, servo_top + d.servo_screw_mm):
        made -= rod("x", (begin - 1, 0, z), plate + 2, d.m2_pilot_mm + d.hole_excess_mm)
    for x, y in layout.bracket_screws_mm:
        made -= rod("z", (x, y, -1), 7.0, d.m3_clearance_mm + d.hole_excess_mm)
    return made
