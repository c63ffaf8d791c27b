"""fdvv program, as a person runs it."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np

from fdvv.compensation.identification.rig_file import LearnedRig, save_rig
from fdvv.compensation.identification.rig_model import RigModel
from fdvv.model.surface import ForceSurface
from fdvv.program.file import load_program, program_to_json, save_program
from fdvv.program.library import make, programs
from fdvv.rendering.tuning import program_image
from tests.support.command_line import Run


def test_list_tells_every_program_with_its_parameters(fdvv: Run) -> None:
    ran = fdvv("program", "list")
    assert ran.status == 0
    entries = fdvv("program", "list", "--json").json["programs"]
    assert [e["name"] for e in entries] == [p.name for p in programs()]
    for entry in entries:
        assert f"{entry['name']}: " in ran.out
        promised = entry["summary"] + entry["details"]
        assert [n for n in entry["parameters"] if n not in promised or n not in ran.out] == []


def test_show_tells_states_and_ways(fdvv: Run) -> None:
    ran = fdvv("program", "show", "rapid-trigger")
    assert "up: fallen by 0.15 mm if deeper than 0.3 mm → down" in ran.out.splitlines()
    assert fdvv("program", "show", "rapid-trigger", "--json").json["start"] == "up"


def test_a_program_is_made_checked_compiled_and_shown(fdvv: Run, tmp_path: Path) -> None:
    made = fdvv(
        "program", "make", "rapid-trigger", "--base", "mx-black", "--set", "press_mm=0.1",
        "-o", "r.fdvv-program.json",
    )  # fmt: skip
    assert made.out == "r.fdvv-program.json: 2 states, travel 3.910 mm\n"
    assert load_program(tmp_path / "r.fdvv-program.json") == make("rapid-trigger", "mx-black", press_mm=0.1)
    assert "rapid-trigger: accepted" in fdvv("program", "check", "r.fdvv-program.json").out
    ran = fdvv("program", "compile", "r.fdvv-program.json", "-o", "r.fdvv-image", "--json")
    image = (tmp_path / "r.fdvv-image").read_bytes()
    assert ran.json["bytes"] == len(image)
    assert "state 0: fallen by 0.1 mm" in fdvv("program", "show", "r.fdvv-image").out
    assert program_image("r.fdvv-program.json", [50.0]) == image


def test_a_refused_program_exits_with_1_from_check_and_2_from_compile(fdvv: Run) -> None:
    checked = fdvv("program", "check", "button", "--opposing-cN", "40", "--json")
    assert checked.status == 1
    assert checked.json["accepted"] is False
    assert {f["state"] for f in checked.json["findings"]} == {"up", "down"}
    ran = fdvv("program", "compile", "button", "--opposing-cN", "40", "-o", "b.fdvv-image")
    assert ran.status == 2
    assert len(ran.err.splitlines()) == 1
    assert "state 'up'" in ran.err
    assert not Path("b.fdvv-image").exists()


def test_mistakes_get_one_line(fdvv: Run, tmp_path: Path) -> None:
    broken = json.loads(program_to_json(make("button")))
    broken["states"][0]["transitions"][0]["to"] = "nowhere"
    (tmp_path / "broken.fdvv-program.json").write_text(json.dumps(broken))
    for arguments, said in (
        (("show", "nothing"), "no such file or shipped program"),
        (("make", "nothing", "-o", "x.fdvv-program.json"), "none is called 'nothing'"),
        (("make", "button", "--set", "x", "-o", "x.fdvv-program.json"), "is not NAME=NUMBER"),
        (("make", "button", "-o", "x.txt"), "another ending"),
        (("check", "broken.fdvv-program.json"), "'nowhere'"),
    ):
        ran = fdvv("program", *arguments)
        assert ran.status == 2, arguments
        assert said in ran.err
        assert len(ran.err.splitlines()) == 1


def test_a_program_that_may_not_come_back_is_not_sent_to_a_device(fdvv: Run, tmp_path: Path) -> None:
    save_program(make("multi-level", "mx-clear"), tmp_path / "c.fdvv-program.json")
    ran = fdvv("device", "upload", "c.fdvv-program.json", "--device", "host")
    assert ran.status == 2
    assert "for ever; move the conditions of these states apart" in ran.err


def bench_file(tmp_path: Path) -> str:
    """Write what a person's `fdvv compensate --save-rig` leaves of a rig: here without a residual."""
    zero = np.zeros((1, 2))
    residual = ForceSurface(np.array([0.0, 4.0]), np.array([100.0]), zero, zero)
    rig = RigModel(
        (0.95, 0.02, -0.003), 1.3e-4, 5e-5, 5.5e-4, 0.3, 0.0, 3.0, 11.8, 11.6, 0.0, 0.01, presses=4
    )
    save_rig(LearnedRig(rig, residual, 4.0, np.ones((2, 1))), tmp_path / "bench.rig.json")
    return "bench.rig.json"


def test_render_measures_every_state_and_says_what_is_next(fdvv: Run, tmp_path: Path) -> None:
    known = bench_file(tmp_path)
    ran = fdvv(
        "program", "render", "dwell-ticks", "--rig", "recommended", "--rig-known", known, "--velocity", "100",
        "--presses", "1", "-o", "d.fdvv-image",
    )  # fmt: skip
    assert ran.status == 0, ran.err
    assert "force loop closed" in ran.out
    assert "dwelling, press at 100 mm/s" in ran.out
    assert "dwell-ticks is felt as written" in ran.out
    assert "next: upload it to the rig" in ran.out
    assert (tmp_path / "d.fdvv-image").read_bytes()[:4] == b"FDVP"


def test_render_makes_another_device_ready_to_be_pressed(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv("program", "render", "multi-level", "--device", "host", "--rig-known", bench_file(tmp_path))
    assert ran.status == 0, ran.err
    assert "multi-level is active, compensated for this rig" in ran.out


def test_render_asks_for_a_rig_that_is_known(fdvv: Run) -> None:
    ran = fdvv("program", "render", "multi-level")
    assert ran.status == 2
    assert "identify it with fdvv compensate BUTTON --save-rig FILE.rig.json" in ran.err
