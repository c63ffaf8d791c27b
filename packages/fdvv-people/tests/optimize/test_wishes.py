"""A run of several wishes: asked after every trial, ended with a compromise, retested in every wish."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from fdvv.errors import InputError
from fdvv.model.file import load_builtin
from fdvv_people.optimize.model_space import neutral_design
from fdvv_people.optimize.problem import Trial, TrialState
from fdvv_people.optimize.realistic import realistic_space
from fdvv_people.optimize.run.begin import RunRequest, begin_run
from fdvv_people.optimize.run.ending import ending_sentences, final_means
from fdvv_people.optimize.run.front import front_report
from fdvv_people.optimize.run.player import player_of
from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.report import optimize_html, optimize_report
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, model_space_setup, wished
from fdvv_people.optimize.run.verdict import retest_of, retests_of, verdict_kind, verdict_sentence
from fdvv_people.task.pointing import ASYNCHRONY
from fdvv_people.task.questionnaire import LIKING
from fdvv_people.task.score import Score

BASE = load_builtin("mx-clear")
NAMES = ("force_ratio", "actuation_mm")
SPACE = realistic_space(BASE, NAMES)
START = neutral_design(SPACE, BASE)
SHORT = RunRequest(engine="sobol", budget=4, presses=3, retest=2, switches=("none",), person=3)


def begun(folder: Path, pairs: int = 6, weights: dict[str, float] | None = None) -> Optimization:
    setup = OptimizeSetup(
        space=model_space_setup(BASE, NAMES),
        engine="sobol",
        objectives=(ASYNCHRONY, LIKING),
        budget=6,
        start=START,
        about={
            OptimizeSetup.RETEST: pairs,
            OptimizeSetup.NAME: "MX Clear",
            **({OptimizeSetup.WEIGHTS: weights} if weights else {}),
        },
    )
    return Optimization.create(folder, setup)


def search(session: Optimization) -> None:
    """Play the search: the shallower the faster, the deeper the better liked; the start is the worst."""
    shallow = SPACE.parameters[1]
    while not session.searched:
        (trial,) = session.ask()
        session.show(trial.number)
        depth = (trial.design["actuation_mm"] - shallow.low) / (shallow.high - shallow.low)
        worse = trial.design == START
        scores = {
            ASYNCHRONY.name: Score(50.0 + 30.0 * depth**2 + 40.0 * worse, 2.0),
            LIKING.name: Score(6.0 - 3.0 * (1 - depth) ** 2 - 2.0 * worse, 0.2),
        }
        session.answer(trial.number, scores)


def retest(session: Optimization, gain_ms: float, gain: float, noise: float = 1.0) -> None:
    random = np.random.default_rng(0)
    while trial := next(iter(session.ask()), None):
        session.show(trial.number)
        found = trial.design != START
        late_ms = 80.0 - gain_ms * found + noise * float(random.standard_normal())
        liked = 4.0 + gain * found + 0.3 * noise * float(random.standard_normal())
        session.answer(trial.number, {ASYNCHRONY.name: Score(late_ms, 7.0), LIKING.name: Score(liked, 0.3)})


def test_the_knee_lies_between_the_best_of_both_wishes(tmp_path: Path) -> None:
    with begun(tmp_path / "run") as session:
        search(session)
        front = session.front().trials
        assert len(front) >= 3
        depths = [one.design["actuation_mm"] for one in front]
        assert depths == sorted(depths)
        found = session.recommended()
        assert found is not None
        assert depths[0] < found["actuation_mm"] < depths[-1]
        rows = front_report(session)
        assert [row["recommended"] for row in rows].count(True) == 1
        assert not any(row["start"] for row in rows)


@pytest.mark.parametrize(("name", "end"), [(ASYNCHRONY.name, 0), (LIKING.name, -1)])
def test_weights_choose_another_compromise(tmp_path: Path, name: str, end: int) -> None:
    with begun(tmp_path / "run", weights={name: 1.0}) as session:
        search(session)
        assert session.recommended() == session.front().trials[end].design


def test_a_compromise_that_a_person_takes_is_retested_whatever_ends_the_process(tmp_path: Path) -> None:
    with begun(tmp_path / "run") as session:
        search(session)
        last = session.front().trials[-1]
        assert session.recommended() != last.design
        session.take(last.number)
        assert session.recommended() == last.design
    with Optimization.open(tmp_path / "run") as session:
        assert session.recommended() == last.design
        (waiting,) = session.ask()
        assert waiting.design in (START, last.design)
        with pytest.raises(InputError, match="between the search and its retest"):
            session.take(session.front().trials[0].number)
    assert replay_differences(tmp_path / "run") == ()


def test_what_is_on_no_front_is_not_taken(tmp_path: Path) -> None:
    with begun(tmp_path / "run") as session:
        with pytest.raises(InputError, match="between the search and its retest"):
            session.take(0)
        search(session)
        with pytest.raises(InputError, match="is not on the front; take one of"):
            session.take(0)
        assert not (tmp_path / "run" / "compromise.json").exists()


@pytest.mark.parametrize(
    ("gain_ms", "gain", "kind", "parts"),
    [
        (8.0, 0.9, "better", ("8 ms closer to the bullet (", "0.9 of 7 points better liked (", "at 95 %.")),
        (8.0, -0.9, "mixed", ("8 ms closer to the bullet (", "0.9 of 7 points worse liked (", "a loss")),
        (-8.0, 0.0, "worse", ("8 ms farther", "no difference found in liking (−", "keep MX Clear.")),
        (0.0, 0.0, "same", ("no difference found in timing (−", "no difference", "keep MX Clear.")),
    ],
)
def test_one_sentence_says_what_was_found_in_every_wish(
    tmp_path: Path, gain_ms: float, gain: float, kind: str, parts: tuple[str, ...]
) -> None:
    with begun(tmp_path / "run", pairs=10) as session:
        search(session)
        retest(session, gain_ms, gain)
        sentence = str(verdict_sentence(session))
        assert verdict_kind(session) == kind
        assert sentence.startswith("Against MX Clear: ")
        for part in parts:
            assert part in sentence
        (one, _) = final_means(session)
        assert one.means[ASYNCHRONY.name] == one.mean
        assert ending_sentences(session) == ()


def test_intervals_of_several_wishes_are_wider_so_that_they_hold_together(tmp_path: Path) -> None:
    with begun(tmp_path / "run", pairs=10) as session:
        search(session)
        retest(session, 8.0, 0.9)
        found = retests_of(session)
        assert retest_of(session) == found[ASYNCHRONY.name]
        differences = [
            block.start.scores[ASYNCHRONY.name].value - block.found.scores[ASYNCHRONY.name].value
            for block in session.blocks
        ]
    from scipy.stats import ttest_1samp

    interval = ttest_1samp(differences, 0.0).confidence_interval(0.975)
    one = found[ASYNCHRONY.name]
    assert (one.low, one.high) == pytest.approx((interval.low, interval.high))


def test_asking_changes_no_press_of_a_simulated_person(tmp_path: Path) -> None:
    def scores(name: str, also: tuple[str, ...]) -> list[Trial]:
        with begin_run(tmp_path / name, RunRequest(**{**vars(SHORT), "also": also})) as session:
            player_of(session.setup).play(session)
            return list(session.trials)

    alone, asked = scores("alone", ()), scores("asked", ("liking", "effort_N_s", "lost_ratio"))
    assert [one.design for one in alone] == [one.design for one in asked]
    names = {"asynchrony_ms", "liking", "effort_N_s", "lost_ratio"}
    assert [set(one.scores) for one in asked] == [names] * 4
    assert [one.scores["asynchrony_ms"] for one in alone] == [one.scores["asynchrony_ms"] for one in asked]


def test_a_run_is_reported_with_its_front(tmp_path: Path) -> None:
    with begin_run(tmp_path / "run", RunRequest(**{**vars(SHORT), "also": ("liking",)})) as session:
        player_of(session.setup).play(session)
        assert {one.state for one in session.retests} == {TrialState.DONE}
        report, page = optimize_report(session), optimize_html(session)
    assert report["best"] == next(row["parameters"] for row in report["front"] if row["recommended"])
    assert set(report["retests"]) <= {"asynchrony_ms", "liking"}
    assert "Compromises" in page
    assert page.count("<svg") == 3
    assert "<strong>Simulated:</strong>" in page


def test_wishes_are_known_and_each_counts_once() -> None:
    assert wished(("liking", "liking", "lost_ratio")) == (LIKING, *wished(("lost_ratio",)))
    with pytest.raises(InputError, match="use lost_ratio, effort_N_s, liking"):
        wished(("colour",))
