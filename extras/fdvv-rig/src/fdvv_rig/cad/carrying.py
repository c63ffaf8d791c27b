"""What carries: base, tower and the displacement sensor's mount."""

from __future__ import annotations

from fdvv_rig.cad.shapes import Solid, block, cone, hexagon, prism, rod
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.layout import Layout

M3_NUT_mm = (5.5, 2.6)
SLIT_mm = 2.5


def base(d: Dimensions) -> Solid:
    """Make the base: a plate on a skirt, open below."""
    layout = Layout(d)
    (left, right), half, plate = layout.base_x_mm, d.base_depth_mm / 2, d.base_plate_mm
    made = block((left, -half, -d.base_height_mm), (right, half, 0.0), 6.0)
    wall = d.wall_mm - 1.0
    made -= block(
        (left + wall, -half + wall, -d.base_height_mm - 1), (right - wall, half - wall, -plate), 3.0
    )
    loose = 2 * d.float_mm + d.hole_excess_mm
    made -= _down(0.0, 0.0, plate, d.lvdt_diameter_mm + loose)
    for side in (-1, 1):
        made -= _down(side * layout.lvdt_screw_mm, 0.0, plate, d.m3_clearance_mm + loose)
    for x, y in (*layout.tower_screws_mm, *layout.bracket_screws_mm):
        made -= _down(x, y, plate, d.m3_insert_mm)
    made -= _board_holes(d) + _cable_ways(d)
    return made


def _board_holes(d: Dimensions) -> Solid:
    """Make the holes for both boards' spacers, 2 mm from their corners, one beside each other corner."""
    layout = Layout(d)
    sizes = ((d.board_width_mm, d.board_length_mm), (d.driver_width_mm, d.driver_length_mm))
    made = None
    for (width, length), y in zip(sizes, layout.boards_y_mm, strict=True):
        for side in (-1, 1):
            for end in (-1, 1):
                x_mm, y_mm = layout.boards_x_mm + side * (width / 2 - 2), y + end * (length / 2 - 2)
                hole = _down(x_mm, y_mm, d.base_plate_mm, d.m2_clearance_mm + d.hole_excess_mm)
                made = hole if made is None else made + hole
    return made


def _cable_ways(d: Dimensions) -> Solid:
    layout = Layout(d)
    main_y, driver_y = layout.boards_y_mm
    low_mm, high_mm = driver_y + d.driver_length_mm / 2, main_y - d.board_length_mm / 2
    x, y, half = layout.boards_x_mm, (low_mm + high_mm) / 2, (high_mm - low_mm) / 2 - 1.0
    made = block((x - 7, y - half, -d.base_plate_mm - 1), (x + 7, y + half, 1.0))
    bottom, back = -d.base_height_mm - 1, d.base_depth_mm / 2
    for at in (x, 0.0):
        made += block((at - 7, back - 6, bottom), (at + 7, back + 1, bottom + 8))
    return made


def _down(x: float, y: float, depth_mm: float, diameter_mm: float) -> Solid:
    return rod("z", (x, y, -depth_mm - 1), depth_mm + 2, diameter_mm)


def coil_mount(d: Dimensions) -> Solid:
    """Make the tower: sensor's room, cone, bushing's seat and coil's pocket in one bore."""
    layout = Layout(d)
    radius, half = layout.tower_radius_mm, layout.flange_mm
    made = rod("z", (0, 0, 0), layout.coil_top_mm, 2 * radius)
    made += block((-half, -half, 0.0), (half, half, layout.foot_plate_mm), 4.0)
    made += _clamp_ears(d) + _guide(d)
    made -= _bore(d) + _window(d) + _clamp_cut(d) + _guide_cut(d)
    for x, y in layout.tower_screws_mm:
        made -= rod("z", (x, y, -1), layout.foot_plate_mm + 2, d.m3_clearance_mm + d.hole_excess_mm)
    return made


def _bore(d: Dimensions) -> Solid:
    layout = Layout(d)
    wide, seat = layout.tower_bore_mm, d.bushing_diameter_mm + d.hole_excess_mm
    slope = (wide - seat) / 2
    low = layout.floor_low_mm - slope
    made = rod("z", (0, 0, -1), low + 1, wide)
    made += cone((0, 0, low), wide, seat, slope)
    made += rod("z", (0, 0, layout.floor_low_mm - 1), d.bushing_length_mm + 2, seat)
    return made + rod("z", (0, 0, layout.floor_top_mm), d.coil_length_mm + 1, wide)


def _window(d: Dimensions) -> Solid:
    layout = Layout(d)
    half, low = layout.tower_bore_mm / 2 + 1, layout.foot_plate_mm
    eaves = max(low + 22.0, layout.floor_low_mm - 3.0 - half)
    points = [(-half, low), (half, low), (half, eaves), (0, eaves + half), (-half, eaves)]
    return prism("y", points, -layout.tower_radius_mm - 1, -layout.tower_bore_mm / 4)


def _clamp_ears(d: Dimensions) -> Solid:
    layout = Layout(d)
    top, radius = layout.coil_top_mm, layout.tower_radius_mm
    points = [
        *((-radius + 3, top), (-radius - 9, top)),
        *((-radius - 9, top - 11), (-radius + 3, top - 23)),
    ]
    half = layout.ear_mm
    return prism("x", points, -half, half)


def _clamp_cut(d: Dimensions) -> Solid:
    layout = Layout(d)
    radius, top = layout.tower_radius_mm, layout.coil_top_mm
    made = block(
        (-SLIT_mm / 2, -radius - 10, layout.floor_top_mm),
        (SLIT_mm / 2, -layout.tower_bore_mm / 2 + 1, top + 1),
    )
    across, thick = M3_NUT_mm
    y, z, end = -radius - 4.5, top - 5.5, layout.ear_mm
    made += rod("x", (-end - 1, y, z), 2 * end + 2, d.m3_clearance_mm + d.hole_excess_mm)
    return made + hexagon("x", (end - thick, y, z), thick + 1, across + d.hole_excess_mm)


def _guide(d: Dimensions) -> Solid:
    layout = Layout(d)
    out = layout.tongue_out_mm + d.tongue_thickness_mm
    inner = layout.tower_radius_mm - 2
    top, low = layout.coil_top_mm, layout.pin_height_mm - 9
    points = [(-inner, top), (-out, top), (-out, low), (-inner, low - (out - inner))]
    half = d.tongue_width_mm / 2 + d.slide_gap_mm + 3
    return prism("y", points, -half, half)


def _guide_cut(d: Dimensions) -> Solid:
    layout = Layout(d)
    face, half = layout.tower_radius_mm + 3.5, d.tongue_width_mm / 2 + d.slide_gap_mm
    made = block((-face - 20, -half, layout.foot_plate_mm), (-face, half, layout.coil_top_mm + 1))
    deep = layout.tower_bore_mm / 2 + 0.8
    return made + rod(
        "x", (-face - 1, 0, layout.pin_height_mm), face + 1 - deep, d.m3_pilot_mm + d.hole_excess_mm
    )


def lvdt_mount(d: Dimensions) -> Solid:
    """Make the sensor's mount: a foot that floats on the base, a split collar above it."""
    layout = Layout(d)
    foot = layout.tower_bore_mm - 2 * d.float_mm - 2 * d.slide_gap_mm
    collar, high = d.lvdt_diameter_mm + 6.0, 24.0
    made = rod("z", (0, 0, 0), 8.0, foot) + rod("z", (0, 0, 0), high, collar)
    reach = foot / 2 - 1.0
    made += block((-5.5, -reach, 0), (5.5, -collar / 4, high)) & rod("z", (0, 0, 0), high, foot)
    hole = d.lvdt_diameter_mm + 2 * d.fit_gap_mm + d.hole_excess_mm
    made -= rod("z", (0, 0, -1), high + 2, hole)
    made -= block((-0.8, -reach - 2, 8.0), (0.8, 0, high + 1))
    screw = hole / 2 + d.m2_clearance_mm / 2 + 1.2
    made -= rod("x", (-10, -screw, high - 6), 20, d.m2_clearance_mm + d.hole_excess_mm)
    for side in (-1, 1):
        made -= rod("z", (side * layout.lvdt_screw_mm, 0, -1), 8.0, d.m3_pilot_mm + d.hole_excess_mm)
    return made
