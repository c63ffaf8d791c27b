"""Simulated people: the click-timing model, how people differ, what they feel."""

from __future__ import annotations

import math
import pickle
from dataclasses import replace

import numpy as np
import pytest

from fdvv.errors import ModelError
from fdvv_people.optimize.people.percept import Cue, TactileEvent, percept_of
from fdvv_people.optimize.people.user import (
    SimulatedUser,
    UserSettings,
    aim_s,
    draw_user,
    draw_users,
    spread_factor,
    timing_spread_s,
)

USER = SimulatedUser()


def test_the_published_constants_give_the_known_spread_of_a_click() -> None:
    """Worked by hand: 34.7 ms for a target seen 1 s that comes every 1.44 s; 36 ms if it never comes back."""
    assert 1e3 * timing_spread_s(USER, 1.0, 1.44) == pytest.approx(34.7, abs=0.05)
    assert 1e3 * timing_spread_s(USER, 1.0, 1e6) == pytest.approx(36.0, abs=0.05)


def test_without_a_cue_the_clock_alone_times_in_proportion_to_the_period() -> None:
    assert timing_spread_s(USER, 0.0, 0.6) == pytest.approx(0.09015 * 0.6)


def test_a_longer_cue_never_scatters_more() -> None:
    spreads = [timing_spread_s(USER, cue_s, 1.0) for cue_s in np.linspace(0, 2, 50)]
    assert (np.diff(spreads) <= 1e-12).all()


def test_people_aim_before_the_middle_of_the_zone_by_its_share() -> None:
    assert aim_s(USER, 0.1) == pytest.approx(-0.0315)


def test_practice_and_fatigue_are_off_unless_asked_for() -> None:
    assert spread_factor(USER, 500) == 1.0
    learner = replace(USER, learning_ratio=0.5, learning_presses=100, fatigue_ratio=0.2)
    assert spread_factor(learner, 0) == pytest.approx(1.5)
    assert spread_factor(learner, 1000) == pytest.approx(1.2 + 0.5 * math.exp(-10))


def test_a_person_is_the_same_in_every_draw_and_in_another_process() -> None:
    assert draw_users(3, seed=4) == draw_users(30, seed=4)[:3]
    assert draw_user(2, seed=4) == draw_users(3, seed=4)[2]
    assert draw_users(3, seed=5) != draw_users(3, seed=4)
    assert pickle.loads(pickle.dumps(UserSettings())) == UserSettings()


def test_people_differ_about_the_middle_by_what_is_asked() -> None:
    users = draw_users(400, settings=UserSettings(spreads={"pace_mm_s": 0.2}))
    paces = np.log([user.pace_mm_s for user in users])
    assert np.median(paces) == pytest.approx(math.log(USER.pace_mm_s), abs=0.03)
    # a normal cut at two spreads keeps 0.96 of its own (clipped)
    assert paces.std() == pytest.approx(0.2 * 0.96, rel=0.08)
    assert {user.stiffness_N_m for user in users} == {USER.stiffness_N_m}


def test_the_most_salient_event_is_felt_and_a_salient_one_is_felt_sharper() -> None:
    snap, blow = TactileEvent(Cue.SNAP, 0.02, 40.0), TactileEvent(Cue.IMPACT, 0.04, 100.0)
    felt = percept_of(USER, (snap, blow), 0.1)
    assert felt.time_s == 0.02
    assert felt.spread_s == pytest.approx(1e-3 * USER.percept_ms / 2)
    assert percept_of(USER, (blow,), 0.1).spread_s > felt.spread_s


def test_a_press_without_events_is_felt_at_its_end_and_badly() -> None:
    felt = percept_of(USER, (), 0.1)
    assert felt.time_s == 0.1
    assert felt.spread_s > percept_of(USER, (TactileEvent(Cue.SNAP, 0.0, 10.0),), 0.1).spread_s


@pytest.mark.parametrize("wrong", [{"pace_mm_s": 0}, {"adaptation_ratio": 1.5}, {"push_cN": math.nan}])
def test_an_impossible_person_is_refused(wrong: dict[str, float]) -> None:
    with pytest.raises(ModelError, match=next(iter(wrong))):
        replace(USER, **wrong)  # type: ignore[arg-type]


def test_people_may_not_differ_in_what_nobody_knows() -> None:
    with pytest.raises(ModelError, match="number"):
        UserSettings(spreads={"number": 1.0})
