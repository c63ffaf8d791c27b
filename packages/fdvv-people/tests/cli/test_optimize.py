"""fdvv optimize as a person runs it: begun, killed, gone on with, replayed, refused."""

from __future__ import annotations

import json
import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from fdvv_people.optimize.population.plan import PopulationPlan
from fdvv_people.optimize.population.population import run_population
from tests.support.command_line import Ran, Run
from tests.support.executors import Here

SHORT = (
    *("--trials", "4", "--presses", "4", "--person", "3", "--seed", "4"),
    *("--engine", "sobol", "--space", "paper", "--retest", "2"),
)


def run_optimize(fdvv: Run, folder: str = "run", *more: str) -> Ran:
    return fdvv("optimize", "run", "--folder", folder, *SHORT, *more)


def test_a_run_prints_its_trials_and_says_simulated(fdvv: Run) -> None:
    ran = run_optimize(fdvv)
    assert ran.status == 0, ran.err
    assert ran.out.startswith("temporal-pointing, easy (simulated), engine sobol, 4 trials\n")
    assert "recommended: x1_mm" in ran.out
    assert "\nAgainst the best of 4 switches, mx-" in ran.out
    assert "\nThe fixed design would" in ran.out
    assert "\nnext: " in ran.out


def test_json_has_the_end_in_figures_and_in_sentences(fdvv: Run) -> None:
    found = run_optimize(fdvv, "run", "--switch", "mx-red", "--switch", "mx-brown", "--json").json
    assert sorted(found["against_switches"]["switches"]) == ["mx-brown", "mx-red"]
    assert found["against_switches"]["blocks"] == found["against_fixed"]["pairs"] == 2
    assert [one["trials"] for one in found["final_means"]] == [2] * len(found["final_means"])
    assert all(", simulated" in sentence for sentence in found["ending"])
    assert run_optimize(fdvv, "alone", "--switch", "none", "--json").json["ending"] == []


def test_json_has_the_keys_that_programs_rely_on(fdvv: Run) -> None:
    found = run_optimize(fdvv, "run", "--json").json
    assert (found["seed"], found["engine"], found["simulated"]) == (4, "sobol", True)
    assert [trial["state"] for trial in found["trials"]] == ["done"] * 4
    for trial in found["trials"]:
        assert set(trial["parameters"]) == set(found["best"])
        assert trial["score"] == trial["scores"]["asynchrony_ms"]


def test_several_wishes_end_with_a_front_a_compromise_and_a_sentence(fdvv: Run) -> None:
    wishes = ("--also", "liking", "--also", "lost_ratio", "--switch", "none")
    ran = run_optimize(fdvv, "run", *wishes)
    assert ran.status == 0, ran.err
    assert "\ntrial  compromise " in ran.out
    assert ran.out.count("recommended") == 2
    found = fdvv("optimize", "resume", "run", "--json").json
    assert found["objectives"] == ["asynchrony_ms", "liking", "lost_ratio"]
    assert [row["parameters"] for row in found["front"] if row["recommended"]] == [found["best"]]
    weighted = run_optimize(fdvv, "fast", *wishes, "--weight", "asynchrony_ms=1", "--json").json
    assert weighted["best"] == weighted["front"][0]["parameters"]


@pytest.mark.parametrize("task", ["tapping", "accuracy"])
def test_other_tasks_are_played_too(fdvv: Run, task: str) -> None:
    ran = run_optimize(fdvv, "run", "--task", task, "--json")
    assert ran.status == 0, ran.err
    assert ran.json["level"] is None
    assert ran.json["best"] is not None


def test_what_is_liked_better_is_asked_for_where_nothing_is_scored(fdvv: Run, tmp_path: Path) -> None:
    asked = ("--task", "preference", "--space", "paper", "--trials", "4", "--retest", "6", "--person", "3")
    ran = fdvv("optimize", "run", "--folder", "run", *asked)
    assert ran.status == 0, ran.err
    lines = ran.out.splitlines()
    assert lines[0] == "preference (simulated), engine preference-line, 4 lines"
    assert lines[1].startswith("recommended: x1_mm")
    assert re.fullmatch(r"Preferred to the first design in \d of \d answers \(.*\), simulated.*", lines[3])
    assert lines[4].startswith("next: ")
    again = fdvv("optimize", "replay", "run")
    assert again.out == "preference-line suggests 4 lines again, each the same\n"
    assert fdvv("optimize", "report", "run").status == 0
    assert "4 of 4 lines answered" in (tmp_path / "run" / "report.html").read_text(encoding="utf-8")
    found = fdvv("optimize", "run", "--folder", "other", *asked, "--engine", "preference", "--json").json
    assert [one["answer"] for one in found["comparisons"]] != [None] * 4
    assert found["trials"] == []


def test_a_button_is_varied_and_tried_as_it_is_first(fdvv: Run) -> None:
    found = run_optimize(
        fdvv, "run", "--space", "mx-clear", "--vary", "force_ratio", "--vary", "bump_cN", "--json"
    ).json
    first = found["trials"][0]["parameters"]
    assert set(first) == {"force_ratio", "bump_cN"}
    assert (first["force_ratio"], first["bump_cN"]) == (1.0, 0.0)


@pytest.mark.slow
def test_a_rigs_limits_are_those_of_the_run_wherever_it_goes_on(fdvv: Run, tmp_path: Path) -> None:
    assert run_optimize(fdvv, "run", "--within", "light").status == 0
    kept = tmp_path / "run" / "rigs" / "light.simulated.rig.json"
    assert json.loads((tmp_path / "run" / "optimize.json").read_text())["space"]["rig"] == "shipped:light"
    (tmp_path / "mine.rig.json").write_bytes(kept.read_bytes())
    assert run_optimize(fdvv, "own", "--within", "mine.rig.json").status == 0
    assert (tmp_path / "own" / "rigs" / "mine.rig.json").read_bytes() == kept.read_bytes()
    assert fdvv("optimize", "replay", "own", "--json").json["same"] is True


def test_a_run_begins_from_what_others_did(fdvv: Run, tmp_path: Path) -> None:
    plan = PopulationPlan(kind="grid", people=2, designs=24, rounds=4)
    run_population(tmp_path / "others", plan, Here())
    short = ("--prior", "others", "--engine", "gp", "--trials", "1")
    first = run_optimize(fdvv, "run", *short, "--json").json["trials"][0]["parameters"]
    assert len(json.loads((tmp_path / "run" / "optimize.json").read_text())["prior"]) == 24
    alone = run_optimize(fdvv, "alone", *short[2:], "--json").json["trials"][0]["parameters"]
    assert first != alone
    ran = run_optimize(fdvv, "other", *short, "--space", "mx-clear")
    assert ran.status == 2
    assert "others played temporal-pointing with designs of the space paper" in ran.err


def test_a_run_is_played_on_a_strip_that_nobody_sees(fdvv: Run) -> None:
    found = run_optimize(fdvv, "run", "--strip", "host", "--trials", "2", "--presses", "2", "--json").json
    assert (found["simulated"], [trial["state"] for trial in found["trials"]]) == (True, ["done"] * 2)


def test_replay_finds_every_suggestion_the_same(fdvv: Run) -> None:
    run_optimize(fdvv)
    ran = fdvv("optimize", "replay", "run")
    assert (ran.status, ran.out) == (0, "sobol suggests 4 trials again, each the same\n")
    assert fdvv("optimize", "replay", "run", "--json").json["same"] is True


def test_replay_tells_of_a_seed_that_was_changed_by_hand(fdvv: Run, tmp_path: Path) -> None:
    run_optimize(fdvv)
    setup = tmp_path / "run" / "optimize.json"
    document: dict[str, Any] = json.loads(setup.read_text())
    setup.write_text(json.dumps({**document, "seed": 99}))
    ran = fdvv("optimize", "replay", "run")
    assert ran.status == 1
    assert ran.err.endswith("sobol now suggests otherwise at trial 0, 1, 2, 3\n")


def test_the_report_is_a_page_that_says_simulated(fdvv: Run, tmp_path: Path) -> None:
    run_optimize(fdvv)
    assert fdvv("optimize", "report", "run").out == "written to run/report.html\n"
    page = (tmp_path / "run" / "report.html").read_text()
    assert "<strong>Simulated:</strong>" in page
    assert page.count("<svg") == 2
    other = fdvv("optimize", "report", "run", "-o", "other.html", "--json")
    assert other.json["report"] == "other.html"


@pytest.mark.parametrize("stop", [signal.SIGKILL, pytest.param(signal.SIGINT, marks=pytest.mark.slow)])
def test_a_run_that_was_stopped_goes_on_as_if_it_had_not_been(
    fdvv: Run, tmp_path: Path, stop: signal.Signals
) -> None:
    command = [sys.executable, "-m", "fdvv", "optimize", "run", "--folder", "run", *SHORT, "--trials", "24"]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    process = subprocess.Popen(command, cwd=tmp_path, env=environment, stderr=subprocess.PIPE, text=True)
    journal = tmp_path / "run" / "trials.jsonl"
    while not journal.exists() or journal.read_bytes().count(b"\n") < 7:
        assert process.poll() is None, "it ended before it was stopped"
        time.sleep(0.01)
    process.send_signal(stop)
    stderr = process.communicate()[1]
    if stop is signal.SIGINT:
        assert process.returncode == 130
        assert stderr.rstrip().endswith("go on with: fdvv optimize resume run")
    ran = fdvv("optimize", "resume", "run", "--json")
    assert ran.status == 0, ran.err
    resumed = ran.json
    whole = fdvv("optimize", "run", "--folder", "whole", *SHORT, "--trials", "24", "--json").json
    assert resumed["trials"] == whole["trials"]
    assert resumed["best"] == whole["best"]


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (("--engine", "foo"), "foo: no engine has this name; use one of random, sobol"),
        (("--engine", "tpe"), "a baseline of the benchmarks now, no engine of fdvv; use one of random"),
        (("--engine", "gp:[1]"), "the options of gp are no JSON object"),
        (("--task", "foo"), "no simulated person plays it; use one of temporal-pointing"),
        (("--rig", "foo"), "none is called so; use one of ideal"),
        (("--space", "foo"), "no such file or built-in button"),
        (("--space", "mx-clear", "--vary", "foo"), "foo"),
        (("--within", "foo"), "is no rig that is known; name a *.rig.json"),
        (("--prior", "."), "holds no grid that is finished"),
        (("--strip", "foo"), "names no LED strip"),
        (("--strip", "host", "--task", "tapping"), "on a strip one plays temporal-pointing, not tapping"),
        (("--task", "tapping", "--presses", "2"), "rapid tapping needs three taps"),
        (("--task", "tapping", "--also", "effort_N_s"), "is not scored in tapping"),
        (("--strip", "host", "--also", "liking"), "on a strip liking is not measured"),
        (("--also", "liking", "--weight", "colour=1"), "is none of this run; use asynchrony_ms, liking"),
        (("--also", "liking", "--weight", "liking"), "write an objective and a number, as liking=2"),
    ],
)
def test_bad_options_get_one_line_and_leave_no_folder(
    fdvv: Run, tmp_path: Path, arguments: tuple[str, ...], message: str
) -> None:
    ran = run_optimize(fdvv, "run", *arguments)
    assert ran.status == 2
    assert message in ran.err
    assert ran.err.count("\n") == 1
    assert not (tmp_path / "run").exists()


def test_a_folder_with_something_in_it_is_no_new_run(fdvv: Run, tmp_path: Path) -> None:
    (tmp_path / "run").mkdir()
    (tmp_path / "run" / "notes.txt").write_text("mine")
    ran = run_optimize(fdvv)
    assert ran.status == 2
    assert "is not empty" in ran.err
    assert "optimize.json" in fdvv("optimize", "resume", "run").err


EXPERIMENT = ("optimize", "experiment", "--folder", "e", "--people", "4", "--trials", "2", "--presses", "3")


@pytest.mark.slow
def test_an_experiment_leaves_report_result_and_trials(fdvv: Run, tmp_path: Path) -> None:
    ran = fdvv(*EXPERIMENT, "--engine", "sobol", "--no-winner", "--processes", "2")
    assert ran.status == 0, ran.err
    assert ran.out.startswith("96 observations of 4 simulated people, engine sobol\n")
    result = json.loads((tmp_path / "e" / "result.json").read_text())
    assert len(result["observations"]) == 4 * 2 * 2 * 6
    assert "Simulated" in (tmp_path / "e" / "report.html").read_text()
    assert len(list((tmp_path / "e" / "training").iterdir())) == 8
    again = fdvv(*EXPERIMENT, "--engine", "sobol", "--no-winner", "--processes", "1", "--json")
    assert again.json == result


def test_an_experiment_begins_from_a_grid_of_each_level_or_from_none(fdvv: Run, tmp_path: Path) -> None:
    run_population(tmp_path / "easy", PopulationPlan(kind="grid", people=2, designs=3, rounds=2), Here())
    ran = fdvv(*EXPERIMENT, "--seed", "1", "--prior", "easy")
    assert ran.status == 2
    assert "hard: is a level without a grid" in ran.err
    assert "both are drawn with seed 0" in fdvv(*EXPERIMENT, "--prior", "easy").err
    assert not (tmp_path / "e").exists()
