"""fdvv compensate and probe with what is known of a rig and its force sensor, and what a rig lacks."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.support.command_line import Run

LEARN = ("compensate", "mx-clear", "--velocity", "100", "--rounds", "0")
SLOW = ("--velocity", "100", "--presses", "1")
SENSOR = "range_N = 5.0\nnoise_cN = 0.3\ndelay_ms = 0.04\nplate_g = 0.4\nstiffness_N_mm = 500\n"
PRIOR = "mass_g = { mean = 12.0, spread = 2.0 }\n"


def test_a_rig_is_identified_with_what_is_known_and_probed_with_its_cell(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "rig.toml").write_text(PRIOR)
    (tmp_path / "cell.toml").write_text(SENSOR)
    ran = fdvv(*LEARN, "--prior", "rig.toml", "--sensor", "cell.toml", "-o", "it.actuation.json")
    assert (ran.status, ran.out.splitlines()[0]) == (0, "mx-clear on twin (simulated), 4 presses")
    assert fdvv("probe", "mx-clear", "it.actuation.json", "--sensor", "cell.toml", *SLOW).status == 0


@pytest.mark.parametrize(
    ("options", "text", "said"),
    [
        (
            ("--prior",),
            "mas_g = { mean = 1.0, spread = 1.0 }",
            'mas_g: is no key of this file; did you mean "mass_g"?',
        ),
        (("--sensor",), "range_N = 5.0", "noise_cN: is missing; take it from the sensor's data sheet"),
        (("--sensor",), SENSOR.replace("5.0", "0.2", 1), "range_N: is 0.2, mx-clear needs"),
        (("--method", "paper", "--prior"), PRIOR, "belongs to the method rig-aware"),
    ],
)
def test_a_wrong_file_is_one_line(
    fdvv: Run, tmp_path: Path, options: tuple[str, ...], text: str, said: str
) -> None:
    (tmp_path / "it.toml").write_text(text)
    ran = fdvv(*LEARN[:-2], *options, "it.toml")
    assert ran.status == 2
    assert said in ran.err
    assert len(ran.err.strip().splitlines()) == 1


def test_a_rig_without_parts_says_so_before_the_first_press(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "bare.py").write_text(
        "from fdvv.device.own_rig import RigNumbers\n"
        "from tests.support.plain_rig import PlainRig\n"
        "class Bare(PlainRig):\n"
        "    numbers = RigNumbers('bare', 8.0, 4.4, sensor_mm=(9.0, -3.0), travel_limiter=False)\n"
    )
    spec = f"rig:{tmp_path / 'bare.py'}:Bare"
    ran = fdvv(*LEARN, "--device", spec)
    assert ran.status == 1
    assert "bare host: no force sensor in its settings" in ran.err
    shown = fdvv("device", "info", "--device", spec)
    assert "no force sensor: presses are played, but not measured" in shown.out.replace("\n", " ")
    assert "no travel limiter" in shown.out
    probed = fdvv("probe", "mx-clear", "--device", spec, *SLOW)
    assert "no travel limiter: every button is as deep as the stop of the rig" in probed.err
