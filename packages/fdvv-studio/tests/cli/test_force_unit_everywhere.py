"""Every command of the main job in gf and N: no sentence, table or report shows a force in cN."""

from __future__ import annotations

import re
from dataclasses import fields
from pathlib import Path

import numpy as np
import pytest

from fdvv.cli.device.device import line_of
from fdvv.device.telemetry import TickColumns
from fdvv.force_text import shown_in
from tests.support.campaign import campaign
from tests.support.command_line import Run, tactile_csv

CN = re.compile(r"(?<![-\w])cN(?!\w)|_cN\b")
FAST = ("--velocity", "100", "--seed", "3")


def shown(run: Run, unit: str, *command: str | Path) -> str:
    ran = run("--force-unit", unit, *command)
    assert ran.status in (0, 1), ran.err
    text = ran.out + ran.err
    assert not CN.search(text), [line for line in text.splitlines() if CN.search(line)]
    return text


def page(path: Path) -> str:
    """Check what a page shows, without the files inside it; return its source."""
    text = re.sub(r"data:[^\"]*", "", path.read_text(encoding="utf-8"))
    found = [line for line in re.sub(r"<[^>]+>", "\n", text).splitlines() if CN.search(line)]
    # sources are quoted, a stream holds what its file does, and the foot of a page says what a cN is
    quoted = ("1 cN is about 1 gf", "force (cN)", "Measured: ", "not-a-knot ends; within 0.01 cN")
    assert [line for line in found if not any(part in line for part in quoted)] == []
    return text


@pytest.mark.parametrize("unit", ["gf", "N"])
def test_buttons_and_fits(fdvv: Run, unit: str, tmp_path: Path) -> None:
    switch = tactile_csv(tmp_path / "switch.csv")
    assert f"RMSE {unit}" in shown(fdvv, unit, "fit", switch, "-o", "switch.fdvv.json")
    shown(fdvv, unit, "show", "mx-clear", "--report", "clear.html")
    shown(fdvv, unit, "show", "switch.fdvv.json", "--figure", "switch.svg")
    shown(fdvv, unit, "compare", "mx-clear", "mx-red", "switch.fdvv.json", "--report", "compared.html")
    shown(fdvv, unit, "library")
    shown(fdvv, unit, "press", "--button", "mx-clear", "--presses", "1", "--speed", "100")
    shown(fdvv, unit, "check", switch)
    for name in ("clear.html", "compared.html"):
        assert f"({unit})" in page(tmp_path / name)


@pytest.mark.parametrize("unit", ["gf", "N"])
def test_learning_probing_and_feasibility(fdvv: Run, unit: str, tmp_path: Path) -> None:
    clear = ("mx-clear", *FAST)
    files = ("-o", "clear.actuation.json", "--save-rig", "bench.rig.json")
    text = shown(fdvv, unit, "compensate", *clear, *files, "--rounds", "1")
    assert re.search(rf"\d {unit}\b", text)
    shown(fdvv, unit, "compensate", *clear, "--rig-known", "bench.rig.json", "--rounds", "0")
    shown(
        fdvv, unit, "probe", "mx-clear", "clear.actuation.json", *FAST, "--presses", "2", "--report", "p.html"
    )
    shown(fdvv, unit, "feasible", "mx-clear", "--rig-known", "bench.rig.json", "--velocity", "100")
    shown(fdvv, unit, "show", "clear.actuation.json")
    assert f"mean ({unit})" in page(tmp_path / "p.html")


@pytest.mark.parametrize("unit", ["gf", "N"])
def test_devices_and_programs(fdvv: Run, unit: str) -> None:
    shown(fdvv, unit, "device", "press", "multi-level", "--presses", "1")
    shown(fdvv, unit, "device", "info")
    shown(fdvv, unit, "device", "monitor", "--seconds", "0.1", "-o", "ticks.csv")
    shown(fdvv, unit, "program", "check", "multi-level")


@pytest.mark.parametrize("unit", ["gf", "N"])
def test_the_line_of_a_monitor(unit: str) -> None:
    columns = TickColumns(**{field.name: np.array([100.0]) for field in fields(TickColumns)})
    with shown_in(unit):
        assert f" {unit}  state" in str(line_of(columns, 0))


def test_a_search_accepts_the_unit_on_the_figure_and_on_its_column(fdvv: Run, folder: Path) -> None:
    assert fdvv("library", "build", folder, "-o", "lib").status == 0

    def names(*words: str) -> list[str]:
        return [hit["name"] for hit in fdvv("library", "search", "lib", *words, "--json").json["hits"]]

    found = fdvv("library", "search", "lib", "--json").json["hits"]
    middle_cN = sum(hit["peak_cN"] for hit in found) / 2
    middle_gf, middle_N = middle_cN / 0.980665, middle_cN / 100
    assert names(f"peak_cN>={middle_cN}") == ["a"]
    assert names(f"peak_cN>={middle_gf}gf") == names(f"peak_gf>={middle_gf}") == ["a"]
    assert names(f"peak_N<{middle_N}") == names(f"peak_cN=0..{middle_N}N") == ["b"]
    assert names(f"pre_slope_N_mm>{0}", "--sort", "peak_gf") == ["b", "a"]
    assert "is not a number" in fdvv("library", "search", "lib", "travel_mm>=3gf").err
    assert "peak_gf" in fdvv("--force-unit", "gf", "library", "search", "lib").out


def test_a_refusal_names_the_force_in_the_unit(fdvv: Run, switch: Path) -> None:
    ran = fdvv("--force-unit", "N", "fit", switch, "--max-rmse-cN", "0.0001N")
    assert ran.status == 1
    assert re.search(r"RMSE of 0\.\d+ N exceeds the bound of 0\.0001 N", ran.err)


@pytest.mark.slow
@campaign("unit", ["gf", "N"], part=1)
def test_the_demonstration_and_a_capture(fdvv: Run, unit: str, tmp_path: Path) -> None:
    shown(fdvv, unit, "demo", "--output", "demo")
    assert f"({unit})" in page(tmp_path / "demo" / "report.html")
    few = ("--presses", "4", "--paces", "100", "--seed", "2")
    shown(fdvv, unit, "capture", "clear.recording.jsonl", "--button", "mx-clear", *few)
    shown(fdvv, unit, "process", "clear.recording.jsonl", "--report", "clear.html")
    assert f"RMSE ({unit})" in page(tmp_path / "clear.html")
