"""Runs by name: ask, tell, best, pairs; nothing is lost when the server is killed."""

from __future__ import annotations

import json
import os
import signal
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from fdvv.model.file import model_from_json
from fdvv_campaigns.serve import answers, messages
from fdvv_campaigns.serve.runs import Runs
from fdvv_people.optimize.problem import TrialState
from fdvv_people.optimize.run.ledger import read_ledger
from fdvv_people.optimize.space import Parameter
from fdvv_studio.studio.studio import Studio
from tests.serve.conftest import folder_of
from tests.serve.running import Client, RefusedCall, RunningServer

pytest.importorskip("sklearn")
OWN: dict[str, Any] = {
    "parameters": [
        {"name": "size_px", "low": 10.0, "high": 1000.0, "unit": "pixels", "scale": "log"},
        {"name": "pause_ms", "low": 100, "high": 900},
    ],
    "engine": "sobol",
}


def test_the_same_design_is_asked_until_its_score_is_known(client: Client, run: str) -> None:
    begun = client.call("optimize.begin", run=run, budget=4, objective="time_ms", seed=3, **OWN)
    assert (begun["left"], begun["done"], begun["compares"], begun["goal"]) == (4, 0, False, "minimise")
    assert begun["parameters"][0] == {**OWN["parameters"][0], "scale": "log"}
    first = client.call("optimize.ask", run=run)
    assert client.call("optimize.ask", run=run) == first
    assert (first["model"], first["left"]) == (None, 3)
    assert client.call("optimize.tell", run=run, trial=first["trial"], score=300.0)["done"] == 1
    second = client.call("optimize.ask", run=run)
    assert second["trial"] == first["trial"] + 1
    assert second["design"] != first["design"]


def test_a_run_ends_with_a_design_and_its_interval(client: Client, run: str) -> None:
    client.call("optimize.begin", run=run, budget=12, goal="maximise", error=1.0, **OWN)
    scores = {}
    while (trial := client.call("optimize.ask", run=run))["trial"] is not None:
        scores[trial["trial"]] = 100.0 - 20.0 * abs(np.log10(trial["design"]["size_px"] / 100.0))
        client.call("optimize.tell", run=run, trial=trial["trial"], score=float(scores[trial["trial"]]))
    assert trial["finished"]
    best = client.call("optimize.best", run=run)
    assert best["low"] < best["mean"] < best["high"]
    assert best["mean"] == pytest.approx(max(scores.values()), abs=3.0)
    assert (best["count"], best["retest"], best["chance"]) == (12, None, None)


def test_a_report_that_comes_again_counts_once_and_another_one_is_refused(client: Client, run: str) -> None:
    client.call("optimize.begin", run=run, **OWN)
    report = {"run": run, "trial": client.call("optimize.ask", run=run)["trial"]}
    client.call("optimize.tell", **report, score=1.5)
    assert client.call("optimize.tell", **report, score=1.5)["done"] == 1
    with pytest.raises(RefusedCall, match="is done and cannot become done"):
        client.call("optimize.tell", **report, score=1.6)
    with pytest.raises(RefusedCall, match="there is no such trial"):
        client.call("optimize.tell", run=run, trial=99, score=1.0)


def test_failed_trials_count_and_abandoned_ones_do_not(client: Client, run: str) -> None:
    client.call("optimize.begin", run=run, budget=3, **OWN)
    for outcome, left in (("failed", 2), ("abandoned", 2)):
        trial = client.call("optimize.ask", run=run)["trial"]
        said = {"run": run, "trial": trial, "outcome": outcome}
        assert client.call("optimize.tell", **said, reason="it fell")["left"] == left
        with pytest.raises(RefusedCall, match="does not go with"):
            client.call("optimize.tell", **said, score=1.0)
    with pytest.raises(RefusedCall, match="no trial is done yet"):
        client.call("optimize.best", run=run)


def test_a_button_is_tried_as_it_is_first_and_designs_come_as_models(client: Client, run: str) -> None:
    client.call("optimize.begin", run=run, button="mx-clear", vary=["force_ratio"], engine="random")
    first = client.call("optimize.ask", run=run)
    assert first["design"] == {"force_ratio": 1.0}
    client.call("optimize.tell", run=run, trial=first["trial"], score=1.0)
    second = client.call("optimize.ask", run=run)
    (of_first, of_second) = (model_from_json(json.dumps(one["model"])) for one in (first, second))
    ratio = of_second.curves[0].control_points_cN / of_first.curves[0].control_points_cN
    assert ratio == pytest.approx(second["design"]["force_ratio"])


def test_pairs_are_compared_where_the_engine_reads_preferences(client: Client, run: str) -> None:
    begun = client.call("optimize.begin", run=run, budget=8, **{**OWN, "engine": "preference"})
    assert begun["compares"]
    with pytest.raises(RefusedCall, match="ask for comparisons"):
        client.call("optimize.ask", run=run)
    while (pair := client.call("optimize.compare", run=run))["pair"] is not None:
        assert client.call("optimize.compare", run=run) == pair
        answer = "first" if pair["first"]["size_px"] < pair["second"]["size_px"] else "second"
        for _ in range(2):
            client.call("optimize.prefer", run=run, pair=pair["pair"], answer=answer)
    best = client.call("optimize.best", run=run)
    assert best["chance"] > 0.5
    assert best["count"] == 8


def test_a_retest_plays_first_and_recommended_design_blind(client: Client, run: str) -> None:
    client.call("optimize.begin", run=run, budget=4, retest=2, **OWN)
    played = []
    while (trial := client.call("optimize.ask", run=run))["trial"] is not None:
        played.append(trial["design"]["size_px"])
        client.call("optimize.tell", run=run, trial=trial["trial"], score=played[-1])
    assert len(played) == 4 + 2 * 2
    assert {*played[4:]} == {played[0], min(played[:4])}
    assert client.call("optimize.best", run=run)["retest"]["difference"] == played[0] - min(played)


@pytest.mark.parametrize(
    ("fields", "word"),
    [
        ({}, "either own parameters or a button"),
        ({**OWN, "button": "mx-clear"}, "either own parameters or a button"),
        ({**OWN, "engine": "magic"}, "no engine is called"),
        ({"button": "../../etc/passwd"}, "passwd"),
        ({"button": {"format": "fdvv-model"}}, "version"),
        ({"button": "mx-clear", "within": "/etc/passwd"}, "is no rig"),
        ({**OWN, "bounds": {}}, "belongs to a button"),
        ({**OWN, "start": {"size_px": 5.0, "pause_ms": 100.0}}, "size_px"),
        ({"parameters": [{"name": "a", "low": 1.0, "high": 1.0}]}, "low below high"),
        ({"parameters": [{"name": "a", "low": -1.0, "high": 1.0, "scale": "log"}]}, "above 0"),
        ({"parameters": [{"name": "a b", "low": 0.0, "high": 1.0}]}, "identifier"),
        ({"parameters": [OWN["parameters"][0]] * 2}, "different names"),
    ],
)
def test_a_run_that_cannot_be_is_refused_and_leaves_nothing(
    server: RunningServer, client: Client, run: str, fields: dict[str, Any], word: str
) -> None:
    with pytest.raises(RefusedCall, match=word) as refused:
        client.call("optimize.begin", run=run, **fields)
    assert set(refused.value.error) == {"source", "place", "reason", "remedy"}
    assert not folder_of(server, run).exists()


@pytest.mark.parametrize(
    "name", ["", ".", "..", "../x", "a/b", "a\\b", "/x", "-x", "x" * 61, "é", "a\n", "nul", "COM1"]
)
def test_a_name_that_could_be_a_path_is_refused(client: Client, name: str) -> None:
    for call in ("optimize.begin", "optimize.resume", "optimize.ask"):
        with pytest.raises(RefusedCall):
            client.call(call, run=name, **(OWN if call == "optimize.begin" else {}))


def test_a_score_is_forced_to_the_disk_before_it_is_answered(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    runs, synced, fsync = Runs(Studio(tmp_path)), list[int](), os.fsync
    parameters = (Parameter("a", 0.0, 1.0),)
    runs.answer(messages.BeginRun(id=1, run="a", parameters=parameters, engine="sobol"))
    asked = runs.answer(messages.AskDesign(id=2, run="a"))
    assert isinstance(asked, answers.Suggestion)
    assert asked.trial is not None

    def noted(file: int) -> None:
        fsync(file)
        synced.append(os.fstat(file).st_size)

    monkeypatch.setattr("os.fsync", noted)
    runs.answer(messages.TellOutcome(id=3, run="a", trial=asked.trial, score=1.0))
    assert synced == [(tmp_path / "serve" / "a" / "trials.jsonl").stat().st_size]
    runs.close()


def test_a_killed_server_has_every_score_that_it_answered(tmp_path: Path, run: str) -> None:
    answered: dict[int, float] = {}
    server = RunningServer(tmp_path / "project")
    port, token = server.port, server.token
    for life in range(2):
        client = Client(server)
        if life:
            state = client.call("optimize.resume", run=run)
            assert state["done"] >= len(answered)
        else:
            client.call("optimize.begin", run=run, budget=1000, **OWN)
        for _ in range(7):
            trial = client.call("optimize.ask", run=run)
            score = float(trial["design"]["size_px"])
            client.call("optimize.tell", run=run, trial=trial["trial"], score=score)
            answered[trial["trial"]] = score
        # the last report may or may not have come to the disk: it was not answered
        pending = client.call("optimize.ask", run=run)
        client.send("optimize.tell", run=run, trial=pending["trial"], score=1.0)
        server.stop(signal.SIGKILL)
        kept = {t.number: t for t in read_ledger(folder_of(server, run) / "trials.jsonl").trials}
        assert {n: kept[n].scores["score"].value for n in answered} == answered
        server = RunningServer(tmp_path / "project", port)
        assert (server.port, server.token) == (port, token)
    with_pending = Client(server).call("optimize.ask", run=run)
    if kept[pending["trial"]].state is TrialState.SUGGESTED:
        assert with_pending["trial"] == pending["trial"]
    server.stop()
