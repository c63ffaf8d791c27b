"""How a run ends: blocks with switches and the fixed design in them, and what is said of both."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Mapping
from pathlib import Path

import msgspec
import numpy as np
import pytest
from scipy.stats import ttest_rel

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv_people.optimize.model_space import neutral_design
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.realistic import realistic_space
from fdvv_people.optimize.run.begin import RunRequest, begin_run
from fdvv_people.optimize.run.ending import (
    against_fixed,
    against_switches,
    beaten_by,
    ending_sentences,
    final_means,
)
from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.report import optimize_report
from fdvv_people.optimize.run.rivals import FIXED, SWITCHES, Rival, switch_rivals
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, model_space_setup
from fdvv_people.optimize.run.verdict import retest_of
from fdvv_people.task.score import Score

BASE = load_builtin("mx-clear")
NAMES = ("force_ratio", "actuation_mm")
START = neutral_design(realistic_space(BASE, NAMES), BASE)
FOUND, OWN = "found", "start"


def begun(folder: Path, switches: tuple[str, ...] = SWITCHES, blocks: int = 6) -> Optimization:
    """Begin a run of four trials that starts from mx-clear."""
    setup = OptimizeSetup(
        space=model_space_setup(BASE, NAMES),
        engine="sobol",
        budget=4,
        start=START,
        rivals=switch_rivals(switches, ("mx-clear", START)),
        simulated=True,
        about={OptimizeSetup.RETEST: blocks, OptimizeSetup.NAME: "mx-clear"},
    )
    return Optimization.create(folder, setup)


def in_paper_space(folder: Path, blocks: int = 6) -> Optimization:
    """Begin a run of the paper's space, with a person."""
    wanted = RunRequest(
        space="paper", person=None, switches=SWITCHES, retest=blocks, engine="sobol", budget=3
    )
    return begin_run(folder, wanted)


def name_of(session: Optimization, trial: Trial) -> str:
    return str(trial.rival) if trial.rival else (OWN if trial.design == session.start else FOUND)


def play(
    session: Optimization, truth_ms: Mapping[str, float], noise_ms: float = 2.0, failing: str = ""
) -> None:
    """Play a run to its end: in the search everything is better than the start."""
    random = np.random.default_rng(4)
    while trial := session.next_trial():
        session.show(trial.number)
        if trial.rival and trial.rival == failing:
            session.give_up(trial.number, "the rig cannot render it")
            continue
        mean_ms = truth_ms.get(name_of(session, trial), 80.0)
        score = Score(mean_ms + noise_ms * float(random.standard_normal()), 7.0)
        session.answer(trial.number, {"asynchrony_ms": score})


def test_each_block_has_everything_once_and_the_start_is_one_of_the_switches(tmp_path: Path) -> None:
    with begun(tmp_path / "run", blocks=10) as session:
        play(session, {FOUND: 60.0})
        names = [name_of(session, trial) for trial in session.retests]
        assert len(names) == 10 * 5
        for block in range(10):
            assert Counter(names[5 * block : 5 * block + 5]) == Counter([OWN, FOUND, *SWITCHES[1:]])
        # ten orders of five: each has every place equally often
        places = Counter((name, at % 5) for at, name in enumerate(names))
        assert set(places.values()) == {2}
        assert session.finished
        assert len(session.trials) == 4
    assert replay_differences(tmp_path / "run") == ()


def test_a_switch_is_played_as_its_file_has_it(tmp_path: Path) -> None:
    with begun(tmp_path / "run", blocks=2) as session:
        play(session, {})
        brown = next(trial for trial in session.retests if trial.rival == "mx-brown")
        assert session.button(brown, "mx-brown") == load_builtin("mx-brown")
        found = next(trial for trial in session.retests if name_of(session, trial) == FOUND)
        assert session.button(found) == session.model(found.design)


def test_an_end_that_is_killed_at_every_trial_goes_on_with_the_same_trials(tmp_path: Path) -> None:
    with begun(tmp_path / "run", blocks=2) as session:
        play(session, {FOUND: 60.0}, noise_ms=0.0)
        whole = [(trial.rival, trial.design) for trial in session.retests]
    played: list[Trial] = []
    while True:
        with (
            Optimization.open(tmp_path / "pieces")
            if played
            else begun(tmp_path / "pieces", blocks=2) as session
        ):
            waiting = next(iter(session.ask()), None)
            if waiting is None:
                break
            session.show(waiting.number)
        with Optimization.open(tmp_path / "pieces") as session:
            again = next(iter(session.ask()), None)
            assert again is not None
            assert again.number == waiting.number
            name = name_of(session, again)
            score = Score(60.0 if name == FOUND else 80.0, 7.0)
            played.append(session.answer(again.number, {"asynchrony_ms": score}))
    assert [(trial.rival, trial.design) for trial in played[4:]] == whole


def test_against_one_switch_it_is_the_paired_t_test_over_blocks(tmp_path: Path) -> None:
    with begun(tmp_path / "run", ("mx-brown",)) as session:
        play(session, {FOUND: 60.0, "mx-brown": 62.0})
        scores = {
            name: [t.scores["asynchrony_ms"].value for t in session.retests if name_of(session, t) == name]
            for name in (FOUND, "mx-brown", OWN)
        }
        found = against_switches(session)
        assert found is not None
        oracle = ttest_rel(scores["mx-brown"], scores[FOUND])
        interval = oracle.confidence_interval(0.95)
        assert (found.low, found.high) == pytest.approx((interval.low, interval.high))
        start = retest_of(session)
        assert start is not None
        assert start.difference == pytest.approx(np.mean(scores[OWN]) - np.mean(scores[FOUND]))
        means = {one.name: one.mean for one in final_means(session)}
        assert means["recommended"] == pytest.approx(np.mean(scores[FOUND]))
        assert means["mx-clear"] == pytest.approx(np.mean(scores[OWN]))


@pytest.mark.parametrize(
    ("truth_ms", "said"),
    [
        ({FOUND: 50.0, OWN: 65.0}, "mx-clear: 1[56] ms closer to the bullet \\(95 %: 1"),
        ({FOUND: 60.0, "mx-red": 60.0}, "mx-red: no difference found \\(95 %: −"),
        ({FOUND: 60.0, "mx-black": 50.0}, "mx-black: (10|9) ms farther from the bullet \\(95 %: −1"),
    ],
)
def test_a_sentence_says_how_the_best_switch_compares(
    tmp_path: Path, truth_ms: dict[str, float], said: str
) -> None:
    with begun(tmp_path / "run") as session:
        play(session, truth_ms)
        (sentence,) = ending_sentences(session)
        assert re.match(f"Against the best of 4 switches, {said}", sentence)
        assert ", simulated" in sentence
        assert sentence.endswith("; take mx-black.") == ("mx-black" in truth_ms)
        assert beaten_by(session) == ("mx-black" if "mx-black" in truth_ms else None)


def test_a_switch_that_cannot_be_rendered_is_named_and_left_out(tmp_path: Path) -> None:
    with begun(tmp_path / "run") as session:
        play(session, {FOUND: 60.0}, failing="mx-black")
        found = against_switches(session)
        assert found is not None
        assert found.left_out == ("mx-black",)
        assert found.blocks == 6
        assert ending_sentences(session)[0].endswith("Never scored: mx-black.")


@pytest.mark.parametrize(
    ("fixed_ms", "said"),
    [
        (75.0, "The fixed design would not have done: this one is 15 ms closer to the bullet (95 %: "),
        (60.0, "The fixed design would have done: no difference found (95 %: −"),
        (45.0, "The fixed design would have done: this one is 15 ms farther from the bullet"),
    ],
)
def test_a_run_says_when_a_fixed_design_would_have_done(tmp_path: Path, fixed_ms: float, said: str) -> None:
    with in_paper_space(tmp_path / "run") as session:
        play(session, {FOUND: 60.0, FIXED: fixed_ms}, noise_ms=1.0)
        if session.recommended() == session.start:
            pytest.fail("the search found nothing")
        _, sentence = ending_sentences(session)
        assert sentence.startswith(said)
        assert "simulated" not in sentence
        assert beaten_by(session) == (FIXED if fixed_ms < 60 else None)
        report = optimize_report(session)
        found = against_fixed(session)
        assert found is not None
        assert report["against_fixed"]["low"] == found.low
        assert [one["name"] for one in report["final_means"]][2:] == [*SWITCHES, FIXED]


def test_a_start_that_is_recommended_is_still_compared_with_the_switches(tmp_path: Path) -> None:
    with begun(tmp_path / "run") as session:
        while trial := next(iter(session.ask()), None):
            session.show(trial.number)
            session.answer(
                trial.number, {"asynchrony_ms": Score(50.0 if trial.design == START else 90.0, 1.0)}
            )
        assert session.recommended() == START
        play(session, {OWN: 60.0})
        assert len(session.retests) == 6 * 4
        found = against_switches(session)
        assert found is not None
        assert found.switches == SWITCHES[1:]
        assert found.kind == "better"
        assert retest_of(session) is None


def test_a_person_plays_no_switches_unless_they_are_asked_for(tmp_path: Path) -> None:
    with begin_run(tmp_path / "a", RunRequest(space="paper", person=None)) as session:
        assert session.setup.rivals == ()
        assert session.setup.retest_pairs == 40
    with begin_run(tmp_path / "b", RunRequest(space="paper", person=1)) as session:
        assert [one.name for one in session.setup.rivals] == [*SWITCHES, FIXED]
        assert session.setup.retest_pairs == 16
        paper = session.setup.rivals[-1].design
    with begin_run(tmp_path / "c", RunRequest(space="paper", group="diverse")) as session:
        assert session.setup.rivals[-1].design != paper
    with begin_run(tmp_path / "d", RunRequest(space="mx-brown")) as session:
        brown = next(one for one in session.setup.rivals if one.name == "mx-brown")
        assert brown.design == session.setup.start
        assert FIXED not in [one.name for one in session.setup.rivals]


def test_switches_of_one_name_and_unknown_ones_are_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file or built-in button"):
        switch_rivals(["no-such-switch"])
    with pytest.raises(InputError, match="is named beside others"):
        switch_rivals(["none", "mx-red"])
    twice = (Rival("switch", "mx-red", design=START), Rival("switch", "mx-red"))
    setup = OptimizeSetup(space=model_space_setup(BASE, NAMES), start=START, rivals=twice)
    with pytest.raises(InputError, match="two switches have this name"):
        Optimization.create(tmp_path / "run", setup)


def test_a_trial_without_a_rival_is_written_as_it_was_before_there_were_any() -> None:
    """Population runs compare the bytes of what they began from."""
    assert "rival" not in msgspec.to_builtins(Trial(0, START))
    assert msgspec.to_builtins(Trial(0, {}, rival="mx-red"))["rival"] == "mx-red"


def test_trials_of_the_end_that_are_stopped_are_played_again(tmp_path: Path) -> None:
    with begun(tmp_path / "run", blocks=2) as session:
        while not session.searched:
            (trial,) = session.ask()
            session.show(trial.number)
            session.answer(trial.number, {"asynchrony_ms": Score(60.0 + 20 * (trial.design == START), 1.0)})
        (first,) = session.ask()
        session.give_up(first.number, failed=False)
        (again,) = session.ask()
        assert (again.design, again.rival) == (first.design, first.rival)
        assert again.number != first.number
        play(session, {})
        assert len(session.retests) == 10
        assert all(trial.state is TrialState.DONE for trial in session.retests)
