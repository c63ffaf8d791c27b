"""What stands beside the rig: the finger's sensor cone, capture jig, marker posts, black box."""

from __future__ import annotations

from fdvv_rig.cad.shapes import Solid, ball, block, cone, prism, rod
from fdvv_rig.dimensions import Dimensions
from fdvv_rig.layout import Layout
from fdvv_rig.placement import POSTS_mm

JIG_mm = (36.0, 26.0)
JIG_PLATE_mm = 4.0
JIG_WALL_mm = 3.0
PEG_mm = 6.0
PEG_LENGTH_mm = 8.0
DIMPLE_SHARE = 0.7
"""How deep the sensor's ball sinks into the cone, as a share of its radius."""


def sensor_cone(d: Dimensions) -> Solid:
    """Make the cone of the paper, with a dimple that keeps it on the sensor's ball."""
    ball_mm = d.sensor_ball_mm + d.hole_excess_mm
    made = cone((0, 0, 0), d.cone_bottom_mm, d.cone_top_mm, d.cone_height_mm)
    return made - ball((0, 0, -(1 - DIMPLE_SHARE) * ball_mm / 2), ball_mm)


def capture_jig(d: Dimensions) -> Solid:
    """Make the jig: a plate with a switch's hole, posts' sockets and inserts, on a skirt with the lights."""
    (half_x, half_y), plate, wall = JIG_mm, JIG_PLATE_mm, JIG_WALL_mm
    bottom = -(d.switch_depth_mm + d.switch_plate_mm + 12.0)
    made = block((-half_x, -half_y, bottom), (half_x, half_y, 0), 5.0)
    made -= block((-half_x + wall, -half_y + wall, bottom - 1), (half_x - wall, half_y - wall, -plate), 2.0)
    for x, y in POSTS_mm:
        made += rod("z", (x, y, -PEG_LENGTH_mm - 2), PEG_LENGTH_mm + 1, PEG_mm + 6)
    for side in (-1, 1):
        made += rod("z", (side * 17.0, 0, -8), 7.0, d.m3_insert_mm + 5)
    made -= _switch_hole(d) + _jig_holes(d, bottom)
    return made


def _switch_hole(d: Dimensions) -> Solid:
    half, room = (d.switch_hole_mm + d.hole_excess_mm / 2) / 2, d.switch_hole_mm / 2 + 3.0
    made = block((-half, -half, -JIG_PLATE_mm - 1), (half, half, 1))
    return made + block((-room, -room, -JIG_PLATE_mm - 1), (room, room, -d.switch_plate_mm))


def _jig_holes(d: Dimensions, bottom: float) -> Solid:
    half_y = JIG_mm[1]
    made = block((-6, half_y - 6, bottom - 1), (6, half_y + 1, bottom + 6))
    socket = PEG_mm + 2 * d.fit_gap_mm + d.hole_excess_mm
    for x, y in POSTS_mm:
        made += rod("z", (x, y, -PEG_LENGTH_mm - 3), PEG_LENGTH_mm + 4, socket)
    for side in (-1, 1):
        made += rod("z", (side * 17.0, 0, -9), 10, d.m3_insert_mm)
    for x in (-12.0, 0.0, 12.0):
        made += rod("y", (x, -half_y - 1, -12), 6, d.led_diameter_mm + d.hole_excess_mm)
    return made


def marker_post(d: Dimensions) -> Solid:
    """Make a post at the origin: peg below, collar on the jig, a dish for the marker on top."""
    top, wide = d.post_height_mm, PEG_mm + 4
    made = rod("z", (0, 0, -PEG_LENGTH_mm), top + PEG_LENGTH_mm, PEG_mm)
    made += rod("z", (0, 0, 0), 2, wide) + cone((0, 0, 2), wide, PEG_mm, 2)
    return made - ball((0, 0, top + d.marker_diameter_mm / 4), d.marker_diameter_mm)


def black_box(d: Dimensions) -> Solid:
    """Make the box, open below: a hole for the hand at the front, a notch for cables at the back."""
    layout, wall = Layout(d), d.box_wall_mm
    (width, depth, height), (left, right) = layout.box_mm, layout.base_x_mm
    x, low = (left + right) / 2, -d.base_height_mm
    half_x, half_y, top = width / 2, depth / 2, low + height
    made = block(
        (x - half_x - wall, -half_y - wall, low), (x + half_x + wall, half_y + wall, top + wall), 8.0
    )
    made -= block((x - half_x, -half_y, low - 1), (x + half_x, half_y, top), 8.0 - wall)
    made -= prism("y", _hand(d), -half_y - wall - 1, -half_y + 1)
    made -= block((x - 20, half_y - 1, low - 1), (x + 20, half_y + wall + 1, low + 14))
    for at in (-30.0, 0.0, 30.0):
        made -= rod("y", (at, -half_y - wall - 1, layout.keycap_top_mm + 54), wall + 2, d.m3_clearance_mm)
    return made


def _hand(d: Dimensions) -> list[tuple[float, float]]:
    key, half = Layout(d).keycap_top_mm, d.box_hand_mm / 2
    flat = 10.0
    low = key - half
    return [
        (-flat, low),
        (flat, low),
        (half, low + half - flat),
        (half, key + 45),
        (-half, key + 45),
        (-half, low + half - flat),
    ]
