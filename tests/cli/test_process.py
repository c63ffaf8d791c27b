"""The command that makes a model of a recording."""

from __future__ import annotations

from pathlib import Path

import pytest
from tests.captures import SHORT_STROKE, capture, recorded
from tests.cli.conftest import Ran, Run

from fdvv.model import load_model
from fdvv.recording import RECORDING_SUFFIX, save_recording
from fdvv.workflow import capture_report


def warned(ran: Ran) -> tuple[str, ...]:
    """Give the warnings on standard error, which holds nothing else."""
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


def test_the_mass_of_the_cap_is_taken_and_told(fdvv: Run, recording: Path) -> None:
    report = fdvv("process", recording, "--json", "--cap-mass-g", "2.5").json
    assert any("moves 2.5 g" in told for told in report["assumptions"])


def test_vibrations_are_listed_with_spread_and_presses_and_missing_ones_with_the_reason(
    fdvv: Run, recording: Path
) -> None:
    report, ran = capture_report(recorded()), fdvv("process", recording)
    told = report["vibrations"]
    assert len(told["in_model"]) == len(recorded().model.vibrations) > 0
    for vibration in told["in_model"]:
        assert vibration["presses"] > 1
        assert vibration["onset_spread_mm"] > 0
    missing = [h for h in told["heard"] if h["reason"]]
    assert missing
    assert all(any(h["reason"] in line for line in report["warnings"]) for h in missing)
    assert "vibration" in ran.out
    assert f"{told['in_model'][0]['frequency_Hz']:.0f} ±" in ran.out


def test_missing_vibrations_are_scaled_only_if_asked(fdvv: Run, recording: Path) -> None:
    plain = capture_report(recorded())
    asked = fdvv("process", recording, "--json", "--extrapolate-vibration").json
    assert not any("scaled from other paces" in told for told in plain["assumptions"])
    scaled = [v for v in asked["vibrations"]["in_model"] if v["presses"] is None]
    said = [told for told in asked["assumptions"] if "scaled from other paces" in told]
    assert bool(scaled) == bool(said)
    assert len(asked["vibrations"]["in_model"]) == len(plain["vibrations"]["in_model"]) + len(scaled)


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
