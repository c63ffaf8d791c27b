"""The bought parts that the rig is built about, as the room they take."""

from __future__ import annotations

from fdvv_rig.dimensions import Dimensions
from fdvv_rig.envelope import Block, Envelope, Rod
from fdvv_rig.layout import Layout
from fdvv_rig.placement import Moves
from fdvv_rig.screws import screws


def bought_parts(d: Dimensions) -> tuple[Envelope, ...]:
    """Return the bought parts of the rig at travel 0, the limiter's angle 0."""
    return (
        _coil(d),
        _bushing(d),
        _rod(d),
        _coupling(d),
        _core(d),
        _lvdt(d),
        _servo(d),
        _horn(d),
        _exciter(d),
        _keycap(d),
        *_boards(d),
        *screws(d),
    )


def _coil(d: Dimensions) -> Envelope:
    at = (0.0, 0.0, Layout(d).floor_top_mm)
    body = Rod("z", at, d.coil_length_mm, d.coil_diameter_mm, d.coil_bore_mm)
    return Envelope("coil", "voice coil", Moves.FIXED, (body,), (), frozenset({"coil-mount"}))


def _bushing(d: Dimensions) -> Envelope:
    at = (0.0, 0.0, Layout(d).floor_low_mm)
    body = Rod("z", at, d.bushing_length_mm, d.bushing_diameter_mm, d.bushing_bore_mm)
    return Envelope("bushing", "plain bushing", Moves.FIXED, (body,), (), frozenset({"coil-mount", "coil"}))


def _rod(d: Dimensions) -> Envelope:
    layout = Layout(d)
    body = Rod("z", (0.0, 0.0, layout.rod_low_mm), layout.rod_length_mm, d.rod_diameter_mm)
    holds = frozenset({"slider-yoke", "keycap-adapter", "coil", "bushing"})
    return Envelope("rod", "ground rod", Moves.SLIDER, (body,), (), holds)


def _coupling(d: Dimensions) -> Envelope:
    low_mm = Layout(d).coupling_top_mm - d.coupling_length_mm
    body = Rod("z", (0.0, 0.0, low_mm), d.coupling_length_mm, d.coupling_diameter_mm)
    enters = frozenset({"rod", "core"})
    return Envelope("coupling", "coupling sleeve", Moves.SLIDER, (body,), (), frozenset(), enters)


def _core(d: Dimensions) -> Envelope:
    layout = Layout(d)
    low_mm = layout.core_centre_mm - d.lvdt_core_length_mm / 2
    core = Rod("z", (0.0, 0.0, low_mm), d.lvdt_core_length_mm, d.lvdt_core_diameter_mm)
    top_mm = low_mm + d.lvdt_core_length_mm
    rod = Rod("z", (0.0, 0.0, top_mm), layout.core_rod_length_mm, d.core_rod_diameter_mm)
    return Envelope("core", "sensor core on its rod", Moves.SLIDER, (core, rod), (), frozenset({"rod"}))


def _lvdt(d: Dimensions) -> Envelope:
    body = Rod("z", (0.0, 0.0, -d.lvdt_sink_mm), d.lvdt_length_mm, d.lvdt_diameter_mm, d.lvdt_bore_mm)
    return Envelope("lvdt", "displacement sensor", Moves.FIXED, (body,), (), frozenset({"lvdt-mount"}))


def _servo(d: Dimensions) -> Envelope:
    layout = Layout(d)
    bottom_mm, z_mm = layout.servo_bottom_mm, layout.servo_axis_mm
    half_mm, top_mm = d.servo_width_mm / 2, z_mm + d.servo_axis_mm
    low_mm = top_mm - d.servo_length_mm
    body = Block((bottom_mm - d.servo_body_mm, -half_mm, low_mm), (bottom_mm, half_mm, top_mm))
    ear_mm = bottom_mm - d.servo_ear_height_mm
    ears = Block(
        (ear_mm - d.servo_ear_thickness_mm, -half_mm, low_mm - d.servo_ear_mm),
        (ear_mm, half_mm, top_mm + d.servo_ear_mm),
    )
    shaft_mm = d.servo_height_mm - d.servo_body_mm
    boss = Rod("x", (bottom_mm - d.servo_body_mm - 3.5, 0.0, z_mm), 3.5, d.servo_boss_mm)
    shaft = Rod("x", (bottom_mm - d.servo_body_mm - shaft_mm, 0.0, z_mm), shaft_mm, 4.8)
    holds, enters = frozenset({"limiter-bracket"}), frozenset({"horn"})
    return Envelope("servo", "micro servo", Moves.FIXED, (body, ears, boss, shaft), (), holds, enters)


def _horn(d: Dimensions) -> Envelope:
    layout = Layout(d)
    out_mm, z_mm = layout.limiter_out_mm, layout.servo_axis_mm
    hub = Rod("x", (out_mm - d.horn_thickness_mm, 0.0, z_mm), d.horn_thickness_mm + 2.5, d.horn_hub_mm)
    return Envelope("horn", "servo horn", Moves.LIMITER, (hub,), (), frozenset({"limiter-arm"}))


def _exciter(d: Dimensions) -> Envelope:
    low_mm = Layout(d).roof_low_mm - d.exciter_height_mm
    body = Rod("z", (0.0, 0.0, low_mm), d.exciter_height_mm, d.exciter_diameter_mm)
    return Envelope("exciter", "exciter", Moves.SLIDER, (body,), (), frozenset({"keycap-adapter"}))


def _keycap(d: Dimensions) -> Envelope:
    layout = Layout(d)
    half_mm, low_mm, high_mm = d.keycap_width_mm / 2, layout.stem_low_mm + 0.5, layout.keycap_top_mm
    body = Block((-half_mm, -half_mm, low_mm), (half_mm, half_mm, high_mm))
    inner_mm = half_mm - 1.5
    hollow = Block((-inner_mm, -inner_mm, low_mm - 1.0), (inner_mm, inner_mm, high_mm - 2.0))
    return Envelope("keycap", "MX keycap", Moves.SLIDER, (body,), (hollow,), frozenset({"keycap-adapter"}))


def _boards(d: Dimensions) -> tuple[Envelope, Envelope]:
    x_mm, low_mm = Layout(d).boards_x_mm, d.spacer_mm
    made = []
    for name, title, width_mm, length_mm, y_mm in (
        ("main-board", "main board", d.board_width_mm, d.board_length_mm, Layout(d).boards_y_mm[0]),
        ("driver-board", "coil driver", d.driver_width_mm, d.driver_length_mm, Layout(d).boards_y_mm[1]),
    ):
        low = (x_mm - width_mm / 2, y_mm - length_mm / 2, low_mm)
        block = Block(low, (x_mm + width_mm / 2, y_mm + length_mm / 2, low_mm + 6.0))
        made.append(Envelope(name, title, Moves.FIXED, (block,)))
    return made[0], made[1]
