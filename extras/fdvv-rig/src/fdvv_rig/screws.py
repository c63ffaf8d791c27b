"""The rig's screws, as the room they take: thread and head."""

from __future__ import annotations

from collections.abc import Iterator

from fdvv_rig.dimensions import Dimensions
from fdvv_rig.envelope import Envelope, Rod
from fdvv_rig.layout import Layout
from fdvv_rig.placement import Moves, Row

M2_HEAD_mm = (3.8, 1.8)
"""Diameter and height."""

M3_HEAD_HEIGHT_mm = 3.0
WASHER_mm = (7.0, 0.5)
LENGTHS_mm = (8.0, 10.0, 12.0, 16.0)
TIP_mm = 0.4
"""What stays between the stop screw's tip and the coil's pocket."""


def screws(d: Dimensions) -> tuple[Envelope, ...]:
    """Return the screws of the rig at travel 0."""
    return (_pin(d), *_onto_base(d), _mount(d), _clamp(d), _yoke(d), _grub(d), _servo(d))


def _screw(
    axis: str, seat: Row, way: int, length_mm: float, thread_mm: float, head: tuple[float, float]
) -> tuple[Rod, Rod]:
    """Return thread and head of a screw: it goes from its seat along an axis, forwards (1) or backwards (-1).

    head : diameter and height.
    """
    place = "xyz".index(axis)

    def behind(by_mm: float) -> Row:
        x, y, z = (v - (by_mm if i == place else 0.0) for i, v in enumerate(seat))
        return x, y, z

    thread = Rod(axis, behind(0.0 if way > 0 else length_mm), length_mm, thread_mm)
    return thread, Rod(axis, behind(head[1] if way > 0 else 0.0), head[1], head[0])


def _m3(d: Dimensions) -> tuple[float, float]:
    return d.m3_head_mm, M3_HEAD_HEIGHT_mm


def _pin(d: Dimensions) -> Envelope:
    layout = Layout(d)
    seat = -(layout.tongue_out_mm + d.tongue_thickness_mm + 2 * d.slide_gap_mm)
    # the longest that one can buy and that does not reach the coil
    room_mm = -seat - layout.tower_bore_mm / 2 - TIP_mm
    length_mm = max((length for length in LENGTHS_mm if length <= room_mm), default=LENGTHS_mm[0])
    made = _screw("x", (seat, 0.0, layout.pin_height_mm), 1, length_mm, 3.0, _m3(d))
    title, enters = f"M3 × {length_mm:g} stop screw", frozenset({"coil-mount"})
    return Envelope("pin", title, Moves.FIXED, made, (), frozenset(), enters)


def _onto_base(d: Dimensions) -> Iterator[Envelope]:
    layout = Layout(d)
    for name, places, part in (
        ("tower-screws", layout.tower_screws_mm, "coil-mount"),
        ("bracket-screws", layout.bracket_screws_mm, "limiter-bracket"),
    ):
        four = [_screw("z", (x, y, layout.foot_plate_mm), -1, 10.0, 3.0, _m3(d)) for x, y in places]
        solids = tuple(rod for one in four for rod in one)
        holds = frozenset({"base", part})
        yield Envelope(name, "M3 × 10 screw", Moves.FIXED, solids, (), holds, count=len(places))


def _mount(d: Dimensions) -> Envelope:
    layout = Layout(d)
    solids: list[Rod] = []
    for side in (-1, 1):
        x, z = side * layout.lvdt_screw_mm, -d.base_plate_mm
        solids.append(Rod("z", (x, 0.0, z - WASHER_mm[1]), WASHER_mm[1], WASHER_mm[0]))
        solids += _screw("z", (x, 0.0, z - WASHER_mm[1]), 1, 12.0, 3.0, _m3(d))
    holds, enters = frozenset({"base"}), frozenset({"lvdt-mount"})
    return Envelope("mount-screws", "M3 × 12 screw, washer", Moves.FIXED, tuple(solids), (), holds, enters, 2)


def _clamp(d: Dimensions) -> Envelope:
    layout = Layout(d)
    seat = (-layout.ear_mm, -layout.tower_radius_mm - 4.5, layout.coil_top_mm - 5.5)
    made = _screw("x", seat, 1, 16.0, 3.0, _m3(d))
    return Envelope("clamp-screw", "M3 × 16 screw, nut", Moves.FIXED, made, (), frozenset({"coil-mount"}))


def _yoke(d: Dimensions) -> Envelope:
    layout = Layout(d)
    solids: list[Rod] = []
    for side in (-1, 1):
        seat = (side * layout.yoke_screw_mm, 0.0, layout.yoke_low_mm + layout.head_room_mm)
        solids += _screw("z", seat, 1, 8.0, 2.0, M2_HEAD_mm)
    holds, enters = frozenset({"slider-yoke"}), frozenset({"keycap-adapter", "cell-holder"})
    return Envelope("yoke-screws", "M2 × 8 screw", Moves.SLIDER, tuple(solids), (), holds, enters, 2)


def _grub(d: Dimensions) -> Envelope:
    layout = Layout(d)
    middle_mm = (layout.yoke_low_mm + layout.yoke_top_mm) / 2
    body = Rod("y", (0.0, d.rod_diameter_mm / 2 + 0.02, middle_mm), 6.0, 3.0)
    holds = frozenset({"slider-yoke", "rod"})
    return Envelope("grub", "M3 × 6 grub screw", Moves.SLIDER, (body,), (), holds)


def _servo(d: Dimensions) -> Envelope:
    layout = Layout(d)
    solids: list[Rod] = []
    low_mm, top_mm = layout.servo_z_mm
    x_mm = layout.servo_bottom_mm - d.servo_ear_height_mm
    for z in (low_mm - d.servo_screw_mm, top_mm + d.servo_screw_mm):
        solids += _screw("x", (x_mm, 0.0, z), -1, 8.0, 2.0, M2_HEAD_mm)
    enters = frozenset({"limiter-bracket", "servo"})
    return Envelope("servo-screws", "M2 × 8 screw", Moves.FIXED, tuple(solids), (), frozenset(), enters, 2)
