"""What a run came to: the start and the recommended design played again, blind, by the same person."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np
import pytest
from scipy.stats import ttest_1samp

from fdvv.model.file import load_builtin
from fdvv_people.optimize.model_space import neutral_design
from fdvv_people.optimize.realistic import realistic_space
from fdvv_people.optimize.run.replay import replay_differences
from fdvv_people.optimize.run.session import Optimization
from fdvv_people.optimize.run.setup import OptimizeSetup, model_space_setup
from fdvv_people.optimize.run.verdict import at_bound, paired, retest_of, verdict_sentence
from fdvv_people.task.score import Score

BASE = load_builtin("mx-clear")
NAMES = ("force_ratio", "actuation_mm")
SPACE = realistic_space(BASE, NAMES)
START = neutral_design(SPACE, BASE)


def begun(folder: Path, pairs: int = 6, engine: str = "sobol", simulated: bool = True) -> Optimization:
    setup = OptimizeSetup(
        space=model_space_setup(BASE, NAMES),
        engine=engine,
        task="preference" if engine.startswith("preference") else "temporal-pointing",
        budget=4,
        start=START,
        simulated=simulated,
        about={OptimizeSetup.RETEST: pairs, OptimizeSetup.NAME: "MX Clear"},
    )
    return Optimization.create(folder, setup)


def play(session: Optimization, gain_ms: float, noise_ms: float, seed: int = 0) -> None:
    """Play a run to its end: every design but the start is so much better, in truth."""
    random = np.random.default_rng(seed)
    while trial := next(iter(session.ask()), None):
        session.show(trial.number)
        truth = 80.0 - (0.0 if trial.design == START else gain_ms)
        score = Score(truth + noise_ms * float(random.standard_normal()), 7.0)
        session.answer(trial.number, {"asynchrony_ms": score})


def test_each_pair_has_start_and_design_in_a_drawn_order_and_teaches_the_engine_nothing(
    tmp_path: Path,
) -> None:
    with begun(tmp_path / "run") as session:
        play(session, 12.0, 3.0)
        assert len(session.trials) == 4
        pairs = list(zip(session.retests[::2], session.retests[1::2], strict=True))
        assert len(pairs) == 6
        found = session.recommended()
        assert [{str(a.design), str(b.design)} for a, b in pairs] == [{str(START), str(found)}] * 6
        assert 0 < sum(one.design == START for one, _ in pairs) < 6
        assert session.finished
        assert session.ask() == ()
    assert replay_differences(tmp_path / "run") == ()


def test_a_run_killed_in_its_retest_goes_on_with_the_same_trials(tmp_path: Path) -> None:
    with begun(tmp_path / "run") as session:
        play(session, 12.0, 3.0)
        whole = [one.design for one in session.retests]
    with begun(tmp_path / "pieces") as session:
        while not session.searched:
            (trial,) = session.ask()
            session.show(trial.number)
            session.answer(trial.number, {"asynchrony_ms": Score(70.0 if trial.number else 80.0)})
    for _ in whole:
        with Optimization.open(tmp_path / "pieces") as session:
            (waiting,) = session.ask()
            session.show(waiting.number)
        with Optimization.open(tmp_path / "pieces") as session:
            (again,) = session.ask()
            assert again.number == waiting.number
            session.answer(again.number, {"asynchrony_ms": Score(70.0)})
    with Optimization.open(tmp_path / "pieces") as session:
        assert session.finished
        assert [one.design == START for one in session.retests] == [design == START for design in whole]


def test_the_interval_is_that_of_a_paired_t_test() -> None:
    better = [3.0, 9.0, -2.0, 14.0, 6.0]
    found = paired(better)
    assert found is not None
    oracle = ttest_1samp(better, 0.0)
    interval = oracle.confidence_interval(0.95)
    assert (found.low, found.high) == pytest.approx((interval.low, interval.high))
    assert found.chance == pytest.approx(1 - ttest_1samp(better, 0.0, alternative="greater").pvalue)
    assert paired([1.0]) is None


@pytest.mark.parametrize(
    ("gain_ms", "start"),
    [
        (14.0, "14 ms closer to the bullet than MX Clear (95 %: "),
        (-30.0, "30 ms farther from the bullet than MX"),
    ],
)
def test_a_sentence_says_what_was_found(tmp_path: Path, gain_ms: float, start: str) -> None:
    with begun(tmp_path / "run", pairs=40) as session:
        play(session, gain_ms, 1.0)
        sentence = verdict_sentence(session)
        assert sentence is not None
        if session.recommended() == START:
            assert sentence == "No better design found, simulated; keep MX Clear."
            return
        assert sentence.startswith(start)
        assert "simulated" in sentence


def test_no_difference_keeps_the_button(tmp_path: Path) -> None:
    with begun(tmp_path / "run", simulated=False) as session:
        play(session, 0.0, 5.0, seed=2)
        assert str(verdict_sentence(session)).startswith("No difference found (95 %: −")
        assert re.search(
            r"ms; chance of being better \d+\.\d %\); keep MX Clear\.$", str(verdict_sentence(session))
        )


def test_of_people_without_a_difference_few_are_called_better() -> None:
    """The level of the interval, over many runs of nothing but noise."""
    random = np.random.default_rng(3)
    found = [paired(list(random.standard_normal(6))) for _ in range(2000)]
    share = np.mean([one is not None and one.kind == "better" for one in found])
    assert share == pytest.approx(0.025, abs=0.01)


@pytest.mark.parametrize("engine", ["preference", "preference-line"])
def test_what_people_preferred_is_retested_too(tmp_path: Path, engine: str) -> None:
    with begun(tmp_path / "run", engine=engine, simulated=False) as session:
        while trial := session.next_trial():
            forces = [design["force_ratio"] for design in trial.designs]
            session.answer(trial.number, [forces.index(min(forces))])
        assert session.answered == 4
        found = retest_of(session)
        assert found is not None
        assert found.pairs == len(session.retests) == 6
        assert session.finished
        sentence = str(verdict_sentence(session))
        assert sentence.startswith(
            f"Preferred to MX Clear in {round(6 * (found.difference + 0.5))} of 6 answers"
        )


def test_a_run_of_an_earlier_fdvv_has_no_retest_and_no_verdict(tmp_path: Path) -> None:
    setup = OptimizeSetup(space=model_space_setup(BASE, NAMES), engine="sobol", budget=2, start=START)
    with Optimization.create(tmp_path / "run", setup) as session:
        play(session, 5.0, 1.0)
        assert session.finished
        assert (session.retests, verdict_sentence(session)) == ((), None)


def test_a_value_at_a_bound_is_flagged_unless_the_start_is_there_too() -> None:
    low, high = ({one.name: getattr(one, end) for one in SPACE.parameters} for end in ("low", "high"))
    assert at_bound(SPACE, {**START, "actuation_mm": high["actuation_mm"]}) == {"actuation_mm": "most"}
    assert at_bound(SPACE, low) == {"force_ratio": "least", "actuation_mm": "least"}
    assert at_bound(SPACE, low, low) == {}
    assert at_bound(SPACE, START) == {}
    whole = realistic_space(BASE)
    silent = {**neutral_design(whole, BASE), "vibration_gain_ratio": 0.0, "vibration_mm": 3.9}
    assert at_bound(whole, silent, neutral_design(whole, BASE)) == {"vibration_gain_ratio": "least"}
