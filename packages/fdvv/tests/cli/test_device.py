"""fdvv device, as a person runs it."""

from __future__ import annotations

import json
from pathlib import Path

from fdvv.device.remote import surface_image
from fdvv.testing.conformance import plain_surface
from tests.support.command_line import Run


def test_the_kinds_of_device_are_listed(fdvv: Run) -> None:
    names = [row["device"] for row in json.loads(fdvv("device", "list", "--json").out)["devices"]]
    assert names[:6] == ["twin", "host", "emulated", "emulated:FILE", "serial:PORT", "replay:FILE"]
    assert "what it is" in fdvv("device", "list").out


def test_info_tells_limits_firmware_and_counters(fdvv: Run) -> None:
    info = json.loads(fdvv("device", "info", "--json").out)
    assert (info["name"], info["simulated"], info["mode"]) == ("host", True, "idle")
    assert info["counters"]["bad_frames"] == 0
    assert (info["force_loop"], info["load_cell"]) == ("open", None)
    assert "force_limit_cN" in fdvv("device", "info").out
    assert json.loads(fdvv("device", "info", "--device", "twin", "--json").out)["name"] == "twin"


def test_the_selftest_gives_a_verdict_for_every_part(fdvv: Run) -> None:
    parts = json.loads(fdvv("device", "selftest", "--json").out)["parts"]
    assert [p["part"] for p in parts][:2] == ["position_sensor", "supply"]
    assert "failed" not in {p["verdict"] for p in parts}
    assert "passed" in fdvv("device", "selftest").out


def test_a_model_and_an_image_are_uploaded(fdvv: Run, tmp_path: Path) -> None:
    image = tmp_path / "program.bin"
    image.write_bytes(surface_image(plain_surface(), 4.0))
    uploaded = json.loads(fdvv("device", "upload", str(image), "--json").out)
    assert uploaded == {"device": "host", "bytes": len(image.read_bytes()), "states": 1, "travel_mm": 4.0}
    assert "checked and active" in fdvv("device", "upload", "mx-brown").out


def test_a_damaged_image_is_refused_with_the_device_s_reason(fdvv: Run, tmp_path: Path) -> None:
    image = tmp_path / "program.bin"
    image.write_bytes(surface_image(plain_surface(), 4.0)[:-4] + b"oops")
    ran = fdvv("device", "upload", str(image))
    assert ran.status == 1
    assert ran.err.startswith("fdvv: host: refused commit: the program arrived damaged; upload it again")


def test_presses_are_made_recorded_and_replayed(fdvv: Run, tmp_path: Path) -> None:
    path = tmp_path / "session"
    first = json.loads(fdvv("device", "press", "mx-clear", "--record", str(path), "--json").out)
    again = json.loads(fdvv("device", "press", "mx-clear", "--device", f"replay:{path}", "--json").out)
    assert first == again
    assert len(first["presses"]) == 3
    assert "simulated" in fdvv("device", "press", "mx-clear", "--presses", "1").out
    ended = fdvv("device", "press", "mx-clear", "--device", f"replay:{path}", "--presses", "4")
    assert ended.status == 1
    assert "the recording ends here" in ended.err


def test_what_a_device_tells_is_written_as_lines(fdvv: Run, tmp_path: Path) -> None:
    for ending in ("csv", "jsonl"):
        path = tmp_path / f"telemetry.{ending}"
        summary = json.loads(fdvv("device", "monitor", "--seconds", "0.1", "-o", str(path), "--json").out)
        lines = path.read_text().splitlines()
        assert summary["missing_ticks"] == 0
        assert len(lines) == summary["records"] + (ending == "csv")
    assert list(json.loads(lines[0])) == [
        "tick", "displacement_mm", "velocity_mm_s", "commanded_cN", "force_cN", "state", "flags"
    ]  # fmt: skip


def test_fewer_records_are_asked_for(fdvv: Run) -> None:
    summary = json.loads(fdvv("device", "monitor", "--seconds", "0.1", "--every", "10", "--json").out)
    assert 9 <= summary["records"] <= 11  # of a loop of 1 kHz


def test_a_device_without_firmware_says_what_to_use(fdvv: Run) -> None:
    for command in (["selftest"], ["monitor"]):
        ran = fdvv("device", *command, "--device", "twin")
        assert ran.status == 2
        assert "use host or serial:PORT" in ran.err


def test_a_port_that_is_not_there_is_refused_with_status_1(fdvv: Run) -> None:
    ran = fdvv("device", "info", "--device", "serial:/dev/there-is-none")
    assert ran.status == 1
    assert ran.err.count("\n") == 1


def test_a_new_rig_is_pressed_checked_and_set_from_its_file(fdvv: Run, tmp_path: Path) -> None:
    folder = tmp_path / "fdvv-mine"
    written = fdvv("device", "new", "mine", "-o", str(folder))
    assert written.status == 0
    device = f"rig:{folder}/src/mine/rig.py:Rig"
    assert f"--device {device}" in written.out
    pressed = json.loads(
        fdvv("device", "press", "mx-red", "--device", device, "--presses", "1", "--json").out
    )
    assert pressed["simulated"]
    info = json.loads(fdvv("device", "info", "--device", device, "--json").out)
    assert info["name"].startswith("mine")
    checked = fdvv("device", "conform", "--no-press", "--device", device)
    assert (checked.status, "16 of 16 rules kept" in checked.out) == (0, True)
    again = fdvv("device", "new", "mine", "-o", str(folder))
    assert (again.status, "exists and is not empty" in again.err) == (2, True)


def test_settings_are_read_into_a_file_and_written_back(fdvv: Run, tmp_path: Path) -> None:
    path = tmp_path / "board.toml"
    held = json.loads(fdvv("device", "settings", "get", "-o", str(path), "--json").out)
    assert path.read_text().count("\n") == len(held)
    assert "nothing changed" in fdvv("device", "settings", "set", str(path)).out
    assert "lead_us 0 -> 700" in fdvv("device", "settings", "set", "lead_us=700").out


def test_settings_that_cannot_be_written_say_which_and_why(fdvv: Run, tmp_path: Path) -> None:
    for words, reason in (
        ("leadus=7", "did you mean lead_us?"),
        ("lead_us=-1", "use 0 to 20000"),
        ("lead_us=much", "is no whole number"),
        ("force_limit_cN64=32000", "this board was built for at most"),
        (str(tmp_path / "absent.toml"), "does not exist"),
    ):
        ran = fdvv("device", "settings", "set", words)
        assert ran.status in (1, 2)
        assert reason in ran.err


def test_a_device_without_a_fault_has_none_to_clear(fdvv: Run) -> None:
    assert "host: no fault" in fdvv("device", "clear").out
