"""fdvv program, as a person runs it."""

from __future__ import annotations

import json
from pathlib import Path

from fdvv.program.file import load_program, program_to_json, save_program
from fdvv.program.library import make, programs
from fdvv.rendering.tuning import program_image

from .conftest import Run


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
