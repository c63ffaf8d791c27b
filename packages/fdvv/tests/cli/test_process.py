"""The command that makes a model of a recording."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest

from fdvv.model.file import load_model
from fdvv.recording.file import RECORDING_SUFFIX, save_recording
from fdvv.recording.types import Quantity
from fdvv.testing.captured import captured_session
from tests.support.captures import SHORT_STROKE, capture, recorded
from tests.support.command_line import Ran, Run


def warned(ran: Ran) -> tuple[str, ...]:
    """Return the warnings on standard error, which holds nothing else."""
    return tuple(line.removeprefix("warning: ") for line in ran.err.splitlines())


@pytest.fixture
def recording(tmp_path: Path) -> Path:
    path = tmp_path / f"clear{RECORDING_SUFFIX}"
    save_recording(capture(), path)
    return path


def test_a_recording_becomes_a_model_file(fdvv: Run, recording: Path) -> None:
    ran = fdvv("process", recording, "-o", "out/clear.fdvv.json")
    assert (ran.status, warned(ran)) == (0, recorded().warnings)
    assert load_model("out/clear.fdvv.json") == recorded().model
    assert ran.out.startswith("mx-clear (simulated): ")
    assert f"take {SHORT_STROKE}" in ran.out
    assert "written to out/clear.fdvv.json" in ran.out
    assert max(map(len, ran.out.splitlines())) <= 100


def test_the_document_tells_curves_with_spread_and_every_press(fdvv: Run, recording: Path) -> None:
    ran = fdvv("process", recording, "--json")
    report = ran.json
    assert (ran.status, ran.err, tuple(report["warnings"])) == (0, "", recorded().warnings)
    for curve in report["curves"]:
        assert {"stroke", "velocity_mm_s", "achieved_mm_s", "presses", "rmse_cN", "median_spread_cN"} <= set(
            curve
        )
    assert [p["take"] for p in report["presses"] if p["reason"]] == [SHORT_STROKE]
    assert set(report["landmark_errors"]["travel_mm"]) == {"error", "presses"}


def test_the_mass_of_the_cap_is_used_and_recorded(fdvv: Run, recording: Path) -> None:
    report = fdvv("process", recording, "--json", "--cap-mass-g", "2.5").json
    assert any("moves 2.5 g" in assumption for assumption in report["assumptions"])


@pytest.fixture
def shaken(tmp_path: Path) -> Path:
    """A recording with an accelerometer on the housing, that heard nothing at one pace."""
    made = captured_session("mx-brown", 300, presses=5, paces_mm_s=(50.0, 100.0, 200.0)).recording
    takes = tuple(
        replace(t, streams=tuple(s for s in t.streams if s.quantity is not Quantity.ACCELERATION))
        if t.velocity_mm_s == 100.0
        else t
        for t in made.takes
    )
    path = tmp_path / f"brown{RECORDING_SUFFIX}"
    save_recording(replace(made, takes=takes), path)
    return path


@pytest.mark.slow
def test_vibrations_are_listed_and_missing_ones_reported_or_scaled_if_asked(fdvv: Run, shaken: Path) -> None:
    plain, text = fdvv("process", shaken, "--json").json, fdvv("process", shaken).out
    vibrations = plain["vibrations"]
    assert [(v["stroke"], v["velocity_mm_s"]) for v in vibrations["in_model"]] == [
        ("press", 50.0),
        ("press", 200.0),
    ]
    for vibration in vibrations["in_model"]:
        assert vibration["presses"] > 1
        assert vibration["onset_spread_mm"] > 0
        assert f"{vibration['frequency_Hz']:.0f} ± {vibration['frequency_spread_Hz']:.0f}" in text
    missing = [h for h in vibrations["heard"] if h["reason"]]
    assert all(any(h["reason"] in line for line in plain["warnings"]) for h in missing)
    assert [s["stroke"] for s in vibrations["scalings"]] == ["press"]
    assert not any("scaled from other paces" in line for line in plain["assumptions"])
    asked = fdvv("process", shaken, "--json", "--extrapolate-vibration").json
    (scaled,) = [v for v in asked["vibrations"]["in_model"] if v["presses"] is None]
    assert (scaled["stroke"], scaled["velocity_mm_s"]) == ("press", 100.0)
    assert any("press at 100 mm/s was not found but scaled" in line for line in asked["assumptions"])


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (("--cap-mass-g", "0"), "--cap-mass-g"),
        (("-o", "model.txt"), "end it in .fdvv.json"),
        (("--report", "report.txt"), "end it in .html"),
    ],
)
def test_what_cannot_be_done_is_refused_in_one_line(
    fdvv: Run, recording: Path, arguments: tuple[str, str], said: str
) -> None:
    ran = fdvv("process", recording, *arguments)
    assert (ran.status, ran.out) == (2, "")
    assert said in ran.err
    assert len(ran.err.splitlines()) == 1


def test_a_file_that_is_no_recording_is_refused(fdvv: Run, tmp_path: Path) -> None:
    other = tmp_path / "other.recording.jsonl"
    other.write_text("time,force\n0,1\n")
    ran = fdvv("process", other, "-o", "m.fdvv.json")
    assert (ran.status, ran.out) == (2, "")
    assert ran.err.startswith(f"fdvv: {other}: line 1")
    assert len(ran.err.splitlines()) == 1
    assert not Path("m.fdvv.json").exists()


def test_the_report_is_written_with_every_step(fdvv: Run, recording: Path) -> None:
    ran = fdvv("process", recording, "--report", "out/steps.html")
    assert (ran.status, warned(ran)) == (0, recorded().warnings)
    html = Path("out/steps.html").read_text()
    assert html.startswith("<!DOCTYPE html>")
    assert html.count("<svg") >= 8
    assert "written to out/steps.html" in ran.out
