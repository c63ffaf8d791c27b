"""The paper's twelve means out of presses on the twin. Simulated."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from benchmarks.paper_means import (
    PAPER_MEANS_ms,
    PaperModel,
    PaperPresses,
    PaperStudy,
    PressTable,
    adapted_ms,
    expected_ms,
    fit_paper,
    folded_normal_mean,
    press_table,
)

from fdvv.model.file import load_builtin
from fdvv_people.optimize.people.simulate import score_design
from fdvv_people.optimize.people.user import SimulatedUser, timing_spread_s
from fdvv_people.task.pointing import TemporalPointing

TASK = TemporalPointing("easy", quantised=False)
USER = replace(SimulatedUser(), adaptation_ratio=0.0)


def test_the_mean_of_an_absolute_normal_is_that_of_draws() -> None:
    draws = np.random.default_rng(0).standard_normal(400_000)
    for mean, spread in ((0.0, 36.0), (30.0, 36.0), (64.8, 36.0), (-90.0, 20.0)):
        mean_ms = float(folded_normal_mean(mean, spread))
        assert mean_ms == pytest.approx(np.abs(mean + spread * draws).mean(), abs=0.15)


def test_the_papers_means_are_those_of_the_biases_worked_out_for_them_by_hand() -> None:
    """Inversions at a spread of 36 ms: biases of 64.8 and 100.7 ms give 65.8 and 100.8, best and random."""
    mean_ms = folded_normal_mean(np.array([64.8, 100.7]), 36.0)
    assert mean_ms == pytest.approx([PAPER_MEANS_ms["easy"][0], PAPER_MEANS_ms["easy"][5]], abs=0.2)


def test_what_is_expected_of_presses_is_what_played_tasks_come_to() -> None:
    """Two ways to one number: folded normals about pressed times, and whole tasks on the twin."""
    model = load_builtin("mx-red")
    table = press_table(model, USER, 40, seed=1)
    played = [score_design(TASK, model, USER, seed)["asynchrony_ms"].value for seed in range(25)]
    error = float(np.std(played, ddof=1)) / 5
    assert expected_ms(table, TASK, 0.0) == pytest.approx(np.mean(played), abs=3.5 * error)


def test_one_who_does_not_adapt_is_the_limit_of_those_who_adapt() -> None:
    table = press_table(load_builtin("mx-brown"), USER, 20, seed=1)
    assert adapted_ms(table, TASK, 0.0, 0.0, 2000, 0) == pytest.approx(expected_ms(table, TASK, 0.0), abs=0.6)


def test_an_adapting_person_played_and_reckoned_come_to_the_same() -> None:
    user, model = replace(USER, adaptation_ratio=0.2), load_builtin("mx-brown")
    table = press_table(model, user, 40, seed=1)
    played = [score_design(TASK, model, user, seed)["asynchrony_ms"].value for seed in range(25)]
    error = float(np.std(played, ddof=1)) / 5
    assert adapted_ms(table, TASK, 0.0, 0.2, 2000, 0) == pytest.approx(np.mean(played), abs=3.5 * error + 0.5)


def test_the_clock_is_the_larger_part_of_the_scatter() -> None:
    table = press_table(load_builtin("mx-brown"), USER, 40, seed=1)
    assert np.std(table.key_s) < 0.5 * timing_spread_s(USER, TASK.cue_s, TASK.period_s)


def test_the_best_button_is_not_the_luckiest_one() -> None:
    """Of buttons that are all alike the best is no better than any: it is scored by other presses."""
    random = np.random.default_rng(0)

    def table() -> PressTable:
        return PressTable(USER, 0.05 + 0.01 * random.standard_normal(4), np.zeros(4), np.ones(4))

    switches = {name: [table()] for name in ("clear", "brown", "black", "red")}
    presses = PaperPresses(switches, [[table() for _ in range(40)] for _ in range(200)])
    means = presses.means_ms(lambda one: 1e3 * float(one.key_s.mean()))
    assert means[0] == pytest.approx(50.0, abs=2.0)
    assert means[5] == pytest.approx(50.0, abs=0.5)


@pytest.mark.slow
def test_two_numbers_fitted_on_the_easy_level_tell_the_hard_one_within_6_ms() -> None:
    model = PaperModel(PaperStudy(designs=16, presses=4))
    fit = fit_paper(model, ("easy",), zone_px=10.0)
    assert fit.fitted == ("bias_ms", "pace_mm_s")
    assert fit.error_ms("easy") < 5.0
    assert fit.error_ms("hard") < 6.0
    # ordering that the dynamics alone give: the best below every switch, the random above
    for means in fit.means_ms.values():
        assert means[0] < means[1:5].min()
        assert means[5] > means[1:5].max()
