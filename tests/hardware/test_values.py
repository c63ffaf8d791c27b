"""Filters, steps, power and settings follow from the parts; what is drawn and listed is the same circuit."""

from __future__ import annotations

import json
import math
import re
from collections import Counter
from dataclasses import replace
from pathlib import Path

import pytest
from tools import make_circuit

from fdvv.protocol.messages import CN64_PER_cN, UM16_PER_mm
from fdvv.protocol.tables import Settings
from fdvv.twin.files import load_rig
from fdvv_rig.bill import PAPER_USD, group_totals, load_bill, read_bill, summary
from fdvv_rig.circuit.circuit import Circuit
from fdvv_rig.circuit.current import cell_reading, current_drive
from fdvv_rig.circuit.filters import converter_steps, filter_values, paper_cutoff_Hz, rig_settings
from fdvv_rig.circuit.netlist import to_document, to_kicad, wiring_rows
from fdvv_rig.circuit.power import coil_drive
from fdvv_rig.parts import PARTS, part_named
from tests.hardware.circuits import CIRCUIT, RECOMMENDED, with_value

ROOT = Path(__file__).resolve().parents[2]


def test_the_papers_parts_make_478_and_neither_500_nor_498() -> None:
    assert paper_cutoff_Hz() == pytest.approx(477.9, abs=0.1)
    force = next(f for f in filter_values(CIRCUIT) if f.name == "force")
    assert force.cutoff_Hz == pytest.approx(1 / (2 * math.pi * 332 * 1e-6), rel=5e-3)
    assert force.paper_Hz == (500.0, 498.0)
    assert all(force.lowest_Hz < value < force.highest_Hz for value in force.paper_Hz)


def test_a_first_order_filter_turns_45_degrees_and_loses_3_dB_at_its_cut_off() -> None:
    farad = 1 / (2 * math.pi * 239.0 * filter_values(CIRCUIT)[0].ohm)
    found = filter_values(with_value("C3", farad))[0]
    assert found.snap_deg == pytest.approx(-45, abs=0.01)
    assert found.snap_dB == pytest.approx(-3.0103, abs=1e-3)
    assert found.lag_um == pytest.approx(200 * found.time_ms)


def test_steps_of_the_converter_are_the_ranges_over_its_counts() -> None:
    steps = {s.name: s for s in converter_steps(CIRCUIT)}
    assert steps["position"].volts_mV == pytest.approx(3300 / 4096)
    assert steps["position"].value == pytest.approx(12700 / 4096, rel=0.01)
    assert steps["force"].value == pytest.approx(981 / (0.9 * 4096), rel=0.01)
    assert steps["supply"].value == pytest.approx(3300 / 4096 * 122 / 22, rel=1e-3)


def test_the_settings_that_follow_give_millimetres_and_centinewtons_back() -> None:
    found = rig_settings(CIRCUIT, 25)
    span_mm = 25 * 4096 * found["position_gain_q14"] / 2**14 / UM16_PER_mm
    assert span_mm * converter_steps(CIRCUIT)[0].value == pytest.approx(12.7 * 3.1, rel=0.02)
    full = 0.95 * 4096 * 0.997
    way = (full - found["force_offset_counts"]) * found["force_gain_q14"] / 2**14 / CN64_PER_cN
    assert way == pytest.approx(981, rel=0.01)
    assert -found["position_offset_um16"] / UM16_PER_mm == pytest.approx(6.35)


def test_the_coil_is_reckoned_as_the_firmwares_settings_are() -> None:
    drive, settings = coil_drive(CIRCUIT, Settings()), Settings()
    assert round(drive.full_duty_rise_K) == settings.full_duty_rise_K
    assert drive.rise_K < settings.derate_start_K
    duty = settings.force_limit_cN64 * settings.duty_gain_q16 / 2**16 / 2**15
    bridge_ohm = 0.2  # that of the default settings, of the coil's own 2.9
    assert duty * 12 / (2.9 + bridge_ohm) == pytest.approx(drive.current_A, rel=0.08)
    assert drive.current_A < drive.chop_A < 3.6
    assert drive.heat_W == pytest.approx(drive.current_A**2 * 2.9)


def test_the_ripple_is_that_of_a_simulated_coil() -> None:
    drive, ohm, henry = coil_drive(CIRCUIT, Settings()), 2.9, 1.5e-3
    for pwm_Hz, ripple in ((23437.5, drive.ripple_A), (48e6 / 2**16, drive.default_ripple_cN / 390)):
        amps, seen, step = 2.0, [], 1 / pwm_Hz / 2000
        for i in range(2000 * 30):
            amps += step * ((12.0 if i % 2000 < 1000 else 0.0) - ohm * amps) / henry
            seen.append(amps)
        last = seen[-2000:]
        assert max(last) - min(last) == pytest.approx(ripple, rel=0.01)


def test_the_committed_drawings_netlists_and_pages_are_those_of_the_circuit() -> None:
    pytest.importorskip("schemdraw")
    for path, text in make_circuit.files().items():
        assert path.read_text() == text, f"run python tools/make_circuit.py: {path.name}"
    for folder in make_circuit.FOLDERS.values():
        made = {path.name for path in make_circuit.files() if path.parent == folder}
        assert {path.name for path in folder.iterdir()} == made


@pytest.mark.parametrize(
    ("circuit", "folder"), [(CIRCUIT, "circuit"), (RECOMMENDED, "circuit-recommended")], ids=["paper", "cell"]
)
def test_every_part_and_value_stands_in_a_drawing(circuit: Circuit, folder: str) -> None:
    drawn = " ".join(path.read_text() for path in (ROOT / "hardware" / folder).glob("*.svg"))
    drawn = " ".join(re.sub(r"<[^>]*>", " ", drawn).split())
    for part in circuit.parts.values():
        assert re.search(rf"\b{part.ref}\b", drawn), part.ref
        assert part.text in drawn


def _lists(text: str) -> list[object]:
    """Read s-expressions."""
    stack: list[list[object]] = [[]]
    for token in re.findall(r'\(|\)|"[^"]*"|[^\s()]+', text):
        if token == "(":
            stack.append([])
        elif token == ")":
            done = stack.pop()
            stack[-1].append(done)
        else:
            stack[-1].append(token.strip('"'))
    assert len(stack) == 1
    return stack[0]


def test_the_kicad_netlist_holds_every_part_and_every_connection() -> None:
    export = _lists(to_kicad(CIRCUIT))[0]
    assert isinstance(export, list)
    sections = {part[0]: part[1:] for part in export[1:] if isinstance(part, list)}
    refs = {comp[1][1] for comp in sections["components"]}
    assert refs == set(CIRCUIT.parts)
    nets = {net[2][1]: tuple(f"{node[1][1]}.{node[2][1]}" for node in net[3:]) for net in sections["nets"]}
    assert nets == CIRCUIT.nets


def test_the_json_netlist_holds_the_same() -> None:
    document = json.loads(json.dumps(to_document(CIRCUIT)))
    assert {net["name"]: tuple(net["pins"]) for net in document["nets"]} == CIRCUIT.nets
    assert [part["ref"] for part in document["parts"]] == list(CIRCUIT.parts)


def test_the_wires_join_what_the_nets_join_and_nothing_else() -> None:
    joined: dict[str, set[str]] = {}
    for a, b, net in wiring_rows(CIRCUIT):
        joined.setdefault(net, set()).update(end.split(" ")[0].split(",")[0] for end in (a, b))
    stars = {net: pins - {net} for net, pins in joined.items()}
    assert stars == {net: set(pins) for net, pins in CIRCUIT.nets.items()}


@pytest.mark.parametrize(
    ("circuit", "rig", "beside"),
    [(CIRCUIT, "paper", set()), (RECOMMENDED, "recommended", {"film", "heat sink"})],
    ids=["paper", "cell"],
)
def test_the_bill_and_the_circuit_name_the_same_parts_in_the_same_numbers(
    circuit: Circuit, rig: str, beside: set[str]
) -> None:
    needed = Counter(part.bill for part in circuit.parts.values())
    lines = {line.role: line.count for line in load_bill(circuit).lines}
    assert {role: lines[role] for role in needed} == needed
    printed = {line.role: line.count for line in load_bill(circuit).lines if line.maker == "printed"}
    assert printed == {part.name: part.count for part in PARTS if part.rig in ("", rig)}
    assert set(lines) - set(needed) - set(printed) == {"board and wire", "screws"} | beside


def test_the_total_is_the_sum_of_its_lines_and_tells_of_estimates() -> None:
    bill = load_bill(CIRCUIT)
    assert bill.total_USD == pytest.approx(sum(line.packs * (line.price_USD or 0) for line in bill.lines))
    assert sum(group_totals(bill).values()) == pytest.approx(bill.total_USD)
    assert all(line.estimated and line.priced.year >= 2026 for line in bill.lines)
    assert group_totals(bill)["rig"] > 0.5 * PAPER_USD


def test_a_price_that_nobody_knows_is_asked_for_and_not_counted() -> None:
    bill = load_bill(RECOMMENDED)
    asked = [line for line in bill.lines if line.asked]
    assert {"load cell", "power amplifier", "controller M4"} <= {line.role for line in asked}
    assert all(line.total_USD == 0 and not line.estimated for line in asked)
    assert f"and {len(asked)} lines without a price" in summary(bill)


def test_the_current_loop_is_the_one_that_the_recommended_rig_of_the_twin_has() -> None:
    drive, coil = current_drive(RECOMMENDED, Settings()), load_rig("recommended").coil
    assert drive.loop_us == pytest.approx(1e6 * coil.current_loop_s, rel=0.02)
    assert drive.zero_Hz == pytest.approx(drive.coil_Hz, rel=0.05)
    assert drive.current_A < drive.full_A < drive.limit_A < 3.0
    # its converter is finer than the twin's command
    assert (
        drive.step_cN
        < 100 * coil.force_constant_N_A * coil.supply_V / coil.resistance_ohm / 2**coil.command_bits
    )


def test_the_settings_of_the_current_drive_give_the_force_that_is_asked_for() -> None:
    found, drive = rig_settings(RECOMMENDED, 25), current_drive(RECOMMENDED, Settings())
    duty = 100 * CN64_PER_cN * found["duty_gain_q16"] / 2**16 / 2**15  # of 1 N
    assert duty * drive.reach_A * 3.9 == pytest.approx(1.0, rel=1e-3)
    assert replace(Settings(), **found).duty_gain_q16 == found["duty_gain_q16"], "the firmware can hold them"


def test_the_current_of_a_simulated_coil_follows_a_step_with_the_time_constant_that_is_stated() -> None:
    # the circuit's own amplifiers as equations: error amplifier, bridge, coil, shunt
    value = {ref: part.value or 0.0 for ref, part in RECOMMENDED.parts.items()}
    sense_V_A, gain, henry = 50 * value["R41"], 2 * value["R34"] / value["R33"], 1e-3
    amps, stored_V, step_s, command_V = 0.0, 0.0, 1e-8, 0.1
    drive = current_drive(RECOMMENDED, Settings())
    for _ in range(round(1e-6 * drive.loop_us / step_s)):
        into = (command_V - sense_V_A * amps) / value["R42"]
        volts = gain * (value["R44"] * into + stored_V)
        stored_V += step_s * into / value["C20"]
        amps += step_s * (volts - value["L1"] * amps) / henry
    assert amps * sense_V_A / command_V == pytest.approx(1 - math.exp(-1), abs=0.02)


def test_the_cells_range_step_and_filter_are_those_of_the_recommended_rig() -> None:
    cell, fitted = cell_reading(RECOMMENDED), load_rig("recommended").load_cell
    assert cell.cutoff_Hz == pytest.approx(fitted.bandwidth_Hz, rel=0.03)
    assert cell.high_cN - cell.null_cN > 100 * fitted.full_scale_N
    assert cell.step_cN == pytest.approx(200 * fitted.full_scale_N / 2**fitted.converter_bits, rel=0.03)
    assert cell.noise_cN < 100 * fitted.noise_ratio * fitted.full_scale_N
    assert cell.low_cN + cell.null_cN < 0


def test_printed_parts_are_paid_by_their_mass() -> None:
    base = part_named("base")
    one, three = (load_bill(CIRCUIT, [replace(base, count=count)]) for count in (1, 3))
    assert three.total_USD - one.total_USD == pytest.approx(2 * base.mass_g * 0.03, abs=0.02)
    assert [line.role for line in three.lines if line.maker == "printed"] == ["base"]


def test_a_role_that_the_bill_lacks_and_one_that_the_circuit_lacks_are_refused() -> None:
    line = '[[lines]]\nrole = "screw"\ngroup = "rig"\nmaker = "m"\npart_number = "p"\n'
    line += "price_USD = 1\npriced = 2026-11-01\n"
    assert read_bill(line, {"screw": 5}).lines[0].count == 5
    with pytest.raises(Exception, match="is not in the circuit"):
        read_bill(line, {})
    with pytest.raises(Exception, match="the circuit needs nut"):
        read_bill(line, {"screw": 1, "nut": 2})
