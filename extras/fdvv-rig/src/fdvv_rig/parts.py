"""The printed parts: what each is for, how it is printed, and what it weighs once printed."""

from __future__ import annotations

import json
from dataclasses import dataclass
from functools import cache
from importlib import resources

DENSITY_g_cm3 = 1.24
"""PLA; PETG and ABS differ by a tenth."""

SHELL_mm = 1.2
"""Three lines about every face, which is what the parts are drawn for."""

INFILL_ratio = 0.25
FLOW_mm3_s = 5.0
"""What a hobby printer lays down on average, corners and travels counted; an estimate."""


@dataclass(frozen=True)
class Part:
    """A printed part.

    Attributes
    ----------
    name : its name in files and bills; title : for people; use : what it does.
    lies : how it lies on the bed; drawn : the dimensions that its drawing tells with their meaning.
    count : how many a rig needs; material : what it is printed of.
    rig : which one needs it, "" for every rig.
    """

    name: str
    title: str
    use: str
    lies: str
    drawn: tuple[str, ...]
    count: int = 1
    material: str = "PLA or PETG"
    rig: str = ""

    @property
    def made(self) -> Made:
        """Get what the exported part of the default dimensions measures."""
        return _made()[self.name]

    @property
    def mass_g(self) -> float:
        """Estimate the mass of one, printed with three lines and a quarter of infill, in g."""
        return DENSITY_g_cm3 * self.made.printed_cm3

    @property
    def print_h(self) -> float:
        """Estimate the time to print one, in hours."""
        return self.made.printed_cm3 * 1e3 / FLOW_mm3_s / 3600


@dataclass(frozen=True)
class Made:
    """What an exported part measures."""

    volume_cm3: float
    area_cm2: float
    box_mm: tuple[float, float, float]

    @property
    def printed_cm3(self) -> float:
        """Estimate the plastic in it: a shell about every face, infill within."""
        shell_cm3 = min(self.volume_cm3, self.area_cm2 * SHELL_mm / 10)
        return shell_cm3 + INFILL_ratio * (self.volume_cm3 - shell_cm3)


PARTS = (
    Part(
        "base",
        "Base",
        "Carries tower, sensor, limiter and boards; the sensor's leads leave below it.",
        "upside down, its plate on the bed",
        ("base_plate_mm", "base_height_mm", "base_depth_mm", "m3_insert_mm"),
    ),
    Part(
        "coil-mount",
        "Coil mount",
        "The tower: clamps the coil, seats the bushing in the same bore, guides the yoke's tongue.",
        "upright; the cone under its floor needs no support",
        ("coil_diameter_mm", "coil_length_mm", "bushing_diameter_mm", "wall_mm"),
    ),
    Part(
        "lvdt-mount",
        "LVDT mount",
        "Clamps the displacement sensor; is moved until the core runs free, then tightened from below.",
        "upright",
        ("lvdt_diameter_mm", "float_mm"),
    ),
    Part(
        "slider-yoke",
        "Slider yoke",
        "Sits on the rod's end; its foot meets the limiter, its tongue keeps it from turning.",
        "upside down, its upper face on the bed",
        ("rod_diameter_mm", "yoke_thickness_mm", "tongue_width_mm", "foot_radius_mm"),
    ),
    Part(
        "keycap-adapter",
        "Keycap adapter",
        "Holds the exciter on the axis and an MX keycap above it; two screws join it to the yoke.",
        "upright; its roof is a bridge between three walls",
        ("exciter_diameter_mm", "exciter_height_mm", "stem_arm_mm", "stem_height_mm"),
        rig="paper",
    ),
    Part(
        "cell-holder",
        "Cell holder",
        "Recommended rig: holds the load cell on the axis; on its rim lies the film that guides the plate.",
        "upright",
        ("cell_length_mm", "cell_width_mm", "cell_height_mm", "film_gap_mm"),
        rig="recommended",
    ),
    Part(
        "cell-plate",
        "Cell plate",
        "Recommended rig: what the finger presses; its dimple lies on the load cell's ball.",
        "upside down, the finger's face on the bed",
        ("plate_diameter_mm", "plate_thickness_mm", "plate_dimple_mm", "cell_ball_mm"),
        material="PLA, solid",
        rig="recommended",
    ),
    Part(
        "limiter-arm",
        "Limiter arm",
        "A spiral on the servo's horn: its angle sets how deep the slider can go.",
        "flat, the pocket for the horn up",
        ("limiter_small_mm", "limiter_large_mm", "limiter_thickness_mm", "horn_length_mm"),
    ),
    Part(
        "limiter-bracket",
        "Limiter bracket",
        "Holds the servo beside the tower.",
        "on the face that looks at the tower",
        ("servo_length_mm", "servo_width_mm", "servo_ear_mm"),
    ),
    Part(
        "sensor-cone",
        "Sensor cone",
        "Sits on the force sensor of the finger and meets the keycap with its small face.",
        "its large face on the bed",
        ("cone_bottom_mm", "cone_top_mm", "cone_height_mm"),
        material="ABS, solid",
    ),
    Part(
        "capture-jig",
        "Capture jig",
        "Holds a keyboard switch, reference markers and the three lights of the clapperboard.",
        "upside down, its plate on the bed",
        ("switch_hole_mm", "switch_plate_mm", "led_diameter_mm"),
    ),
    Part(
        "marker-post",
        "Marker post",
        "Carries a reference marker on the jig.",
        "upside down, the end for the marker on the bed",
        ("post_height_mm", "marker_diameter_mm"),
        count=3,
    ),
    Part(
        "black-box",
        "Black box",
        "Hides the rig in blind studies; a hole for the hand, a notch for cables.",
        "upside down, its roof on the bed",
        ("box_wall_mm", "box_hand_mm", "box_above_mm"),
        material="black PLA or PETG",
    ),
)


def part_named(name: str) -> Part:
    """Return one printed part; masses and times hold for the default dimensions. KeyError."""
    return {part.name: part for part in PARTS}[name]


@cache
def _made() -> dict[str, Made]:
    """Read what the default parts measured when they were exported."""
    text = resources.files("fdvv_rig").joinpath("printed.json").read_text(encoding="utf-8")
    return {
        name: Made(found["volume_cm3"], found["area_cm2"], tuple(found["box_mm"]))
        for name, found in json.loads(text)["parts"].items()
    }
