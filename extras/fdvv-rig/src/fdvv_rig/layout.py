"""Where everything stands, derived from the dimensions.

Frame of the rig: the axis of coil, bushing and sensor is x = y = 0; z is up, 0 on top of the base's plate;
the front, where the hand comes from, is -y; the limiter is at +x, the guide at -x. Heights of what moves hold
for the slider at travel 0, its highest place.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from fdvv_rig.dimensions import Dimensions


@dataclass(frozen=True)
class Layout:
    """Heights and distances that follow from dimensions, all in mm."""

    d: Dimensions

    adapter_floor_mm: ClassVar[float] = 4.0
    """Thickness of the adapter's floor, which two M2 screws hold."""
    foot_plate_mm: ClassVar[float] = 5.0
    """Thickness of the feet of tower and bracket, which screws hold on the base."""
    head_room_mm: ClassVar[float] = 2.2
    """How deep the heads of the yoke's screws are sunk."""
    ear_mm: ClassVar[float] = 7.25
    """How far the ears of the coil's clamp reach from the middle, along x."""

    @property
    def tower_bore_mm(self) -> float:
        """Get the diameter of the coil's pocket, as drawn."""
        return self.d.coil_diameter_mm + 2 * self.d.fit_gap_mm + self.d.hole_excess_mm

    @property
    def tower_radius_mm(self) -> float:
        """Get the outer radius of the tower about coil and sensor."""
        return self.tower_bore_mm / 2 + self.d.wall_mm

    @property
    def lvdt_top_mm(self) -> float:
        """Get the height of the sensor body's upper end."""
        return self.d.lvdt_length_mm - self.d.lvdt_sink_mm

    @property
    def floor_low_mm(self) -> float:
        """Get the height of the bushing's lower end: the coupling moves between sensor and it."""
        way_mm = self.d.travel_mm + 2 * self.d.overtravel_mm
        return self.lvdt_top_mm + way_mm + self.d.coupling_length_mm + 2 * self.d.free_gap_mm

    @property
    def floor_top_mm(self) -> float:
        """Get the height of the floor that the coil stands on."""
        return self.floor_low_mm + self.d.bushing_length_mm

    @property
    def coil_top_mm(self) -> float:
        """Get the height of the coil's upper face, and of the tower."""
        return self.floor_top_mm + self.d.coil_length_mm

    @property
    def coupling_top_mm(self) -> float:
        """Get the upper end of the coupling, at travel 0."""
        return self.floor_low_mm - self.d.free_gap_mm - self.d.overtravel_mm

    @property
    def rod_low_mm(self) -> float:
        """Get the lower end of the ground rod, at travel 0: in the middle of the coupling."""
        return self.coupling_top_mm - self.d.coupling_length_mm / 2

    @property
    def core_centre_mm(self) -> float:
        """Get the middle of the core at travel 0, so that half the travel is the sensor's null."""
        return self.lvdt_top_mm - self.d.lvdt_length_mm / 2 + self.d.travel_mm / 2

    @property
    def yoke_low_mm(self) -> float:
        """Get the lower face of the slider's yoke, at travel 0."""
        return self.coil_top_mm + self.d.travel_mm + self.d.overtravel_mm + self.d.free_gap_mm

    @property
    def yoke_top_mm(self) -> float:
        """Get the upper face of the yoke and end of the rod, at travel 0."""
        return self.yoke_low_mm + self.d.yoke_thickness_mm

    @property
    def rod_length_mm(self) -> float:
        """Get the length to which the ground rod is cut."""
        return self.yoke_top_mm - self.rod_low_mm

    @property
    def core_rod_length_mm(self) -> float:
        """Get the length of the brass rod that shows between core and ground rod."""
        return self.rod_low_mm - self.core_centre_mm - self.d.lvdt_core_length_mm / 2

    @property
    def body_width_mm(self) -> float:
        """Get the width of keycap adapter and yoke about the exciter."""
        return self.d.exciter_diameter_mm + self.d.hole_excess_mm + 2 * self.d.fit_gap_mm + 2 * 2.0

    @property
    def roof_low_mm(self) -> float:
        """Get the face that the exciter is glued to, at travel 0."""
        return self.yoke_top_mm + self.adapter_floor_mm + self.d.exciter_height_mm + self.d.free_gap_mm

    @property
    def stem_low_mm(self) -> float:
        """Get the foot of the keycap's stem, at travel 0."""
        return self.roof_low_mm + 2.5

    @property
    def keycap_top_mm(self) -> float:
        """Get the top of the keycap, at travel 0."""
        return self.stem_low_mm + 0.5 + self.d.keycap_height_mm

    @property
    def cell_seat_mm(self) -> float:
        """Get the face that the load cell lies on, at travel 0."""
        return self.yoke_top_mm + self.adapter_floor_mm

    @property
    def plate_low_mm(self) -> float:
        """Get the plate's underside, at travel 0: its dimple lies on the ball."""
        ball_mm = self.cell_seat_mm + self.d.cell_height_mm + self.d.cell_ball_out_mm
        return ball_mm - self.d.plate_dimple_mm

    @property
    def cell_bore_mm(self) -> float:
        """Get the diameter of the holder's bore about the cell: plate, and film beside it."""
        return self.d.plate_diameter_mm + 2 * self.d.film_gap_mm

    @property
    def tongue_out_mm(self) -> float:
        """Get the distance of the tongue's inner face from the axis."""
        return self.tower_radius_mm + 3.5 + 2 * self.d.slide_gap_mm

    @property
    def pin_height_mm(self) -> float:
        """Get the height of the screw that stops the tongue."""
        return self.coil_top_mm - 8.0

    @property
    def slot_mm(self) -> tuple[float, float]:
        """Get lower and upper end of the tongue's slot, at travel 0."""
        radius_mm = self.d.m3_clearance_mm / 2
        low_mm = self.pin_height_mm - radius_mm - self.d.overtravel_mm
        return low_mm, self.pin_height_mm + radius_mm + self.d.travel_mm + self.d.overtravel_mm

    @property
    def tongue_low_mm(self) -> float:
        """Get the lower end of the tongue, at travel 0."""
        return self.slot_mm[0] - 3.0

    @property
    def limiter_in_mm(self) -> float:
        """Get the distance of the limiter's arm from the axis, along x."""
        return self.tower_radius_mm + self.d.free_gap_mm

    @property
    def limiter_out_mm(self) -> float:
        """Get the limiter's face towards the servo."""
        return self.limiter_in_mm + self.d.limiter_thickness_mm

    @property
    def foot_low_mm(self) -> float:
        """Get the lowest line of the yoke's foot, at travel 0."""
        return self.yoke_low_mm - self.d.foot_length_mm

    @property
    def servo_axis_mm(self) -> float:
        """Get the height of the servo's shaft; the spiral reaches as far beyond either end of the travel."""
        rise_mm = self.d.limiter_large_mm - self.d.limiter_small_mm
        return self.foot_low_mm + (rise_mm - self.d.travel_mm) / 2 - self.d.limiter_large_mm

    @property
    def servo_bottom_mm(self) -> float:
        """Get the x of the servo body's bottom, furthest from the axis."""
        return self.limiter_out_mm + self.d.horn_seat_mm

    @property
    def bracket_in_mm(self) -> float:
        """Get the x of the bracket's inner face; the servo's ears lie on the outer one."""
        ear_mm = self.d.servo_ear_height_mm + self.d.servo_ear_thickness_mm
        return self.servo_bottom_mm - ear_mm - self.bracket_plate_mm

    @property
    def bracket_plate_mm(self) -> float:
        """Get the thickness of the plate behind the servo's ears; the body comes through it a little."""
        return self.d.servo_body_mm - self.d.servo_ear_height_mm - self.d.servo_ear_thickness_mm - 0.8

    @property
    def bracket_out_mm(self) -> float:
        """Get the x of the bracket's outer end."""
        return self.bracket_in_mm + 24.0

    @property
    def boards_x_mm(self) -> float:
        """Get the x of the middle of both boards."""
        return -(self.tower_radius_mm + 10.0 + self.d.driver_width_mm / 2)

    @property
    def boards_y_mm(self) -> tuple[float, float]:
        """Get the y of the middle of main board, at the back, and coil driver, at the front."""
        edge_mm = self.d.base_depth_mm / 2 - 3.0
        return edge_mm - self.d.board_length_mm / 2, self.d.driver_length_mm / 2 - edge_mm

    @property
    def lvdt_screw_mm(self) -> float:
        """Get how far the screws of the sensor's mount stand from the axis, along x."""
        return self.tower_bore_mm / 2 - self.d.float_mm - self.d.m3_pilot_mm

    @property
    def yoke_screw_mm(self) -> float:
        """Get how far the two screws between yoke and adapter stand from the axis, along x."""
        return self.body_width_mm / 2 - 3.0

    @property
    def flange_mm(self) -> float:
        """Get half the width of the tower's square flange."""
        return self.tower_radius_mm + 6.0

    @property
    def bracket_screws_mm(self) -> tuple[tuple[float, float], ...]:
        """Get where screws join bracket and base, x and y."""
        x_mm, y_mm = self.bracket_in_mm, self.d.servo_width_mm / 2 + 9.5
        return tuple((x_mm + along, side * y_mm) for along in (6.0, 18.0) for side in (-1, 1))

    @property
    def tower_screws_mm(self) -> tuple[tuple[float, float], ...]:
        """Get where screws join tower and base, x and y."""
        at_mm = self.flange_mm - 4.5
        return tuple((x * at_mm, y * at_mm) for x in (-1, 1) for y in (-1, 1))

    @property
    def servo_z_mm(self) -> tuple[float, float]:
        """Get lower and upper end of the servo's body without its ears."""
        top_mm = self.servo_axis_mm + self.d.servo_axis_mm
        return top_mm - self.d.servo_length_mm, top_mm

    @property
    def base_x_mm(self) -> tuple[float, float]:
        """Get both ends of the base along x."""
        left_mm = self.boards_x_mm - max(self.d.board_width_mm, self.d.driver_width_mm) / 2 - 4.0
        return left_mm, max(self.bracket_out_mm, self.servo_bottom_mm) + 4.0

    @property
    def box_mm(self) -> tuple[float, float, float]:
        """Get width, depth and height of the black box, inside."""
        left_mm, right_mm = self.base_x_mm
        room_mm = 2 * self.d.box_room_mm
        height_mm = self.d.base_height_mm + self.keycap_top_mm + self.d.box_above_mm
        return right_mm - left_mm + room_mm, self.d.base_depth_mm + room_mm, height_mm
