"""Every dimension of the rig, once, with what it means and where it comes from.

Bought parts are recalled from data sheets and sellers' pages; only the paper's own numbers are certain.
Measure what you bought and set what differs: everything printed follows.
"""

from __future__ import annotations

import hashlib
import json
import math
from dataclasses import asdict, dataclass, field, fields
from typing import Any

from fdvv.errors import InputError

PAPER = "paper"
"""Stated in the paper."""

CLASS = "assumed, measure yours"
"""Usual for parts of this class; not read from the data sheet of the very part."""

CHOSEN = "chosen"
"""A choice of this design."""


def _of(default: float, meaning: str, source: str) -> Any:
    return field(default=default, metadata={"meaning": meaning, "source": source})


@dataclass(frozen=True, kw_only=True)
class Dimensions:
    """The rig's dimensions in mm; angles and forces carry their own units.

    `meaning_of` and `source_of` tell of each. Raises InputError where a value is not a positive number;
    whether the parts fit each other is asked by `check_fits`.
    """

    # what the rig does
    travel_mm: float = _of(6.2, "usable travel of the slider", PAPER)
    finger_force_N: float = _of(20.0, "force of a hard press against the travel stop", CHOSEN)
    overtravel_mm: float = _of(0.4, "slider's way beyond its travel, at either end", CHOSEN)
    # voice coil and its rod (Moticont HVCM-025-022-003-01)
    coil_diameter_mm: float = _of(25.4, "coil housing, diameter", CLASS)
    coil_length_mm: float = _of(22.2, "coil housing, length", CLASS)
    coil_bore_mm: float = _of(3.1, "bore of the coil's own bearing around the rod", CLASS)
    rod_diameter_mm: float = _of(3.0, "ground rod through coil and bushing, diameter", CLASS)
    bushing_diameter_mm: float = _of(4.5, "plain bushing below the coil, outside", CLASS)
    bushing_bore_mm: float = _of(3.04, "plain bushing below the coil, inside", CLASS)
    bushing_length_mm: float = _of(5.0, "plain bushing below the coil, length", CLASS)
    # displacement sensor (LVDT MHR 250)
    lvdt_diameter_mm: float = _of(9.5, "sensor body, diameter", CLASS)
    lvdt_length_mm: float = _of(47.0, "sensor body, length", CLASS)
    lvdt_bore_mm: float = _of(3.2, "sensor body, bore for the core", CLASS)
    lvdt_core_diameter_mm: float = _of(2.8, "core, diameter", CLASS)
    lvdt_core_length_mm: float = _of(25.0, "core, length", CLASS)
    lvdt_range_mm: float = _of(12.7, "linear range of the sensor, end to end", CLASS)
    core_rod_diameter_mm: float = _of(1.8, "brass rod between core and coupling, diameter", CLASS)
    coupling_diameter_mm: float = _of(5.0, "sleeve that joins both rods, diameter", CLASS)
    coupling_length_mm: float = _of(8.0, "sleeve that joins both rods, length", CLASS)
    # servo (Tower Pro micro servo)
    servo_length_mm: float = _of(22.8, "servo body, length", CLASS)
    servo_width_mm: float = _of(12.2, "servo body, width", CLASS)
    servo_body_mm: float = _of(22.7, "servo body, height without its shaft", CLASS)
    servo_height_mm: float = _of(28.5, "servo, height with its shaft", CLASS)
    servo_ear_mm: float = _of(4.7, "ear beyond the body, at either end", CLASS)
    servo_ear_thickness_mm: float = _of(2.5, "ear, thickness", CLASS)
    servo_ear_height_mm: float = _of(15.9, "ear's lower face above the body's bottom", CLASS)
    servo_axis_mm: float = _of(5.9, "shaft from the body's near end", CLASS)
    servo_boss_mm: float = _of(11.6, "round boss about the shaft, diameter", CLASS)
    servo_screw_mm: float = _of(2.35, "ear's screw from the body's end", CLASS)
    servo_torque_kgf_cm: float = _of(1.8, "stall torque", PAPER)
    servo_play_deg: float = _of(1.0, "gear play and dead band together", CLASS)
    servo_sweep_deg: float = _of(150.0, "angle that lifts the stop through its range", CHOSEN)
    horn_length_mm: float = _of(14.0, "single-arm horn from its axis; cut it to this", CHOSEN)
    horn_width_mm: float = _of(5.6, "horn's arm, width at the hub", CLASS)
    horn_thickness_mm: float = _of(1.5, "horn's arm, thickness", CLASS)
    horn_hub_mm: float = _of(7.0, "horn's hub, diameter", CLASS)
    horn_seat_mm: float = _of(29.0, "horn's arm above the servo's bottom", CLASS)
    # what sits on the slider and beside it
    exciter_diameter_mm: float = _of(13.0, "exciter (Tectonic TEAX13C02-8/RH), diameter", CLASS)
    exciter_height_mm: float = _of(5.5, "exciter, height", CLASS)
    keycap_width_mm: float = _of(18.2, "keycap, width at its skirt", CLASS)
    keycap_height_mm: float = _of(9.5, "keycap, height", CLASS)
    stem_arm_mm: float = _of(4.0, "cross of an MX stem, length of its arms", CLASS)
    stem_along_mm: float = _of(1.15, "cross of an MX stem, thickness of the arm along x", CLASS)
    stem_across_mm: float = _of(1.3, "cross of an MX stem, thickness of the arm along y", CLASS)
    stem_height_mm: float = _of(3.6, "cross of an MX stem, height", CLASS)
    board_length_mm: float = _of(35.6, "main board (ItsyBitsy M0), length", CLASS)
    board_width_mm: float = _of(17.8, "main board, width", CLASS)
    driver_length_mm: float = _of(24.4, "coil driver board, length", CLASS)
    driver_width_mm: float = _of(20.4, "coil driver board, width", CLASS)
    spacer_mm: float = _of(5.0, "spacers under the boards, height", CHOSEN)
    # load cell in the cap, and its plate
    cell_length_mm: float = _of(8.5, "load cell (Honeywell FSS), body, front to back", CLASS)
    cell_width_mm: float = _of(5.6, "load cell, body, side to side", CLASS)
    cell_height_mm: float = _of(2.6, "load cell, body, height", CLASS)
    cell_ball_mm: float = _of(1.6, "load cell, ball that is pressed, diameter", CLASS)
    cell_ball_out_mm: float = _of(0.9, "load cell, ball above the body", CLASS)
    plate_diameter_mm: float = _of(12.0, "plate between finger and cell, diameter", CHOSEN)
    plate_thickness_mm: float = _of(2.0, "plate, thickness", CHOSEN)
    plate_dimple_mm: float = _of(0.3, "plate, depth of the dimple over the ball", CHOSEN)
    film_gap_mm: float = _of(1.0, "film between plate and rim, free width", CHOSEN)
    film_preload_mm: float = _of(0.1, "plate's underside above the rim, which strains the film", CHOSEN)
    # worn on the finger, and capture
    cone_bottom_mm: float = _of(12.0, "sensor cone, diameter at the sensor", PAPER)
    cone_top_mm: float = _of(5.0, "sensor cone, diameter at the button", PAPER)
    cone_height_mm: float = _of(5.0, "sensor cone, height", PAPER)
    sensor_ball_mm: float = _of(2.0, "ball of the force sensor (FSA class), diameter", CLASS)
    switch_hole_mm: float = _of(14.0, "square hole for an MX switch", CLASS)
    switch_plate_mm: float = _of(1.5, "plate that an MX switch clips into, thickness", CLASS)
    switch_depth_mm: float = _of(8.3, "MX switch with its pins, below the plate", CLASS)
    marker_diameter_mm: float = _of(6.4, "reflecting marker, diameter", CLASS)
    led_diameter_mm: float = _of(5.0, "infrared light of the clapperboard, diameter", CLASS)
    # printing and screws
    wall_mm: float = _of(4.0, "walls that carry force", CHOSEN)
    thin_wall_mm: float = _of(1.2, "thinnest wall that prints well: three lines of 0.4", CHOSEN)
    hole_excess_mm: float = _of(0.2, "printed holes come out this much too narrow in diameter", CLASS)
    slide_gap_mm: float = _of(0.25, "gap beside parts that slide, each side", CHOSEN)
    fit_gap_mm: float = _of(0.1, "gap about parts that are pushed in, each side", CHOSEN)
    free_gap_mm: float = _of(1.5, "gap between parts that must never touch", CHOSEN)
    print_error_mm: float = _of(0.15, "where a printed feature may stand, either way", CLASS)
    float_mm: float = _of(0.6, "how far the sensor's mount may be moved before it is tightened", CHOSEN)
    m3_clearance_mm: float = _of(3.4, "hole that an M3 screw passes", CHOSEN)
    m3_insert_mm: float = _of(4.0, "hole for an M3 heat-set insert", CLASS)
    m3_pilot_mm: float = _of(2.5, "hole that an M3 screw cuts its thread in", CHOSEN)
    m3_head_mm: float = _of(5.5, "head of an M3 screw, diameter", CLASS)
    m2_clearance_mm: float = _of(2.4, "hole that an M2 screw passes", CHOSEN)
    m2_pilot_mm: float = _of(1.6, "hole that an M2 screw cuts its thread in", CHOSEN)
    m2_head_mm: float = _of(4.2, "counterbore for the head of an M2 screw, diameter", CHOSEN)
    bed_width_mm: float = _of(220.0, "printer's bed, width and depth", CHOSEN)
    bed_height_mm: float = _of(250.0, "printer's room above the bed", CHOSEN)
    # printed parts
    base_plate_mm: float = _of(6.0, "base, thickness of its plate", CHOSEN)
    base_height_mm: float = _of(18.0, "base, height", CHOSEN)
    base_depth_mm: float = _of(76.0, "base, from front to back", CHOSEN)
    lvdt_sink_mm: float = _of(12.0, "sensor body, below the top of the base", CHOSEN)
    yoke_thickness_mm: float = _of(7.0, "slider yoke, thickness", CHOSEN)
    foot_radius_mm: float = _of(2.5, "rounding of the yoke's foot on the limiter", CHOSEN)
    foot_length_mm: float = _of(8.0, "yoke's foot, length", CHOSEN)
    tongue_width_mm: float = _of(8.0, "yoke's tongue in its guide, width", CHOSEN)
    tongue_thickness_mm: float = _of(4.0, "yoke's tongue, thickness", CHOSEN)
    limiter_small_mm: float = _of(10.0, "limiter's spiral, smallest radius", CHOSEN)
    limiter_large_mm: float = _of(17.0, "limiter's spiral, largest radius", CHOSEN)
    limiter_thickness_mm: float = _of(5.0, "limiter's arm, thickness", CHOSEN)
    post_height_mm: float = _of(35.0, "marker post, height above the jig", CHOSEN)
    box_wall_mm: float = _of(2.4, "black box, wall", CHOSEN)
    box_room_mm: float = _of(12.0, "black box, room about the rig, each side", CHOSEN)
    box_hand_mm: float = _of(90.0, "black box, width of the hole for the hand", CHOSEN)
    box_above_mm: float = _of(65.0, "black box, room above the keycap", CHOSEN)

    def __post_init__(self) -> None:
        """Refuse what is not a positive number."""
        for name, value in asdict(self).items():
            if not isinstance(value, float) or not math.isfinite(value) or value <= 0:
                raise InputError("dimensions", name, f"{value!r} is not a positive number", "correct it")

    def digest(self) -> str:
        """Return a fingerprint of all values, by which exported files know what they were made from."""
        text = json.dumps(asdict(self), sort_keys=True, separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()[:16]


NAMES = tuple(found.name for found in fields(Dimensions))


def meaning_of(name: str) -> str:
    """Return what a dimension means."""
    return str(_metadata(name)["meaning"])


def source_of(name: str) -> str:
    """Return where a dimension's default comes from: PAPER, CLASS or CHOSEN."""
    return str(_metadata(name)["source"])


def _metadata(name: str) -> Any:
    return next(found.metadata for found in fields(Dimensions) if found.name == name)
