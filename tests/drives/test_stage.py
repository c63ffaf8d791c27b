"""A stage file, its units and what is refused."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from fdvv.errors import InputError
from fdvv_drives.moteus_drive import MoteusPart
from fdvv_drives.odrive_drive import ODrivePart
from fdvv_drives.simplefoc_drive import SimpleFOCPart
from fdvv_drives.stage import Limits, Mechanics, Stage, read_tables, stage_of

FILE = """[moteus]
port = "/dev/ttyACM0"

[stage]
lead_mm_rev = 10.0
travel_mm = 6.0

[limits]
force_N = 3.0
"""


def stage(**mechanics: object) -> Stage:
    return Stage(Mechanics(**{"travel_mm": 6.0, **mechanics}), Limits(3.0))  # type: ignore[arg-type]


def read(text: str, tmp_path: Path) -> Stage:
    path = tmp_path / "stage.toml"
    path.write_text(text)
    _part, tables = read_tables(path, "moteus", MoteusPart)
    return stage_of(path, tables, "rev", "Nm")


def test_a_screw_of_10_mm_makes_628_N_of_a_newton_metre() -> None:
    found = stage(lead_mm_rev=10.0)
    assert found.mm_unit == 10.0
    assert found.N_unit == pytest.approx(2 * math.pi / 0.010)


def test_a_pinion_of_8_mm_makes_125_N_of_a_newton_metre() -> None:
    found = stage(radius_mm=8.0)
    assert found.mm_unit == pytest.approx(2 * math.pi * 8.0)
    assert found.N_unit == pytest.approx(1 / 0.008)


def test_radians_and_amperes_are_those_of_simplefoc() -> None:
    mechanics = Mechanics(travel_mm=6.0, radius_mm=8.0, force_N_A=4.0, zero_rad=0.5)
    found = Stage(mechanics, Limits(3.0), position_unit="rad", torque_unit="A")
    assert found.mm_unit == pytest.approx(8.0)
    assert (found.N_unit, found.zero) == (4.0, 0.5)


@pytest.mark.parametrize("direction", [1, -1])
def test_a_force_against_the_finger_is_a_torque_against_the_way_down(direction: int) -> None:
    found = stage(lead_mm_rev=10.0, force_N_Nm=500.0, direction=direction)
    assert found.displacement_mm(0.3 * direction, 0.0) == pytest.approx(3.0)
    # down is the drive's positive direction if direction is 1; the force of the button is up
    assert found.torque(1.0) == pytest.approx(-direction / 500.0)
    assert found.force_N(found.torque(1.0)) == pytest.approx(1.0)


def test_the_core_reads_displacements_to_a_sixteenth_of_a_micrometre() -> None:
    from fdvv_drives.controller import Controller

    found = stage(lead_mm_rev=10.0)
    controller = Controller(found, has_force_sensor=False)
    for number, x_mm in enumerate((-0.9, 0.0, 0.00011, 1.2345678, 6.9)):
        step = controller.step(x_mm, 0.0, 1000, number)
        assert step.displacement_mm == pytest.approx(x_mm, abs=0.5 / 16000 + 1e-9)
        assert not controller.has_failed


@pytest.mark.parametrize(
    ("before", "after", "text"),
    [
        ("[stage]", "[stge]", "stge: is no table of a stage file"),
        ("[limits]\nforce_N = 3.0", "", "limits: is missing"),
        ("travel_mm = 6.0", "", "stage: object missing required field `travel_mm`"),
        ("travel_mm = 6.0", 'travel_mm = "6"', r"stage.travel_mm: expected `float`, got `str`"),
        ("travel_mm = 6.0", "travel_mm = 14.5", "stage.travel_mm: is 14.5; write 1 to 14"),
        ("travel_mm = 6.0", "travel_mm = 14.0", "travel and overtravel span 16 mm; stay below 15 mm"),
        ("travel_mm = 6.0", "travel_mm = 6.0\ntravle_mm = 1", "object contains unknown field `travle_mm`"),
        ("travel_mm = 6.0", "travel_mm = 6.0\ndirection = 2", "stage.direction: invalid enum value 2"),
        (
            "travel_mm = 6.0",
            "travel_mm = 6.0\nforce_N_A = 2.0",
            "this drive is commanded in Nm; write force_N_Nm",
        ),
        (
            "travel_mm = 6.0",
            "travel_mm = 6.0\nzero_rad = 1.0",
            "the drive's position is in rev; use zero_rev",
        ),
        (
            "travel_mm = 6.0",
            "travel_mm = 6.0\nradius_mm = 8.0",
            "needs lead_mm_rev or radius_mm, one of both",
        ),
        ("lead_mm_rev = 10.0", "", "needs lead_mm_rev or radius_mm, one of both"),
        ("force_N = 3.0", "force_N = 5.1", "limits.force_N: is 5.1; write 0.1 to 5"),
        ("force_N = 3.0", "force_N = nan", "limits.force_N: is nan; write 0.1 to 5"),
        ("force_N = 3.0", "force_N = 3.0\n[loop]\nrate_Hz = 50", "loop.rate_Hz: is 50; write 100 to 5000"),
        ("port = ", "prt = ", "moteus: object contains unknown field `prt`"),
        ("[moteus]", "[moteus", "not valid TOML"),
        ("port = ", "id = 0\nport = ", "moteus: id is 0, write 1 to 126"),
        ("port = ", "watchdog_ms = 0\nport = ", "moteus: watchdog_ms is 0, write 10 to 1000"),
        ("port = ", "watchdog_ms = nan\nport = ", "moteus: watchdog_ms is nan, write 10 to 1000"),
    ],
)
def test_a_mistake_is_named_with_its_place(before: str, after: str, text: str, tmp_path: Path) -> None:
    assert before in FILE
    with pytest.raises(InputError) as error:
        read(FILE.replace(before, after), tmp_path)
    assert text in str(error.value)
    assert "\n" not in str(error.value)


def test_a_slow_loop_counts_several_ticks_of_the_core(tmp_path: Path) -> None:
    slow = read(FILE + "[loop]\nrate_Hz = 250", tmp_path)
    assert (slow.ticks, slow.tick_us, slow.period_s) == (4, 1000, 0.004)
    quick = read(FILE + "[loop]\nrate_Hz = 2000", tmp_path)
    assert (quick.ticks, quick.tick_us, quick.period_s) == (1, 500, 0.0005)


@pytest.mark.parametrize(
    ("part", "other", "reason"),
    [
        (
            ODrivePart,
            {"channel": "can0", "watchdog_ms": 5},
            "watchdog_ms is 5, write 10 to 1000, or 0 for none",
        ),
        (ODrivePart, {"channel": "can0", "watchdog_ms": 50, "node": 64}, "node is 64, write 0 to 63"),
        (
            SimpleFOCPart,
            {"port": "x", "watchdog_ms": -1},
            "watchdog_ms is -1, write 10 to 1000, or 0 for none",
        ),
        (SimpleFOCPart, {"port": "x", "watchdog_ms": 50, "letter": "MM"}, "letter is 'MM'"),
    ],
)
def test_a_table_of_another_drive_is_checked_too(part: type, other: dict[str, object], reason: str) -> None:
    with pytest.raises(ValueError, match=reason):
        part(**other)
