"""The circuit works, its rules catch what would not, and its pins are those of the firmware."""

from __future__ import annotations

import re
from pathlib import Path

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from fdvv.errors import InputError
from fdvv_rig.circuit.circuit import Circuit, load_circuit, read_circuit
from fdvv_rig.circuit.levels import PowerState, levels
from fdvv_rig.circuit.power import power_budget
from fdvv_rig.circuit.rules import check_circuit, require_sound, undrawn
from tests.hardware.circuits import BOTH, CIRCUIT, RECOMMENDED, with_nets, with_pin, with_value, without

BOARDS = Path(__file__).resolve().parents[2] / "firmware" / "boards"
RESISTORS = sorted(ref for ref, part in CIRCUIT.parts.items() if part.kind.name == "resistor")
OUTPUTS = sorted(name for name in CIRCUIT.net_of if CIRCUIT.pin(name).type == "output")


def rules(circuit: object) -> set[str]:
    return {one.rule for one in check_circuit(circuit)}  # type: ignore[arg-type]


@pytest.mark.parametrize("circuit", BOTH, ids=["paper", "cell"])
def test_every_rule_holds_for_a_rigs_own_circuit_and_every_part_is_drawn(circuit: Circuit) -> None:
    assert check_circuit(circuit) == ()
    assert undrawn(circuit) == []
    require_sound(circuit, "circuit.toml")


def test_a_change_of_a_circuit_replaces_what_it_names_and_leaves_the_rest() -> None:
    assert RECOMMENDED.nets["EXC1"] == CIRCUIT.nets["EXC1"]
    assert "U9" not in RECOMMENDED.parts
    assert not any(pin.startswith("U9.") for pins in RECOMMENDED.nets.values() for pin in pins)
    assert "V12" not in RECOMMENDED.nets
    assert {sheet.name for sheet in CIRCUIT.sheets} - {s.name for s in RECOMMENDED.sheets} == {"vibration"}
    with pytest.raises(InputError, match="there is no other"):
        read_circuit('format = "fdvv-circuit"\nversion = 1\nbase = "other"\n')


def test_the_current_drive_lets_go_while_the_controller_is_in_reset() -> None:
    assert ("rest", "U5.E/S") in {(one.rule, one.place) for one in check_circuit(without("R56", RECOMMENDED))}
    pulls = [(a, b) for part, a, b in RECOMMENDED.between("resistor") if part.ref == "R47"]
    assert pulls == [("COMMAND", "MIDDLE_REF")], "the middle asks for no current"


def test_the_converters_of_the_m4_are_on_pins_that_have_one_and_the_command_on_its_dac() -> None:
    # SAMD51 data sheet: DAC0 on PA02; the converters on PA02 to PA11 and PB08, PB09
    chips = {name: RECOMMENDED.parts["U1"].kind.pins[name].chip for name in ("A0", "A2", "A3", "A4")}
    assert chips.pop("A0") == "PA02"
    assert set(chips.values()) <= {f"PA{n:02d}" for n in range(2, 12)} | {"PB08", "PB09"}


@pytest.mark.parametrize(("circuit", "board"), [(CIRCUIT, "itsybitsy_m0"), (RECOMMENDED, "itsybitsy_m4")])
def test_a_controllers_pins_are_those_of_its_firmware(circuit: Circuit, board: str) -> None:
    declared = re.findall(r"(PIN_\w+) = (\d+),?\s*/\* \((\w+)\)", (BOARDS / board / "pins.h").read_text())
    firmware = {
        (name, f"P{'B' if name.startswith('PIN_B_') else 'A'}{int(number):02d}", pin)
        for name, number, pin in declared
    }
    pins = circuit.parts["U1"].kind.pins.values()
    assert {(pin.signal, pin.chip, pin.name) for pin in pins if pin.signal} == firmware


@pytest.mark.parametrize(
    ("board", "part", "names"),
    [
        (
            "uno_vibration",
            "U9",
            {"SELECT": "U10.CS", "CLOCK": "U10.SCK", "DATA": "U10.SDI", "LATCH": "U10.LDAC"},
        ),
        ("uno_strip", "U12", {"KEY": "U7.1Y", "DATA": "R17.1", "CLOCK": "R18.1"}),
    ],
)
def test_an_unos_pins_are_those_of_its_firmware(board: str, part: str, names: dict[str, str]) -> None:
    text = (BOARDS / board / "main.c").read_text()
    for name, other in names.items():
        bits, pin = re.findall(rf"#define {name} (0x\w+)u\s*/\* (D\d+)", text)[0]
        assert CIRCUIT.net_of[f"{part}.{pin}"] == CIRCUIT.net_of[other]
        assert CIRCUIT.parts[part].kind.pins[pin].chip[-1] == str(int(bits, 16).bit_length() - 1)


def test_the_supplys_divider_is_the_one_the_firmware_reckons_with() -> None:
    text = (BOARDS / "itsybitsy_m0" / "acquire.c").read_text()
    gain = int(re.findall(r"SUPPLY_GAIN_Q13 = (\d+)", text)[0]) / 2**13
    at = levels(CIRCUIT, PowerState())
    counts = at["SUPPLY"].V / 3.3 * 4096
    assert counts * gain == pytest.approx(1e3 * at["V12_COIL"].V, rel=1e-3)


def test_a_5_volt_sensor_on_a_pin_of_3_volts_is_refused() -> None:
    found = check_circuit(with_pin("U4", "OUT", V=4.75))
    assert [(one.rule, one.place) for one in found] == [("too high", "U1.A4")]
    assert "bears 3.6 V" in str(found[0])


def test_a_bus_without_its_level_shifter_is_refused() -> None:
    joined = with_nets(SDA=CIRCUIT.nets["SDA"] + CIRCUIT.nets["SDA_5V"], SDA_5V=())
    assert ("too high", "U1.SDA") in {(one.rule, one.place) for one in check_circuit(joined)}


def test_a_key_line_without_its_buffer_is_too_low_for_the_uno() -> None:
    direct = with_pin("U7", "1Y", V=2.6)
    assert ("too low", "U12.D8") in {(one.rule, one.place) for one in check_circuit(direct)}


@pytest.mark.parametrize(("ref", "place"), [("R6", "U5.IN1"), ("R7", "U5.IN2"), ("R9", "U7.1A")])
def test_without_its_resistor_a_line_floats_while_the_controller_is_in_reset(ref: str, place: str) -> None:
    assert ("rest", place) in {(one.rule, one.place) for one in check_circuit(without(ref))}


def test_an_input_floats_when_the_plug_is_out_or_the_contact_open() -> None:
    assert ("floats", "U1.A4") in {(one.rule, one.place) for one in check_circuit(without("R27"))}
    assert ("floats", "U13.D2") in {(one.rule, one.place) for one in check_circuit(without("R26"))}


def test_shorts_double_drivers_and_pins_left_open_are_refused() -> None:
    assert rules(with_nets(V3=CIRCUIT.nets["V3"] + CIRCUIT.nets["V5"], V5=())) == {"short"}
    assert rules(with_nets(IN1=(*CIRCUIT.nets["IN1"], "U1.D12"))) == {"once", "drive"}
    assert rules(with_nets(ILIM=("U5.ILIM",))) == {"open", "single"}
    assert rules(with_nets(IN1=(*CIRCUIT.nets["IN1"], "U1.D7"))) == {"free"}


def test_a_source_that_cannot_feed_what_hangs_on_it_is_refused() -> None:
    assert rules(with_pin("PS1", "+", limit_mA=1000.0)) == {"overload"}
    assert all(rail.margin_ratio > 1.5 for rail in power_budget(CIRCUIT))


def test_a_part_fed_from_the_wrong_rail_is_refused() -> None:
    moved = with_nets(
        V5=tuple(p for p in CIRCUIT.nets["V5"] if p != "M1.V+"), V12=(*CIRCUIT.nets["V12"], "M1.V+")
    )
    assert "supply" in rules(moved)


@settings(max_examples=20)
@given(ref=st.sampled_from(RESISTORS), ratio=st.floats(0.97, 1.03))
def test_within_a_resistors_tolerance_every_rule_still_holds(ref: str, ratio: float) -> None:
    value = CIRCUIT.parts[ref].value
    assert value is not None
    assert check_circuit(with_value(ref, value * ratio)) == ()


@settings(max_examples=20)
@given(pin=st.sampled_from(OUTPUTS), V=st.floats(0.0, 24.0))
def test_no_output_may_lift_an_input_above_what_it_bears(pin: str, V: float) -> None:
    ref, _, name = pin.partition(".")
    changed = with_pin(ref, name, V=V)
    at, broken = levels(changed, PowerState()), check_circuit(changed)
    for heard, net in changed.net_of.items():
        most = changed.pin(heard).max_V
        if most is not None and most < at[net].V:
            assert ("too high", heard) in {(one.rule, one.place) for one in broken}


@settings(max_examples=20)
@given(top=st.floats(10.0, 1e5), low=st.floats(10.0, 1e5))
def test_a_dividers_level_and_resistance_are_those_of_the_textbook(top: float, low: float) -> None:
    circuit = with_value("R4", low, with_value("R3", top))
    level = levels(circuit, PowerState())["SUPPLY"]
    assert pytest.approx(12 * low / (top + low), rel=5e-3) == level.V
    assert level.ohm == pytest.approx(top * low / (top + low), rel=5e-3, abs=0.2)


@pytest.mark.parametrize(
    ("change", "place"),
    [
        (("version = 1", "version = 9"), "format"),
        (('kind = "itsybitsy-m0"', 'kind = "nothing"'), "parts.U1"),
        (('"U1.A0"]', '"U1.A99"]'), "nets.POSITION"),
        (('is = "ground", number = "7"', 'is = "wet"'), "kinds.mcp4921.pins.VSS"),
        (("value = 2.9", "value = -2.9"), "parts.L1"),
        (("[facts]", "[nonsense]"), "whole file"),
    ],
)
def test_a_broken_file_is_refused_with_its_place(change: tuple[str, str], place: str) -> None:
    import fdvv_rig.circuit

    text = Path(fdvv_rig.circuit.__file__).with_name("circuit.toml").read_text()
    assert change[0] in text
    with pytest.raises(InputError) as found:
        read_circuit(text.replace(*change), "mine.toml")
    assert (found.value.source, found.value.place) == ("mine.toml", place)


def test_what_is_no_text_and_no_toml_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "circuit.toml"
    path.write_bytes(b"\xff\xfe")
    with pytest.raises(InputError, match="is no text"):
        load_circuit(path)
    path.write_text("not toml at all")
    with pytest.raises(InputError, match="is no TOML"):
        load_circuit(path)
