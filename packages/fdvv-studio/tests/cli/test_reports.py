"""What the commands report: JSON documents, tables, files."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest

from fdvv.model.file import builtin_names, load_builtin, load_model, save_model
from tests.support.captures import recorded
from tests.support.command_line import Run, tactile_csv

FIT_KEYS = {"rmse_cN", "max_cN", "control_points", "bump_kept_ratio", "time_s"}
LANDMARK_KEYS = {"travel_mm", "actuation_mm", "peak_cN", "peak_mm", "valley_cN", "valley_mm", "snap_ratio"}


def test_fit_reports_both_strokes_landmarks_and_warnings(fdvv: Run, switch: Path) -> None:
    ran = fdvv("fit", switch, "--json")
    assert (ran.status, ran.err) == (0, "")
    report = ran.json
    assert report["name"] == "switch"
    assert set(report["strokes"]) == {"press", "release"}
    for stroke in report["strokes"].values():
        assert set(stroke) >= FIT_KEYS
        assert stroke["control_points"] == 15
        assert stroke["rmse_cN"] < 0.1
        assert stroke["bump_kept_ratio"] > 0.95
    assert set(report["landmarks"]) >= LANDMARK_KEYS
    assert report["landmarks"]["actuation_mm"] == pytest.approx(1.8, abs=0.02)
    assert report["warnings"] == []


def test_fit_writes_the_model_it_reports(fdvv: Run, switch: Path, tmp_path: Path) -> None:
    report = fdvv("fit", switch, "-o", "out/switch.fdvv.json", "--json").json
    model = load_model(tmp_path / "out" / "switch.fdvv.json")
    assert model.travel_mm == report["landmarks"]["bottom_out_mm"]
    assert "written to out" in fdvv("fit", switch, "-o", "out/switch.fdvv.json").out


def test_fit_of_a_folder_reports_results_in_order_refusals_and_a_summary(fdvv: Run, folder: Path) -> None:
    ran = fdvv("fit", folder, "--json", "-o", "models")
    assert ran.status == 0
    report = ran.json
    assert [Path(r["file"]).name for r in report["results"]] == ["a.csv", "b.csv"]
    assert all(set(r["strokes"]["press"]) >= FIT_KEYS for r in report["results"])
    (refused,) = report["refused"]
    assert Path(refused["file"]).name == "c.csv"
    assert "c.csv" in refused["reason"]
    assert (report["summary"]["files"], report["summary"]["refused"]) == (3, 1)
    assert set(report["summary"]["strokes"]["press"]["rmse_cN"]) == {"median", "p90"}
    assert sorted(p.name for p in Path("models").iterdir()) == ["a.csv.fdvv.json", "b.csv.fdvv.json"]


def test_a_folder_with_its_models_beside_its_measurements_is_fitted_again(fdvv: Run, folder: Path) -> None:
    first = fdvv("fit", folder, "--json", "-o", folder).json
    again = fdvv("fit", folder, "--json").json
    assert [r["file"] for r in again["results"]] == [r["file"] for r in first["results"]]
    assert len(again["refused"]) == 1


def test_show_reports_landmarks_and_curves(fdvv: Run) -> None:
    report = fdvv("show", "mx-clear", "--json").json
    assert report["name"] == "mx-clear"
    assert set(report["landmarks"]) >= LANDMARK_KEYS
    assert len(report["curves"]) == 10
    first = report["curves"][0]
    assert (first["stroke"], first["velocity_mm_s"], first["presses"]) == ("press", 0.5, None)
    assert (report["landmark_errors"], report["points"]) == ({}, {})
    fast = fdvv("show", "mx-clear", "--velocity", "190", "--json").json
    assert fast["landmarks"]["velocity_mm_s"] == 200


@pytest.fixture
def captured(tmp_path: Path) -> Path:
    save_model(recorded().model, tmp_path / "captured.fdvv.json")
    return tmp_path / "captured.fdvv.json"


def test_show_tells_the_spread_of_a_measured_button(fdvv: Run, captured: Path) -> None:
    report = fdvv("show", captured, "--velocity", "150", "--json").json
    assert report["landmark_errors"]["peak_cN"]["presses"] == 6
    assert report["points"]["travel"]["presses"] == 11
    (fast,) = [c for c in report["curves"] if (c["stroke"], c["velocity_mm_s"]) == ("press", 150.0)]
    assert (fast["presses"], fast["achieved_mm_s"]) == (6, pytest.approx(142.7, abs=0.1))
    ran = fdvv("show", captured, "--velocity", "150")
    (peak,) = [line.split() for line in ran.out.splitlines() if line.startswith("peak_cN")]
    error = report["landmark_errors"]["peak_cN"]["error"]
    assert peak == ["peak_cN", f"{report['landmarks']['peak_cN']:.3f}", "±", f"{error:.3f}", "6"]
    assert f"{fast['achieved_mm_s']:.1f} ± {fast['achieved_spread_mm_s']:.1f}" in ran.out


def test_compare_tells_standard_errors_and_what_they_are(fdvv: Run, captured: Path) -> None:
    ran = fdvv("compare", "mx-red", captured, "--velocity", "150")
    error = fdvv("compare", "mx-red", captured, "--velocity", "150", "--json").json["buttons"][1][
        "landmark_errors"
    ]["peak_cN"]["error"]
    (peak,) = [line for line in ran.out.splitlines() if line.startswith("peak_cN")]
    assert peak.endswith(f" ± {error:.3f}")
    assert "±: standard error over presses" in ran.out
    assert "±" not in fdvv("compare", "mx-red", "mx-blue").out
    assert max(map(len, ran.out.splitlines())) <= 100


def test_show_of_a_folder_reports_each_button(fdvv: Run, folder: Path) -> None:
    report = fdvv("show", folder, "--json").json
    assert [Path(r["file"]).name for r in report["results"]] == ["a.csv", "b.csv"]
    assert set(report["results"][0]["landmarks"]) >= LANDMARK_KEYS
    assert [Path(r["file"]).name for r in report["refused"]] == ["c.csv"]


def test_compare_reports_buttons_and_differences(fdvv: Run) -> None:
    report = fdvv("compare", "mx-blue", "mx-blue", "mx-red", "--json").json
    assert report["reference"] == "mx-blue"
    assert [b["name"] for b in report["buttons"]] == ["mx-blue", "mx-blue", "mx-red"]
    same = [d for d in report["differences"] if d["index"] == 1]
    other = [d for d in report["differences"] if d["index"] == 2]
    assert [d["stroke"] for d in same] == ["press", "release"]
    assert all(d["rms_cN"] == d["max_cN"] == 0 for d in same)
    assert all(d["max_cN"] > d["rms_cN"] > abs(d["mean_cN"]) for d in other)


def test_compare_of_a_folder_keeps_standard_output_to_json(fdvv: Run, folder: Path) -> None:
    ran = fdvv("compare", "mx-blue", folder, "--json")
    assert len(ran.json["buttons"]) == 3
    assert len(ran.json["refused"]) == 1
    assert ran.err.startswith("warning: refused: ")
    assert ran.err.count("\n") == 1


def test_library_reports_every_builtin_with_its_licence(fdvv: Run) -> None:
    buttons = fdvv("library", "--json").json["buttons"]
    assert [b["name"] for b in buttons] == list(builtin_names())
    assert all(b["licence"] and b["source"] and b["landmarks"]["travel_mm"] > 0 for b in buttons)


def test_merge_makes_a_button_of_two_velocities(fdvv: Run, tmp_path: Path) -> None:
    tactile_csv(tmp_path / "slow.csv")
    tactile_csv(tmp_path / "fast.csv", shift_cN=8)
    ran = fdvv(
        "merge", "slow.csv@0.5", "fast.csv:press@100", "--name", "both", "-o", "both.fdvv.json",
        "--travel-mm", "3.8", "--actuation-mm", "1.8", "--reset-mm", "1.6",
    )  # fmt: skip
    assert (ran.status, ran.out) == (0, "both.fdvv.json: 3 curves, travel 3.800 mm\n")
    model = load_model(tmp_path / "both.fdvv.json")
    assert model.velocities_mm_s("press") == (0.5, 100.0)
    assert model.force_cN(1.0, 100, "press") - model.force_cN(1.0, 0.5, "press") == pytest.approx(8, abs=0.5)


def test_assign_changes_only_the_segment(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv(
        "assign", "mx-blue", "mx-red:press", "--stroke", "press", "--segment", "1", "2", "-o", "x.fdvv.json"
    )
    assert ran.status == 0
    made, blue, red = load_model(tmp_path / "x.fdvv.json"), load_builtin("mx-blue"), load_builtin("mx-red")
    inside, outside = np.linspace(1.0, 2.0, 50), np.r_[np.linspace(0, 0.89, 40), np.linspace(2.11, 3.8, 40)]
    assert np.allclose(made.force_cN(inside, 1, "press"), red.force_cN(inside, 1, "press"), atol=1e-6)
    assert np.allclose(made.force_cN(outside, 1, "press"), blue.force_cN(outside, 1, "press"), atol=1e-6)


def test_a_model_is_known_by_its_inside_whatever_its_name(fdvv: Run, switch: Path) -> None:
    assert fdvv("fit", switch, "-o", "plain.json").status == 0
    assert fdvv("show", "plain.json", "--json").json["name"] == "switch"


@pytest.mark.parametrize("ending", ["svg", "png", "pdf"])
def test_a_figure_is_of_the_kind_its_ending_says(fdvv: Run, tmp_path: Path, ending: str) -> None:
    pytest.importorskip("matplotlib")
    assert fdvv("show", "mx-red", "--figure", f"figure.{ending}").status == 0
    head = (tmp_path / f"figure.{ending}").read_bytes()[:100]
    assert {"svg": b"<?xml", "png": b"\x89PNG", "pdf": b"%PDF"}[ending] in head


@pytest.mark.parametrize(
    "command",
    [
        ("library",),
        ("show", "mx-clear"),
        ("compare", "mx-blue", "mx-brown", "mx-clear", "rubber-dome", "mx-red"),
        ("compare", "mx-blue", *["mx-clear"] * 9),
        ("fit", "switch.csv"),
    ],
    ids=lambda c: " ".join(c[:3]),
)
def test_printed_lines_keep_to_a_hundred_columns(fdvv: Run, switch: Path, command: tuple[str, ...]) -> None:
    ran = fdvv(*command)
    assert ran.status == 0
    assert switch.is_file()
    assert max(map(len, ran.out.splitlines())) <= 100
    assert not any(line != line.rstrip() for line in ran.out.splitlines())


def test_long_and_odd_names_do_not_spoil_the_table(fdvv: Run, tmp_path: Path) -> None:
    below = tmp_path / "odd"
    below.mkdir()
    tactile_csv(below / f"{'long ' * 20}.csv")
    tactile_csv(below / "two\nlines\x1b[31m.csv")
    lines = fdvv("show", below).out.splitlines()
    assert len(lines) == 3
    assert max(map(len, lines)) <= 100
    assert "\x1b" not in "".join(lines)


def test_a_name_that_is_not_text_still_makes_a_model_and_json(fdvv: Run, tmp_path: Path) -> None:
    odd = tmp_path / "\udcff.csv"
    try:
        tactile_csv(odd)
    except OSError:
        pytest.skip("this file system takes only UTF-8 names")
    ran = fdvv("fit", odd, "-o", "odd.fdvv.json", "--json")
    assert ran.status == 0
    assert ran.json["name"] == "?"
    assert load_model(tmp_path / "odd.fdvv.json").name == "?"


def test_unknown_figures_are_null_in_json(fdvv: Run) -> None:
    text = fdvv("show", "mx-red", "--json").out
    assert json.loads(text)["landmarks"]["peak_cN"] is None
    assert "NaN" not in text


def test_compensate_and_probe_report_errors_per_curve_and_say_simulated(fdvv: Run) -> None:
    short = ("--velocity", "50", "--json")
    learn = ("compensate", "mx-red", *short, "--rounds", "1", "-o", "red.actuation.json")
    learned, judged = (
        fdvv(*learn),
        fdvv("probe", "mx-red", "red.actuation.json", *short, "--presses", "2", "--seed", "3"),
    )
    for ran in (learned, judged):
        assert (ran.status, ran.err) == (0, "")
        assert ran.json["simulated"] is True
        assert [(c["stroke"], c["velocity_mm_s"]) for c in ran.json["curves"]] == [
            ("press", 50.0),
            ("release", 50.0),
        ]
    assert [len(c["error_cN"]) for c in judged.json["curves"]] == [2, 2]
    other = fdvv("probe", "mx-blue", "red.actuation.json", *short, "--presses", "1")
    assert other.err == "warning: red.actuation.json was learned for mx-red, not for mx-blue\n"
    assert other.json["model"] == "mx-blue"


def test_compare_and_show_write_a_page_to_share(fdvv: Run, tmp_path: Path) -> None:
    assert "written to both.html" in fdvv("compare", "mx-red", "mx-clear", "--report", "both.html").out
    assert "mx-clear feels clearly different from mx-red" in (tmp_path / "both.html").read_text()
    assert fdvv("show", "mx-clear", "--report", "one.html").status == 0
    assert "Tactile: the press falls" in (tmp_path / "one.html").read_text()
    refused = fdvv("compare", "mx-red", "mx-clear", "--report", "page.pdf")
    assert (refused.status, (tmp_path / "page.pdf").exists()) == (2, False)


def test_compare_begins_with_how_different_the_buttons_feel(fdvv: Run) -> None:
    first = fdvv("compare", "mx-red", "mx-clear", "mx-blue").out.splitlines()[0]
    assert first.startswith("mx-clear feels clearly different from mx-red: about 2.2 just noticeable")
