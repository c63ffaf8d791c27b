"""The bought parts that the rig is built about, as the room they take."""

from __future__ import annotations

from collections.abc import Iterator

from fdvv_rig.dimensions import Dimensions
from fdvv_rig.envelope import Block, Envelope, Rod
from fdvv_rig.layout import Layout
from fdvv_rig.placement import Moves
from fdvv_rig.screws import screws


def bought_parts(d: Dimensions, cell: bool = False) -> tuple[Envelope, ...]:
    """Return the bought parts of the rig at travel 0, the limiter's angle 0.

    cell : of the rig with a load cell, else of the paper's, with exciter and keycap.
    """
    head = (_cell(d),) if cell else (_exciter(d), _keycap(d))
    return (*_on_axis(d), _servo(d), _horn(d), *head, *_boards(d), *screws(d))


def _on_axis(d: Dimensions) -> Iterator[Envelope]:
    """Yield what stands about the rig's axis, from the coil down to the sensor."""
    at = Layout(d)
    coil = _rod(at.floor_top_mm, d.coil_length_mm, d.coil_diameter_mm, d.coil_bore_mm)
    bushing = _rod(at.floor_low_mm, d.bushing_length_mm, d.bushing_diameter_mm, d.bushing_bore_mm)
    rod = _rod(at.rod_low_mm, at.rod_length_mm, d.rod_diameter_mm)
    coupling_low_mm = at.coupling_top_mm - d.coupling_length_mm
    coupling = _rod(coupling_low_mm, d.coupling_length_mm, d.coupling_diameter_mm)
    core_low_mm = at.core_centre_mm - d.lvdt_core_length_mm / 2
    core = _rod(core_low_mm, d.lvdt_core_length_mm, d.lvdt_core_diameter_mm)
    core_rod = _rod(core_low_mm + d.lvdt_core_length_mm, at.core_rod_length_mm, d.core_rod_diameter_mm)
    lvdt = _rod(-d.lvdt_sink_mm, d.lvdt_length_mm, d.lvdt_diameter_mm, d.lvdt_bore_mm)
    beside_rod = frozenset({"slider-yoke", "keycap-adapter", "coil", "bushing"})
    beside_bushing, joined = frozenset({"coil-mount", "coil"}), frozenset({"rod", "core"})
    yield Envelope("coil", "voice coil", Moves.FIXED, (coil,), holds=frozenset({"coil-mount"}))
    yield Envelope("bushing", "plain bushing", Moves.FIXED, (bushing,), holds=beside_bushing)
    yield Envelope("rod", "ground rod", Moves.SLIDER, (rod,), holds=beside_rod)
    yield Envelope("coupling", "coupling sleeve", Moves.SLIDER, (coupling,), enters=joined)
    yield Envelope("core", "sensor core on its rod", Moves.SLIDER, (core, core_rod), holds=frozenset({"rod"}))
    yield Envelope("lvdt", "displacement sensor", Moves.FIXED, (lvdt,), holds=frozenset({"lvdt-mount"}))


def _rod(low_mm: float, length_mm: float, diameter_mm: float, bore_mm: float = 0.0) -> Rod:
    return Rod("z", (0.0, 0.0, low_mm), length_mm, diameter_mm, bore_mm)


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
    body = _rod(low_mm, d.exciter_height_mm, d.exciter_diameter_mm)
    return Envelope("exciter", "exciter", Moves.SLIDER, (body,), (), frozenset({"keycap-adapter"}))


def _cell(d: Dimensions) -> Envelope:
    low_mm, x_mm, y_mm = Layout(d).cell_seat_mm, d.cell_width_mm / 2, d.cell_length_mm / 2
    body = Block((-x_mm, -y_mm, low_mm), (x_mm, y_mm, low_mm + d.cell_height_mm))
    ball = Rod("z", (0.0, 0.0, body.high_mm[2]), d.cell_ball_out_mm - d.plate_dimple_mm, d.cell_ball_mm)
    return Envelope(
        "cell", "load cell", Moves.SLIDER, (body, ball), (), frozenset({"cell-holder", "cell-plate"})
    )


def _keycap(d: Dimensions) -> Envelope:
    layout = Layout(d)
    half_mm, low_mm, high_mm = d.keycap_width_mm / 2, layout.stem_low_mm + 0.5, layout.keycap_top_mm
    body = Block((-half_mm, -half_mm, low_mm), (half_mm, half_mm, high_mm))
    inner_mm = half_mm - 1.5
    hollow = Block((-inner_mm, -inner_mm, low_mm - 1.0), (inner_mm, inner_mm, high_mm - 2.0))
    return Envelope("keycap", "MX keycap", Moves.SLIDER, (body,), (hollow,), frozenset({"keycap-adapter"}))


def _boards(d: Dimensions) -> Iterator[Envelope]:
    x_mm, low_mm = Layout(d).boards_x_mm, d.spacer_mm
    for name, title, width_mm, length_mm, y_mm in (
        ("main-board", "main board", d.board_width_mm, d.board_length_mm, Layout(d).boards_y_mm[0]),
        ("driver-board", "coil driver", d.driver_width_mm, d.driver_length_mm, Layout(d).boards_y_mm[1]),
    ):
        low = (x_mm - width_mm / 2, y_mm - length_mm / 2, low_mm)
        block = Block(low, (x_mm + width_mm / 2, y_mm + length_mm / 2, low_mm + 6.0))
        yield Envelope(name, title, Moves.FIXED, (block,))
